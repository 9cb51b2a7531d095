#include "canvas.h"

#include <math.h>
#include <stdlib.h>

#include "draw.h"

#define LAYOUT_WIDTH 1280.0f
#define LAYOUT_HEIGHT 720.0f
#define UNIT_MIN (10.0f / 12) /* has the small font, nominally 12, 10 px high */

canvas *canvas_create(SDL_Renderer *renderer, int samples)
{
    canvas *c = calloc(1, sizeof *c);
    SDL_RendererInfo info;

    if (c) {
        const bool software = SDL_GetRendererInfo(renderer, &info) == 0 && (info.flags & SDL_RENDERER_SOFTWARE) != 0;
        c->renderer = renderer;
        c->samples = software ? samples : 1;
    }
    return c;
}

void canvas_forget_textures(canvas *c)
{
    for (int i = 0; i < TEXT_SIZE_COUNT; i++)
        font_close(&c->fonts[i]);
    for (int i = 0; i < SAMPLES_LEVELS; i++) {
        if (c->targets[i])
            SDL_DestroyTexture(c->targets[i]);
        c->targets[i] = NULL;
    }
}

void canvas_destroy(canvas *c)
{
    if (c)
        canvas_forget_textures(c);
    free(c);
}

/* Makes *target a texture of this size to draw to, if it isn't yet. */
static bool require_target(const canvas *c, SDL_Texture **target, int width, int height)
{
    int has_width = 0, has_height = 0;

    if (*target && SDL_QueryTexture(*target, NULL, NULL, &has_width, &has_height) == 0 && has_width == width &&
        has_height == height)
        return true;
    if (*target)
        SDL_DestroyTexture(*target);
    *target = SDL_CreateTexture(c->renderer, SDL_PIXELFORMAT_ARGB8888, SDL_TEXTUREACCESS_TARGET, width, height);
    return *target && SDL_SetTextureScaleMode(*target, SDL_ScaleModeLinear) == 0 &&
           SDL_SetTextureBlendMode(*target, SDL_BLENDMODE_NONE) == 0;
}

/* targets[0] has all samples, targets[1] half as many across and down. */
static bool require_targets(canvas *c)
{
    int across = c->samples;

    for (int i = 0; i < SAMPLES_LEVELS && across > 1; i++, across /= 2)
        if (!require_target(c, &c->targets[i], c->width * across, c->height * across))
            return false;
    c->width *= c->samples;
    c->height *= c->samples;
    return c->samples == 1 || SDL_SetRenderTarget(c->renderer, c->targets[0]) == 0;
}

bool canvas_begin(canvas *c)
{
    if (SDL_SetRenderTarget(c->renderer, NULL) != 0 ||
        SDL_GetRendererOutputSize(c->renderer, &c->width, &c->height) != 0 || !require_targets(c))
        return false;

    c->unit = fminf((float)c->width / LAYOUT_WIDTH, (float)c->height / LAYOUT_HEIGHT);
    c->unit = fmaxf(UNIT_MIN * (float)c->samples, c->unit);
    for (int i = 0; i < TEXT_SIZE_COUNT; i++)
        if (!font_open(&c->fonts[i], c->renderer, (text_size)i, c->unit))
            return false;

    const SDL_Color ground = COLOUR_GROUND;
    SDL_SetRenderDrawBlendMode(c->renderer, SDL_BLENDMODE_BLEND);
    SDL_SetRenderDrawColor(c->renderer, ground.r, ground.g, ground.b, ground.a);
    SDL_RenderClear(c->renderer);
    return true;
}

void canvas_flush(canvas *c)
{
    if (c->index_count > 0)
        SDL_RenderGeometry(c->renderer, NULL, c->vertices, c->vertex_count, c->indices, c->index_count);
    c->vertex_count = c->index_count = 0;
}

bool canvas_end(canvas *c)
{
    int across = c->samples;

    canvas_flush(c);
    for (int i = 0; i < SAMPLES_LEVELS && across > 1; i++, across /= 2) {
        SDL_Texture *next = across > 2 ? c->targets[i + 1] : NULL;
        if (SDL_SetRenderTarget(c->renderer, next) != 0 || SDL_RenderCopy(c->renderer, c->targets[i], NULL, NULL) != 0)
            return false;
    }
    return true;
}

void canvas_clip(canvas *c, const SDL_FRect *area)
{
    canvas_flush(c);
    if (!area) {
        SDL_RenderSetClipRect(c->renderer, NULL);
        return;
    }
    const SDL_Rect pixels = {(int)area->x, (int)area->y, (int)area->w, (int)area->h};
    SDL_RenderSetClipRect(c->renderer, &pixels);
}
