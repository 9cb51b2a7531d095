#include "hud.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Layout lengths. */
#define MARGIN 16.0f
#define PANEL_WIDTH 352.0f
#define PADDING 16.0
#define LINE 21.0
#define HALF_GAP 10.0
#define VALUE_COLUMN 124.0
#define HINTS_HEIGHT 32.0f
#define CORNER 8.0f
#define MESSAGE_GAP 10.0

#define WRAP_TEXT 256 /* bytes of the longest text that is broken into lines */

#define ENERGY_NOISE 1e-5 /* a start's energy is 0 if it is less than this part of the present one */
#define ENERGY_PERCENT_MOST 9.995 /* energy that has grown beyond this many times is better shown in joules */

static void add_row(hud *h, SDL_Color colour, const char *label, const char *value)
{
    if (h->count == HUD_ROWS_MAX)
        return;

    hud_row *row = &h->rows[h->count++];
    row->colour = colour;
    snprintf(row->label, sizeof row->label, "%s", label);
    snprintf(row->value, sizeof row->value, "%s", value);
}

static void add_gap(hud *h) { add_row(h, COLOUR_TEXT, "", ""); }

/* A value with its unit behind it. */
static void add_number(hud *h, const char *label, double value, const char *unit)
{
    char number[32], text[HUD_TEXT];

    format_number(number, sizeof number, value);
    snprintf(text, sizeof text, "%s %s", number, isfinite(value) ? unit : "");
    add_row(h, COLOUR_TEXT, label, text);
}

static void add_count(hud *h, const char *label, uint64_t count)
{
    char text[HUD_TEXT];

    snprintf(text, sizeof text, "%llu", (unsigned long long)count);
    add_row(h, COLOUR_TEXT, label, text);
}

static void add_integrator(hud *h, const char *label, const stf_integrator *integrator, SDL_Color colour)
{
    add_row(h, colour, label, integrator->name);
    add_count(h, "order", (uint64_t)integrator->order);
}

static void add_energy(hud *h, const session *s, const actor *a)
{
    double energy, change;
    char text[HUD_TEXT];

    if (actor_energy(a, &energy, &change) != STF_OK)
        return;
    if (s->settings.scene->conserves_energy && !isnan(change)) {
        add_number(h, "energy error", change, "of E(0)");
    } else if (s->settings.scene->conserves_energy) {
        add_number(h, "energy error", energy - a->start_energy, "J");
    } else if (a->start_energy > 0 && fabs(change) < ENERGY_PERCENT_MOST) {
        snprintf(text, sizeof text, "%.4g %%", 100 * (1 + change));
        add_row(h, COLOUR_TEXT, "energy left", text);
    } else {
        const double before = fabs(a->start_energy) >= ENERGY_NOISE * fabs(energy) ? a->start_energy : 0;
        add_number(h, "energy", energy, "J");
        add_number(h, "", before, s->by_hand ? "J before" : "J at the start");
        h->rows[h->count - 1].colour = COLOUR_MUTED;
    }
}

static void add_error(hud *h, const session *s, const actor *a)
{
    const scene *of = s->settings.scene;
    const double error = scene_error(of, a->world);
    char percent[32], text[HUD_TEXT];

    if (!of->exact) {
        add_row(h, COLOUR_MUTED, "error", "no exact solution");
    } else if (s->by_hand) {
        add_row(h, COLOUR_MUTED, "error", "moved by hand");
    } else {
        add_number(h, "error", error, of->length_unit);
        format_number(percent, sizeof percent, 100 * error / of->size);
        snprintf(text, sizeof text, "%s %% of %g %s", percent, of->size, of->length_unit);
        add_row(h, COLOUR_TEXT, "", text);
    }
}

static void add_time(hud *h, const session *s)
{
    const char *unit = s->settings.scene->time_unit;
    char text[HUD_TEXT];

    add_number(h, "step", s->settings.step, unit);
    add_count(h, "substeps", s->settings.substeps);
    add_gap(h);
    snprintf(text, sizeof text, "%.*f %s", s->settings.step < 1 ? 2 : 0, stf_world_time(s->main.world), unit);
    add_row(h, COLOUR_TEXT, "time", text);
    add_count(h, "ticks", stf_world_ticks(s->main.world));
    snprintf(text, sizeof text, "%u tick%s", s->ticks_this_frame, s->ticks_this_frame == 1 ? "" : "s");
    add_row(h, COLOUR_TEXT, "this frame", text);
    add_number(h, "dropped", session_dropped(s), unit);
    if (session_dropped(s) > 0)
        h->rows[h->count - 1].colour = COLOUR_WARNING;
    snprintf(text, sizeof text, "×%g%s", s->speed, s->paused ? ", paused" : "");
    add_row(h, s->paused ? COLOUR_WARNING : COLOUR_TEXT, "speed", text);
}

void hud_refresh(hud *h, const session *s)
{
    const double cost = session_cost(s);

    h->count = 0;
    add_integrator(h, "integrator", s->settings.integrator, COLOUR_MAIN);
    add_time(h, s);
    add_gap(h);
    if (isnan(cost))
        add_row(h, COLOUR_MUTED, "cost", "not yet measured");
    else
        add_number(h, "cost", cost, "ns/particle/step");
    add_energy(h, s, &s->main);
    add_error(h, s, &s->main);
    if (!s->ghost.world)
        return;
    add_gap(h);
    add_integrator(h, "ghost", s->settings.ghost, COLOUR_GHOST);
    add_energy(h, s, &s->ghost);
    add_error(h, s, &s->ghost);
    add_number(h, "apart", session_ghost_distance(s), s->settings.scene->length_unit);
    add_row(h, COLOUR_MUTED, "", "root mean square");
}

