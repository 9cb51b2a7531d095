#include "draw.h"

#include <math.h>

#define FEATHER 0.5f         /* px to each side of an edge */
#define CORNER_POINTS_MAX 12 /* of one rounded corner */
#define OUTLINE_MAX (4 * CORNER_POINTS_MAX)
#define HALF_PI 1.57079632679489661923f

/* An outline round a convex shape: points with outward directions that a rim is measured along. */
typedef struct outline {
    int count;
    SDL_FPoint at[OUTLINE_MAX], outward[OUTLINE_MAX];
} outline;

SDL_Color faded(SDL_Color colour, double opacity)
{
    colour.a = (Uint8)(colour.a * opacity + 0.5);
    return colour;
}

/* Makes room in the batch; the caller's vertices then start at c->vertex_count. */
static void require(canvas *c, int vertices, int indices)
{
    if (c->vertex_count + vertices > BATCH_VERTICES || c->index_count + indices > BATCH_INDICES)
        canvas_flush(c);
}

static void add_vertex(canvas *c, float x, float y, SDL_Color colour)
{
    c->vertices[c->vertex_count++] = (SDL_Vertex){.position = {x, y}, .color = colour};
}

static void add_triangle(canvas *c, int a, int b, int d)
{
    c->indices[c->index_count++] = a;
    c->indices[c->index_count++] = b;
    c->indices[c->index_count++] = d;
}

static void add_quad(canvas *c, int a, int b, int d, int e)
{
    add_triangle(c, a, b, d);
    add_triangle(c, b, e, d);
}

/* One end of a slab of the line from p to q: q * t <= r (Liang and Barsky 1984). False: nothing is left. */
static bool cut(double q, double r, double *from, double *to)
{
    if (q == 0)
        return r >= 0;
    if (q < 0)
        *from = fmax(*from, r / q);
    else
        *to = fmin(*to, r / q);
    return *from <= *to;
}

void draw_line(canvas *c, double x0, double y0, double x1, double y1, float width, SDL_Color colour)
{
    const double dx = x1 - x0, dy = y1 - y0, length = sqrt(dx * dx + dy * dy), margin = (double)width + 1;
    double from = 0, to = 1;

    if (!isfinite(length) || length == 0 || !isfinite(x0) || !isfinite(y0))
        return;
    if (!cut(-dx, x0 + margin, &from, &to) || !cut(dx, c->width + margin - x0, &from, &to) ||
        !cut(-dy, y0 + margin, &from, &to) || !cut(dy, c->height + margin - y0, &from, &to))
        return;

    /* Lines up to two pixels wide have their solid part in one row of vertices, wider ones in two. */
    const float solid = fmaxf(width / 2 - FEATHER, 0), rim = width / 2 + FEATHER;
    const float rows[] = {-rim, -solid, solid, rim};
    const SDL_Color clear = faded(colour, 0), shades[] = {clear, colour, colour, clear};
    const double nx = -dy / length, ny = dx / length;

    require(c, 8, 18);
    const int first = c->vertex_count;
    for (int row = 0; row < 4; row++) {
        const double ox = nx * (double)rows[row], oy = ny * (double)rows[row];
        add_vertex(c, (float)(x0 + from * dx + ox), (float)(y0 + from * dy + oy), shades[row]);
        add_vertex(c, (float)(x0 + to * dx + ox), (float)(y0 + to * dy + oy), shades[row]);
    }
    for (int row = 0; row < 3; row++)
        if (row != 1 || solid > 0)
            add_quad(c, first + 2 * row, first + 2 * row + 1, first + 2 * row + 2, first + 2 * row + 3);
}

