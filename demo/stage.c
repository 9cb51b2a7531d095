#include "stage.h"

#include <math.h>
#include <stdio.h>

/* Layout lengths. */
#define RADIUS_OF_FEW 6.0f   /* up to TRAIL_PARTICLES_MAX particles */
#define RADIUS_OF_SOME 4.0f  /* from SOME on */
#define RADIUS_OF_MANY 1.7f
#define SOME 16
#define LIGHTEST 0.6f        /* radius of a massless particle among heavy ones, in radii of the heaviest */
#define GHOST_GAP 2.5f       /* the ghost's outline goes round a particle in the same place */
#define CROSS_REACH 9.0f
#define ANCHOR_RADIUS 4.0f
#define HAND_RADIUS 11.0f
#define GRID_MIN 70.0        /* shortest side of a square of the grid */

#define TRAIL_OPACITY 0.75
#define EXACT_SECONDS 5.0    /* that the exact path reaches back, at the scene's own time scale */
#define EXACT_PARTS 160      /* half of them are dashes */

static point drawn_at(const actor *a, const camera *view, size_t i)
{
    const float *p = a->drawn + i * STF_DIMENSIONS_MAX;

    return camera_project(view, (const double[3]){(double)p[0], (double)p[1], (double)p[2]});
}

/* The longest of 1, 2 and 5 times a power of ten that is not longer than `most`. */
static double round_down(double most)
{
    const double power = pow(10, floor(log10(most)));

    return most >= 5 * power ? 5 * power : most >= 2 * power ? 2 * power : power;
}

static void draw_grid(canvas *c, const camera *view, double spacing)
{
    const double side = spacing * view->scale, left = (double)view->area.x, top = (double)view->area.y;
    const double right = left + (double)view->area.w, bottom = top + (double)view->area.h;
    const point origin = camera_project(view, (const double[3]){0, 0, 0});

    for (double x = left + fmod(fmod(origin.x - left, side) + side, side); x < right; x += side)
        draw_line(c, x, top, x, bottom, c->unit, faded(COLOUR_GRID, 0.55));
    for (double y = top + fmod(fmod(origin.y - top, side) + side, side); y < bottom; y += side)
        draw_line(c, left, y, right, y, c->unit, faded(COLOUR_GRID, 0.55));
}

static void draw_scale_bar(canvas *c, const session *s, const camera *view, double length)
{
    const double unit = (double)c->unit, x = (double)view->area.x + 8 * unit;
    const double y = (double)(view->area.y + view->area.h) - 10 * unit, end = x + length * view->scale, tick = 4 * unit;
    char number[32], text[64];

    draw_line(c, x, y, end, y, 1.5f * c->unit, COLOUR_MUTED);
    draw_line(c, x, y - tick, x, y + tick, 1.5f * c->unit, COLOUR_MUTED);
    draw_line(c, end, y - tick, end, y + tick, 1.5f * c->unit, COLOUR_MUTED);
    format_number(number, sizeof number, length);
    snprintf(text, sizeof text, "%s %s", number, s->settings.scene->length_unit);
    draw_text(c, TEXT_SMALL, ALIGN_LEFT, end + 8 * unit, y - c->fonts[TEXT_SMALL].height / 2.0, COLOUR_MUTED, text);
}

static void draw_square(canvas *c, point at, float radius, SDL_Color colour)
{
    draw_box(c, (SDL_FRect){(float)at.x - radius, (float)at.y - radius, 2 * radius, 2 * radius}, 0, colour);
}

static void draw_springs(canvas *c, const actor *a, const camera *view, SDL_Color colour)
{
    stf_force_id id;

    for (size_t n = 0; (id = stf_world_force_at(a->world, n)) != 0; n++) {
        const stf_force *force = stf_world_force(a->world, id);
        size_t count;
        const void *records = stf_world_force_records(a->world, id, &count);

        for (size_t i = 0; i < count; i++) {
            point from, to;
            if (force == &stf_force_springs) {
                const stf_spring *spring = (const stf_spring *)records + i;
                from = drawn_at(a, view, spring->a);
                to = drawn_at(a, view, spring->b);
            } else if (force == &stf_force_anchored_springs) {
                const stf_anchored_spring *spring = (const stf_anchored_spring *)records + i;
                from = camera_project_vector(view, spring->anchor);
                to = drawn_at(a, view, spring->particle);
                draw_square(c, from, ANCHOR_RADIUS * c->unit, COLOUR_MUTED);
            } else {
                break;
            }
            draw_line(c, from.x, from.y, to.x, to.y, 1.25f * c->unit, colour);
        }
    }
}

