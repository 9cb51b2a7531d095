/*
 * text: one monospaced font in three sizes. The glyphs of a size stand in one texture, a cell each, so that a frame renders
 * no text, it copies cells.
 */
#ifndef STEADFAST_DEMO_TEXT_H
#define STEADFAST_DEMO_TEXT_H

#include <SDL.h>
#include <stdbool.h>
#include <stddef.h>

typedef enum text_size { TEXT_SMALL, TEXT_BODY, TEXT_TITLE, TEXT_SIZE_COUNT } text_size;

typedef struct font {
    SDL_Texture *cells;
    int pixels;        /* nominal size; 0: closed */
    int width, height; /* px of a cell */
} font;

/* Makes *f the font of this size at `unit` pixels a layout length; does nothing if it is already. False: SDL_GetError. */
bool font_open(font *f, SDL_Renderer *renderer, text_size size, float unit);
void font_close(font *f);

/* px. Text is UTF-8; what the font's cells lack shows as a question mark, a hyphen before a digit as a minus sign. */
int font_width(const font *f, const char *text);
void font_draw(const font *f, SDL_Renderer *renderer, int x, int y, SDL_Color colour, const char *text);

/*
 * "0.0123", "-1.234e-6", "not finite": for people; all digits before the point, or four that matter, without zeros at the
 * end.
 */
void format_number(char *text, size_t size, double value);

#endif