/* The outline of a box with rounded corners; a disc is one that is all corners. */
static outline make_outline(SDL_FRect box, float radius)
{
    const int corner = radius > 0 ? (int)fminf(2 + radius, CORNER_POINTS_MAX) : 1;
    const float right = box.x + box.w - radius, bottom = box.y + box.h - radius;
    const float left = box.x + radius, top = box.y + radius;
    const SDL_FPoint centres[] = {{right, bottom}, {left, bottom}, {left, top}, {right, top}};
    outline o = {.count = 4 * corner};

    for (int i = 0; i < o.count; i++) {
        const float part = corner > 1 ? ((float)(i % corner) + 0.5f) / (float)corner : 0.5f;
        const float angle = HALF_PI * ((float)(i / corner) + part);
        const float reach = corner > 1 ? 1 : 1.41421356f; /* a sharp corner's rim is its mitre */

        o.outward[i] = (SDL_FPoint){reach * cosf(angle), reach * sinf(angle)};
        o.at[i].x = centres[i / corner].x + radius * cosf(angle);
        o.at[i].y = centres[i / corner].y + radius * sinf(angle);
    }
    return o;
}

static void add_loop(canvas *c, const outline *o, float offset, SDL_Color colour)
{
    for (int i = 0; i < o->count; i++)
        add_vertex(c, o->at[i].x + offset * o->outward[i].x, o->at[i].y + offset * o->outward[i].y, colour);
}

static void join_loops(canvas *c, int first, int count)
{
    for (int i = 0; i < count; i++) {
        const int next = (i + 1) % count;
        add_quad(c, first + i, first + next, first + count + i, first + count + next);
    }
}

static bool is_visible(const canvas *c, SDL_FRect box)
{
    return box.x < (float)c->width && box.y < (float)c->height && box.x + box.w > 0 && box.y + box.h > 0;
}

void draw_box(canvas *c, SDL_FRect box, float radius, SDL_Color colour)
{
    if (!is_visible(c, box))
        return;

    const outline o = make_outline(box, radius);
    require(c, 2 * o.count, 9 * o.count);
    const int first = c->vertex_count;
    add_loop(c, &o, -FEATHER, colour);
    add_loop(c, &o, FEATHER, faded(colour, 0));
    for (int i = 1; i + 1 < o.count; i++)
        add_triangle(c, first, first + i, first + i + 1);
    join_loops(c, first, o.count);
}

void draw_box_outline(canvas *c, SDL_FRect box, float radius, float width, SDL_Color colour)
{
    if (!is_visible(c, box))
        return;

    const outline o = make_outline(box, radius);
    const float solid = fmaxf(width / 2 - FEATHER, 0), rim = width / 2 + FEATHER;
    require(c, 4 * o.count, 18 * o.count);
    const int first = c->vertex_count;
    add_loop(c, &o, -rim, faded(colour, 0));
    add_loop(c, &o, -solid, colour);
    add_loop(c, &o, solid, colour);
    add_loop(c, &o, rim, faded(colour, 0));
    for (int loop = 0; loop < 3; loop++)
        join_loops(c, first + loop * o.count, o.count);
}

static SDL_FRect around(double x, double y, float radius)
{
    return (SDL_FRect){(float)x - radius, (float)y - radius, 2 * radius, 2 * radius};
}

void draw_disc(canvas *c, double x, double y, float radius, SDL_Color colour)
{
    draw_box(c, around(x, y, radius), radius, colour);
}

void draw_ring(canvas *c, double x, double y, float radius, float width, SDL_Color colour)
{
    draw_box_outline(c, around(x, y, radius), radius, width, colour);
}

void draw_cross(canvas *c, double x, double y, float reach, float width, SDL_Color colour)
{
    const double r = (double)reach;

    draw_line(c, x - r, y, x + r, y, width, colour);
    draw_line(c, x, y - r, x, y + r, width, colour);
}

void draw_text(canvas *c, text_size size, text_align align, double x, double y, SDL_Color colour, const char *text)
{
    const font *f = &c->fonts[size];
    const int width = font_width(f, text);
    const double left = align == ALIGN_LEFT ? x : align == ALIGN_RIGHT ? x - width : x - width / 2.0;

    canvas_flush(c);
    font_draw(f, c->renderer, (int)floor(left + 0.5), (int)floor(y + 0.5), colour, text);
}