/* A ring with a dot: it stays where it is and is no particle. */
static void draw_attractors(canvas *c, const stf_world *world, const camera *view)
{
    stf_force_id id;

    for (size_t n = 0; (id = stf_world_force_at(world, n)) != 0; n++) {
        size_t count;
        const stf_attractor *attractors = stf_world_force_records(world, id, &count);

        if (stf_world_force(world, id) != &stf_force_attractor)
            continue;
        for (size_t i = 0; i < count; i++) {
            const point at = camera_project_vector(view, attractors[i].position);
            draw_ring(c, at.x, at.y, 8 * c->unit, 1.5f * c->unit, COLOUR_ATTRACTOR);
            draw_disc(c, at.x, at.y, 3 * c->unit, COLOUR_ATTRACTOR);
        }
    }
}

static void draw_trail(canvas *c, const session *s, const actor *a, const camera *view, SDL_Color colour)
{
    const trail *t = &a->trail;
    /* The last point may be of the tick that the drawn state has not come to yet. */
    const bool ahead = s->alpha < 1 && t->recorded > 1 && (t->recorded - 1) * t->stride == stf_world_ticks(a->world);

    const double strongest = t->particles < SOME ? TRAIL_OPACITY : TRAIL_OPACITY / 2;

    for (size_t i = 0; i < t->particles; i++) {
        point from = drawn_at(a, view, i);
        for (size_t age = ahead; age < t->length; age++) {
            const point to = camera_project_vector(view, trail_point(t, i, age));
            const double opacity = strongest * (1 - (double)age / (double)t->capacity);
            draw_line(c, from.x, from.y, to.x, to.y, 1.5f * c->unit, faded(colour, opacity));
            from = to;
        }
    }
}

static bool has_exact(const session *s) { return s->settings.scene->exact && !s->by_hand; }

/* Dashes that stand still: each belongs to a part of the time, counted from 0. */
static void draw_exact(canvas *c, const session *s, const camera *view)
{
    const scene *of = s->settings.scene;
    const double now = session_drawn_time(s), part = EXACT_SECONDS * of->time_scale / EXACT_PARTS;
    const double first = fmax(0, floor(now / part) - EXACT_PARTS);
    double position[3], velocity[3];

    for (size_t i = 0; has_exact(s) && i < stf_world_count(s->main.world) && i < TRAIL_PARTICLES_MAX; i++) {
        for (double k = 2 * floor(first / 2); k * part < now; k += 2) {
            if (!of->exact(i, k * part, position, velocity))
                break;
            const point from = camera_project(view, position);
            of->exact(i, fmin((k + 1) * part, now), position, velocity);
            const point to = camera_project(view, position);
            draw_line(c, from.x, from.y, to.x, to.y, c->unit, faded(COLOUR_EXACT, 0.75));
        }
        if (of->exact(i, now, position, velocity)) {
            const point at = camera_project(view, position);
            draw_cross(c, at.x, at.y, CROSS_REACH * c->unit, 1.25f * c->unit, COLOUR_EXACT);
        }
    }
}

static double mass_of(const stf_world *world, size_t i)
{
    stf_particle p;

    return !stf_world_get(world, i, &p) && p.inverse_mass > 0 ? 1 / (double)p.inverse_mass : 0;
}

static float radius_of(size_t count)
{
    return count < SOME ? RADIUS_OF_FEW : count <= TRAIL_PARTICLES_MAX ? RADIUS_OF_SOME : RADIUS_OF_MANY;
}

static void draw_particles(canvas *c, const actor *a, const camera *view, bool ghost)
{
    const size_t count = stf_world_count(a->world);
    const float largest = radius_of(count) * c->unit, gap = (count < SOME ? GHOST_GAP : 0) * c->unit;
    double heaviest = 0;

    for (size_t i = 0; i < count; i++)
        heaviest = fmax(heaviest, mass_of(a->world, i));
    for (size_t i = 0; i < count; i++) {
        const double mass = mass_of(a->world, i);
        const point at = drawn_at(a, view, i);
        const float radius = mass > 0 ? largest * (LIGHTEST + (1 - LIGHTEST) * (float)cbrt(mass / heaviest)) : largest;
        const float half = radius + (ghost ? gap : 0);
        const SDL_FRect square = {(float)at.x - half, (float)at.y - half, 2 * half, 2 * half};

        if (!isfinite(at.x) || !isfinite(at.y))
            continue;
        if (ghost)
            draw_box_outline(c, square, mass > 0 ? half : 0, 1.5f * c->unit, COLOUR_GHOST);
        else
            draw_box(c, square, mass > 0 ? half : 0, mass > 0 ? COLOUR_MAIN : COLOUR_TEXT);
    }
}

