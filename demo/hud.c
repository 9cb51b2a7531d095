#include "hud.h"

#include <stdio.h>
#include <string.h>

/* Layout lengths. */
#define MARGIN 16.0f
#define PANEL_WIDTH 384.0f
#define PADDING 16.0
#define LINE 21.0
#define HALF_GAP 10.0
#define VALUE_COLUMN 128.0
#define HINTS_HEIGHT 32.0f
#define CORNER 8.0f
#define MESSAGE_GAP 10.0

#define WRAP_TEXT 384 /* bytes of the longest text that is broken into lines */

/* A percent sign stays with its number. */
static bool may_break_before(const char *rest) { return strncmp(rest, " %", 2) != 0; }

/* Copies as much of `text` as fits into `width` pixels, up to a space, to `line`; returns what is left of the text. */
static const char *take_line(const font *f, const char *text, double width, char line[WRAP_TEXT])
{
    snprintf(line, WRAP_TEXT, "%s", text);
    for (char *space = strrchr(line, ' ');
         space && (font_width(f, line) > width || !may_break_before(text + strlen(line))); space = strrchr(line, ' '))
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

static double rows_height(const figures *f)
{
    double height = 0;

    for (int i = 0; i < f->count; i++)
        height += f->rows[i].value[0] ? LINE : HALF_GAP;
    return height;
}

/* A panel of the width of all panels, for something `height` pixels high. Returns the y below it. */
static double draw_panel(canvas *c, double y, double height)
{
    const float u = c->unit;

    draw_box(c, (SDL_FRect){MARGIN * u, (float)y, PANEL_WIDTH * u, (float)height}, CORNER * u, COLOUR_PANEL);
    return y + height + MESSAGE_GAP * (double)u;
}

double hud_draw(canvas *c, const figures *f, const session *s)
{
    const double u = (double)c->unit, top = (double)MARGIN * u, x = top + PADDING * u;
    const double width = ((double)PANEL_WIDTH - 2 * PADDING) * u;
    const char *title = s->settings.scene->title;
    const font *large = &c->fonts[TEXT_TITLE];
    const double title_height = count_lines(large, title, width) * (double)large->height;
    const double below = draw_panel(c, top, title_height + (2 * PADDING + HALF_GAP + rows_height(f) - 4) * u);
    double y = draw_wrapped(c, TEXT_TITLE, x, top + (PADDING - 4) * u, width, COLOUR_TEXT, title) + HALF_GAP * u;

    for (int i = 0; i < f->count; i++) {
        const figure *row = &f->rows[i];
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

/* A still picture has no keys to advise. */
static const char *advise(const actor *a, const session *s, bool still)
{
    return still           ? ""
           : a == &s->main ? ": try another (digits), a shorter step (,) or the advised substeps (A). R restarts"
                           : ": try another (Shift digit)";
}

/* Returns the y below it. */
static double draw_loss(canvas *c, double y, const session *s, const actor *a, bool still)
{
    char loss[WRAP_TEXT / 2], text[WRAP_TEXT];

    if (!a->lost)
        return y;
    format_loss(loss, sizeof loss, s, a);
    snprintf(text, sizeof text, "%s: %s. The step is too long for this integrator here%s.",
             a == &s->main ? "Lost" : "Ghost lost", loss, advise(a, s, still));
    return draw_message(c, y, a == &s->main ? COLOUR_WARNING : COLOUR_GHOST, text);
}

double hud_draw_messages(canvas *c, const session *s, double y, bool still, const char *message)
{
    y = draw_loss(c, y, s, s->main.lost ? &s->main : &s->ghost, still); /* without its world a ghost is no news */
    return message ? draw_message(c, y, COLOUR_TEXT, message) : y;
}

void hud_draw_hints(canvas *c, const session *s, double panels_end)
{
    const double y = c->height - ((double)HINTS_HEIGHT / 2 + 4) * (double)c->unit - c->fonts[TEXT_SMALL].height / 2.0;
    char text[WRAP_TEXT];

    if (panels_end > y)
        return;
    snprintf(text, sizeof text,
             "F1 keys   [ ] scene   digit integrator   G ghost   P pause   O step   R restart   , . step size   + − speed%s",
             s->settings.scene == &scene_drag ? "" : "   drag a particle");
    draw_text(c, TEXT_SMALL, ALIGN_LEFT, (double)(MARGIN * c->unit), y, COLOUR_MUTED, text);
}