/* Copies as much of `text` as fits into `width` pixels, up to a space, to `line`; returns what is left of the text. */
static const char *take_line(const font *f, const char *text, double width, char line[WRAP_TEXT])
{
    snprintf(line, WRAP_TEXT, "%s", text);
    for (char *space = strrchr(line, ' '); font_width(f, line) > width && space; space = strrchr(line, ' '))
        *space = '\0';
    text += strlen(line);
    return text + strspn(text, " ");
}

static int count_lines(const font *f, const char *text, double width)
{
    char line[WRAP_TEXT];
    int lines = 0;

    for (; *text; lines++)
        text = take_line(f, text, width, line);
    return lines;
}

/* Returns the y below the last line. */
static double draw_wrapped(canvas *c, text_size size, double x, double y, double width, SDL_Color colour, const char *text)
{
    char line[WRAP_TEXT];

    while (*text) {
        text = take_line(&c->fonts[size], text, width, line);
        draw_text(c, size, ALIGN_LEFT, x, y, colour, line);
        y += c->fonts[size].height;
    }
    return y;
}

static double rows_height(const hud *h)
{
    double height = 0;

    for (int i = 0; i < h->count; i++)
        height += h->rows[i].value[0] ? LINE : HALF_GAP;
    return height;
}

/* A panel of the width of all panels, for something `height` pixels high. Returns the y below it. */
static double draw_panel(canvas *c, double y, double height)
{
    const float u = c->unit;

    draw_box(c, (SDL_FRect){MARGIN * u, (float)y, PANEL_WIDTH * u, (float)height}, CORNER * u, COLOUR_PANEL);
    return y + height + MESSAGE_GAP * (double)u;
}

double hud_draw(canvas *c, const hud *h, const session *s)
{
    const double u = (double)c->unit, top = (double)MARGIN * u, x = top + PADDING * u;
    const double width = ((double)PANEL_WIDTH - 2 * PADDING) * u;
    const char *title = s->settings.scene->title;
    const font *large = &c->fonts[TEXT_TITLE];
    const double title_height = count_lines(large, title, width) * (double)large->height;
    const double below = draw_panel(c, top, title_height + (2 * PADDING + HALF_GAP + rows_height(h) - 4) * u);
    double y = draw_wrapped(c, TEXT_TITLE, x, top + (PADDING - 4) * u, width, COLOUR_TEXT, title) + HALF_GAP * u;

    for (int i = 0; i < h->count; i++) {
        const hud_row *row = &h->rows[i];
        draw_text(c, TEXT_BODY, ALIGN_LEFT, x, y, COLOUR_MUTED, row->label);
        draw_text(c, TEXT_BODY, ALIGN_LEFT, x + VALUE_COLUMN * u, y, row->colour, row->value);
        y += (row->value[0] ? LINE : HALF_GAP) * u;
    }
    return below;
}

SDL_FRect hud_free_area(const canvas *c, bool shown)
{
    const float u = c->unit, left = (shown ? 2 * MARGIN + PANEL_WIDTH : MARGIN) * u;

    return (SDL_FRect){left, MARGIN * u, (float)c->width - left - MARGIN * u,
                       (float)c->height - (MARGIN + HINTS_HEIGHT) * u};
}

/* Returns the y below it. */
static double draw_message(canvas *c, double y, SDL_Color colour, const char *text)
{
    const double u = (double)c->unit, x = ((double)MARGIN + PADDING) * u, width = ((double)PANEL_WIDTH - 2 * PADDING) * u;
    const font *f = &c->fonts[TEXT_BODY];
    const double below = draw_panel(c, y, count_lines(f, text, width) * (double)f->height + PADDING * u);

    draw_wrapped(c, TEXT_BODY, x, y + PADDING / 2 * u, width, colour, text);
    return below;
}

static void describe_loss(char *text, size_t size, const actor *a, const char *whose)
{
    snprintf(text, size, "%sparticle %llu left the finite numbers at tick %llu: R restarts", whose,
             (unsigned long long)a->lost_particle, (unsigned long long)stf_world_ticks(a->world));
}

void hud_draw_messages(canvas *c, const session *s, double y, const char *message)
{
    char text[WRAP_TEXT];

    if (s->main.lost) {
        describe_loss(text, sizeof text, &s->main, "");
        y = draw_message(c, y, COLOUR_WARNING, text);
    }
    if (s->ghost.lost) {
        describe_loss(text, sizeof text, &s->ghost, "ghost: ");
        y = draw_message(c, y, COLOUR_GHOST, text);
    }
    if (message)
        draw_message(c, y, COLOUR_TEXT, message);
}

void hud_draw_hints(canvas *c)
{
    const double y = c->height - ((double)HINTS_HEIGHT / 2 + 4) * (double)c->unit - c->fonts[TEXT_SMALL].height / 2.0;

    draw_text(c, TEXT_SMALL, ALIGN_LEFT, (double)(MARGIN * c->unit), y, COLOUR_MUTED,
              "F1 keys   [ ] scene   digit integrator   G ghost   P pause   O step   R restart   , . step size   "
              "+ − speed   drag a particle");
}