void stage_draw(canvas *c, const session *s, const camera *view)
{
    const bool many = stf_world_count(s->main.world) > TRAIL_PARTICLES_MAX;
    const double spacing = round_down(2.5 * GRID_MIN * (double)c->unit / view->scale);

    canvas_clip(c, &view->area);
    if (s->settings.scene->dimensions < 3)
        draw_grid(c, view, spacing);
    draw_attractors(c, s->main.world, view);
    if (s->ghost.world) {
        if (!s->ghost.lost)
            draw_trail(c, s, &s->ghost, view, COLOUR_GHOST);
        draw_springs(c, &s->ghost, view, faded(COLOUR_GHOST, many ? 0.22 : 0.6));
    }
    if (!s->main.lost)
        draw_trail(c, s, &s->main, view, COLOUR_MAIN);
    draw_springs(c, &s->main, view, faded(COLOUR_MAIN, many ? 0.35 : 0.8));
    draw_particles(c, &s->main, view, false);
    if (s->ghost.world)
        draw_particles(c, &s->ghost, view, true);
    draw_exact(c, s, view);
    draw_scale_bar(c, s, view, spacing);
    canvas_clip(c, NULL);
}

void stage_draw_hand(canvas *c, const session *s, const camera *view, const grab *hand)
{
    const point from = drawn_at(&s->main, view, hand->handle.particle), to = camera_project_vector(view, hand->target);

    draw_line(c, from.x, from.y, to.x, to.y, 1.5f * c->unit, COLOUR_MARKER);
    draw_ring(c, from.x, from.y, HAND_RADIUS * c->unit, 1.5f * c->unit, COLOUR_MARKER);
}

static double legend_width(const canvas *c, const session *s)
{
    const font *f = &c->fonts[TEXT_SMALL];
    const double each = 12 + 26;
    double width = font_width(f, s->settings.integrator->name) + each * (double)c->unit;

    if (s->ghost.world)
        width += font_width(f, s->settings.ghost->name) + each * (double)c->unit;
    return has_exact(s) ? width + font_width(f, "exact") + each * (double)c->unit : width;
}

static double legend_entry(canvas *c, double right, double y, SDL_Color colour, const char *name)
{
    draw_text(c, TEXT_SMALL, ALIGN_RIGHT, right, y, colour, name);
    return right - font_width(&c->fonts[TEXT_SMALL], name) - 12 * (double)c->unit;
}

/* As the exact solution is drawn: in the drag scene's plots a dashed line, elsewhere a cross. */
static void draw_exact_sample(canvas *c, const session *s, double x, double y)
{
    const double dash = 5 * (double)c->unit;

    if (s->settings.scene != &scene_drag) {
        draw_cross(c, x, y, 6 * c->unit, 1.25f * c->unit, COLOUR_EXACT);
        return;
    }
    for (int i = 0; i < 2; i++)
        draw_line(c, x + (2 * i - 2) * dash, y, x + (2 * i - 1) * dash, y, 1.5f * c->unit, COLOUR_EXACT);
}

void stage_legend(canvas *c, const session *s, double right, double y)
{
    const double unit = (double)c->unit, height = c->fonts[TEXT_SMALL].height, middle = y + height / 2, next = 26 * unit;
    const double width = legend_width(c, s), margin = 8 * unit;

    /* What has blown up must not make it unreadable. */
    const SDL_FRect ground = {(float)(right - width), (float)(y - margin / 2), (float)(width + margin),
                              (float)(height + margin)};
    draw_box(c, ground, 0, faded(COLOUR_GROUND, 0.8));

    if (has_exact(s)) {
        right = legend_entry(c, right, y, COLOUR_EXACT, "exact");
        draw_exact_sample(c, s, right, middle);
        right -= next;
    }
    if (s->ghost.world) {
        right = legend_entry(c, right, y, COLOUR_GHOST, s->settings.ghost->name);
        draw_ring(c, right, middle, 5 * c->unit, 1.5f * c->unit, COLOUR_GHOST);
        right -= next;
    }
    right = legend_entry(c, right, y, COLOUR_MAIN, s->settings.integrator->name);
    draw_disc(c, right, middle, 5 * c->unit, COLOUR_MAIN);
}

bool stage_pick(const session *s, const camera *view, double x, double y, double reach, size_t *particle)
{
    double nearest = reach * reach;
    bool found = false;

    for (size_t i = 0; i < stf_world_count(s->main.world); i++) {
        const point at = drawn_at(&s->main, view, i);
        const double square = (at.x - x) * (at.x - x) + (at.y - y) * (at.y - y);
        if (square < nearest) {
            nearest = square;
            *particle = i;
            found = true;
        }
    }
    return found;
}
