#include "headless.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "frame.h"

#define PATH_MAX_LENGTH 4096
#define LOSS_TEXT 160
#define PICTURE_PART 0.6 /* of a scene's duration: late enough to tell integrators apart */

static int fail(const char *what, const char *why)
{
    fprintf(stderr, "demo: %s: %s\n", what, why);
    return EXIT_FAILURE;
}

static int fail_path(const char *path)
{
    fprintf(stderr, "demo: can't write \"%s\" (%s): name a file in a folder that exists and may be written\n", path,
            strerror(errno));
    return EXIT_USAGE;
}

/* ---- CSV --------------------------------------------------------------------------------------------------------------- */

/* Nine significant digits bring a float back bit for bit. */
static bool write_rows(FILE *csv, const stf_world *world)
{
    for (size_t i = 0; i < stf_world_count(world); i++) {
        stf_particle p;
        if (stf_world_get(world, i, &p))
            return false;
        fprintf(csv, "%llu,%.15g,%lu,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", (unsigned long long)stf_world_ticks(world),
                stf_world_time(world), (unsigned long)i, (double)p.position.x, (double)p.position.y, (double)p.position.z,
                (double)p.velocity.x, (double)p.velocity.y, (double)p.velocity.z);
    }
    return !ferror(csv);
}

static void write_header(FILE *csv, const scene *s)
{
    const char *l = s->length_unit, *t = s->time_unit;

    fprintf(csv, "tick,time [%s],particle,x [%s],y [%s],z [%s],vx [%s/%s],vy [%s/%s],vz [%s/%s]\n", t, l, l, l, l, t, l, t,
            l, t);
}

/* Runs the session with a row a tick and particle. */
static int run_with_csv(session *s, uint64_t ticks, const char *path)
{
    errno = 0;
    FILE *csv = fopen(path, "w");
    if (!csv)
        return fail_path(path);

    write_header(csv, s->settings.scene);
    bool written = write_rows(csv, s->main.world);
    stf_result bad = STF_OK;
    for (uint64_t tick = 0; tick < ticks && written && !bad && !s->main.lost; tick++) {
        bad = session_run(s, 1);
        written = written && !bad && write_rows(csv, s->main.world);
    }
    written = !ferror(csv) && written;
    written = fclose(csv) == 0 && written;
    if (bad)
        return fail("the scene stopped", stf_result_text(bad));
    return written ? EXIT_SUCCESS : fail(path, "could not be written to its end: is the disk full?");
}

/* ---- the summary --------------------------------------------------------------------------------------------------------- */

/* A row without a label goes on from the one above. */
static void print_measured(const session *s, const actor *a)
{
    char loss[LOSS_TEXT];
    figures f = {0};

    figures_add_measured(&f, s, a);
    for (int i = 0; i < f.count; i++)
        if (f.rows[i].label[0])
            printf("%s%-15s %s", i > 0 ? "\n" : "", f.rows[i].label, f.rows[i].value);
        else
            printf(", %s", f.rows[i].value);
    printf("\n");
    if (a->lost) {
        format_loss(loss, sizeof loss, s, a);
        printf("lost            %s: the step is too long for this integrator here\n", loss);
    }
}

static void print_integrator(const char *label, const stf_integrator *integrator)
{
    char order[FIGURE_TEXT];

    format_order(order, sizeof order, integrator);
    printf("%-15s %s, order %s\n", label, integrator->name, order);
}

static void print_summary(const session *s)
{
    const scene *of = s->settings.scene;

    printf("scene           %s: %s\n", of->name, of->title);
    print_integrator("integrator", s->settings.integrator);
    printf("step            %.9g %s, %u substep%s\n", s->settings.step, of->time_unit, s->settings.substeps,
           s->settings.substeps == 1 ? "" : "s");
    printf("time            %.9g %s, %llu tick%s\n", stf_world_time(s->main.world), of->time_unit,
           (unsigned long long)stf_world_ticks(s->main.world), stf_world_ticks(s->main.world) == 1 ? "" : "s");
    print_measured(s, &s->main);
    if (s->ghost.world) {
        print_integrator("ghost", s->settings.ghost);
        print_measured(s, &s->ghost);
    }
}

/* ---- what is run --------------------------------------------------------------------------------------------------------- */

static uint64_t ticks_of(double time, double step) { return (uint64_t)floor(time / step + 0.5); }

static int draw_picture(session *s, const options *o, const char *path)
{
    frame f = {.show_hud = true};
    const stf_result bad = frame_start(&f, s, false);

    if (bad)
        return fail("the picture", stf_result_text(bad));
    (void)session_look_at_stability(s); /* what is not finite any more keeps its last figures */
    if (!frame_save(&f, s, o->width ? o->width : PICTURE_WIDTH, o->height ? o->height : PICTURE_HEIGHT, path))
        return fail(path, SDL_GetError());
    return EXIT_SUCCESS;
}

static int run_session(session *s, const options *o)
{
    const uint64_t ticks = o->has_ticks ? o->ticks : ticks_of(s->settings.scene->duration, s->settings.step);
    int status = EXIT_SUCCESS;

    if (o->csv) {
        status = run_with_csv(s, ticks, o->csv);
    } else {
        const stf_result bad = session_run(s, ticks);
        if (bad)
            status = fail("the scene stopped", stf_result_text(bad));
    }
    (void)session_look_at_stability(s);
    if (status == EXIT_SUCCESS && o->png)
        status = draw_picture(s, o, o->png);
    if (status == EXIT_SUCCESS)
        print_summary(s);
    return status;
}

int headless_run(const options *o)
{
    settings chosen = o->settings;
    session s = {.speed = 1};

    if (o->png && !is_writable(o->png))
        return fail_path(o->png);
    if (!chosen.scene)
        chosen.scene = scenes[0];

    const stf_result bad = session_start(&s, &chosen);
    if (bad)
        return fail("the scene can't be made", stf_result_text(bad));
    const int status = run_session(&s, o);
    session_close(&s);
    return status;
}

static int picture_of(const scene *of, const options *o)
{
    const char *folder = o->out ? o->out : ".";
    settings chosen = o->settings;
    session s = {.speed = 1};
    char path[PATH_MAX_LENGTH];

    chosen.scene = of;
    if (snprintf(path, sizeof path, "%s/steadfast-%s.png", folder, of->name) >= (int)sizeof path)
        return fail("--out", "the path is too long");
    errno = 0;
    if (!is_writable(path))
        return fail_path(path);

    const stf_result bad = session_start(&s, &chosen);
    if (bad)
        return fail(of->name, stf_result_text(bad));
    const stf_result stopped = session_run(&s, ticks_of(of->duration * PICTURE_PART, s.settings.step));
    const int status = stopped ? fail(of->name, stf_result_text(stopped)) : draw_picture(&s, o, path);
    session_close(&s);
    if (status == EXIT_SUCCESS)
        printf("%s\n", path);
    return status;
}

int headless_pictures(const options *o)
{
    int status = EXIT_SUCCESS;

    if (o->settings.scene)
        return picture_of(o->settings.scene, o);
    for (const scene *const *each = scenes; *each && status == EXIT_SUCCESS; each++)
        status = picture_of(*each, o);
    return status;
}
