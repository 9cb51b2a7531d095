#include "text.h"

#include <SDL_ttf.h>
#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef STF_DEMO_FONTS
#define STF_DEMO_FONTS "demo/fonts"
#endif
#define FONT_FILE STF_DEMO_FONTS "/JetBrainsMono-Regular.ttf"

/* Layout lengths at 1280 x 720. */
static const float nominal_sizes[TEXT_SIZE_COUNT] = {[TEXT_SMALL] = 12, [TEXT_BODY] = 14, [TEXT_TITLE] = 18};

/* All characters with a cell, in the order of the cells. */
static const char cell_characters[] = "?!\"#$%&'()*+,-./0123456789:;<=>@ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_`"
                                      "abcdefghijklmnopqrstuvwxyz{|}~×−÷Δω…–";

#define CELL_COLUMNS 16

/* Numbers from least to below most are shown without an exponent. */
#define PLAIN_LEAST 1e-3
#define PLAIN_MOST 999999.5

/* The length in bytes of the UTF-8 character at `text`, which isn't its end. */
static size_t character_length(const char *text)
{
    size_t length = 1;

    while (((unsigned char)text[length] & 0xc0) == 0x80)
        length++;
    return length;
}

static int count_characters(const char *text)
{
    int count = 0;

    for (; *text; text += character_length(text))
        count++;
    return count;
}

/* Which cell the character at `text` has; 0, the question mark's, if none. */
static int find_cell(const char *text, size_t length)
{
    int cell = 0;

    for (const char *each = cell_characters; *each; each += character_length(each), cell++)
        if (character_length(each) == length && memcmp(each, text, length) == 0)
            return cell;
    return 0;
}

/* Copies one glyph into its cell. It is rendered between spaces, so that what hangs over its cell is not cut off before. */
static bool render_cell(TTF_Font *ttf, SDL_Surface *cells, const font *f, int cell, const char *character, size_t length)
{
    char spaced[8] = " ";
    memcpy(spaced + 1, character, length);
    memcpy(spaced + 1 + length, " ", 2);

    SDL_Surface *glyph = TTF_RenderUTF8_Blended(ttf, spaced, (SDL_Color){255, 255, 255, 255});
    if (!glyph)
        return false;

    const SDL_Rect from = {f->width, 0, f->width, f->height};
    SDL_Rect to = {cell % CELL_COLUMNS * f->width, cell / CELL_COLUMNS * f->height, f->width, f->height};
    SDL_SetSurfaceBlendMode(glyph, SDL_BLENDMODE_NONE);
    const bool copied = SDL_BlitSurface(glyph, &from, cells, &to) == 0;
    SDL_FreeSurface(glyph);
    return copied;
}

static bool render_cells(font *f, TTF_Font *ttf, SDL_Renderer *renderer)
{
    const int rows = (count_characters(cell_characters) + CELL_COLUMNS - 1) / CELL_COLUMNS;

    f->height = TTF_FontHeight(ttf);
    if (TTF_SizeUTF8(ttf, "0", &f->width, NULL) != 0)
        return false;

    SDL_Surface *cells =
        SDL_CreateRGBSurfaceWithFormat(0, CELL_COLUMNS * f->width, rows * f->height, 32, SDL_PIXELFORMAT_ARGB8888);
    bool ok = cells != NULL;
    int cell = 0;
    for (const char *each = cell_characters; ok && *each; each += character_length(each), cell++)
        ok = render_cell(ttf, cells, f, cell, each, character_length(each));
    if (ok)
        f->cells = SDL_CreateTextureFromSurface(renderer, cells);
    SDL_FreeSurface(cells);
    return ok && f->cells && SDL_SetTextureBlendMode(f->cells, SDL_BLENDMODE_BLEND) == 0;
}

bool font_open(font *f, SDL_Renderer *renderer, text_size size, float unit)
{
    const int pixels = (int)(nominal_sizes[size] * unit + 0.5f);

    if (f->pixels == pixels)
        return true;

    font_close(f);
    if (!TTF_WasInit() && TTF_Init() != 0)
        return false;
    TTF_Font *ttf = TTF_OpenFont(FONT_FILE, pixels);
    if (!ttf) {
        SDL_SetError("can't open the font " FONT_FILE ": put it there, or build the demo again where its sources are");
        return false;
    }
    TTF_SetFontHinting(ttf, TTF_HINTING_LIGHT);
    const bool ok = render_cells(f, ttf, renderer);
    TTF_CloseFont(ttf);
    if (ok)
        f->pixels = pixels;
    else
        font_close(f);
    return ok;
}

void font_close(font *f)
{
    if (f->cells)
        SDL_DestroyTexture(f->cells);
    *f = (font){0};
}

int font_width(const font *f, const char *text) { return count_characters(text) * f->width; }

void font_draw(const font *f, SDL_Renderer *renderer, int x, int y, SDL_Color colour, const char *text)
{
    SDL_SetTextureColorMod(f->cells, colour.r, colour.g, colour.b);
    SDL_SetTextureAlphaMod(f->cells, colour.a);
    for (; *text; x += f->width) {
        const size_t length = character_length(text);
        if (*text != ' ') {
            const bool minus = text[0] == '-' && isdigit((unsigned char)text[1]); /* as wide as the digits */
            const int cell = minus ? find_cell("−", strlen("−")) : find_cell(text, length);
            const SDL_Rect from = {cell % CELL_COLUMNS * f->width, cell / CELL_COLUMNS * f->height, f->width, f->height};
            const SDL_Rect to = {x, y, f->width, f->height};
            SDL_RenderCopy(renderer, f->cells, &from, &to);
        }
        text += length;
    }
}

void format_number(char *text, size_t size, double value)
{
    const double magnitude = fabs(value);
    char ascii[32];

    if (!isfinite(value)) {
        snprintf(text, size, "not finite");
    } else if (magnitude == 0 || (magnitude >= PLAIN_LEAST && magnitude < PLAIN_MOST)) {
        snprintf(text, size, magnitude < 1000 ? "%.4g" : "%.0f", value);
    } else {
        snprintf(ascii, sizeof ascii, "%.3e", value);
        char *e = strchr(ascii, 'e');
        const long exponent = strtol(e + 1, NULL, 10); /* without its + and leading 0 */
        while (e[-1] == '0')
            e--;
        e -= e[-1] == '.';
        *e = '\0';
        snprintf(text, size, "%se%ld", ascii, exponent);
    }
}
