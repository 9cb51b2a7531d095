#include "frame.h"

#include <SDL_image.h>
#include <stdio.h>

#define FINE_PIXELS_MAX (1920 * 1200) /* of a picture; larger ones would take half a gigabyte for their samples */
#define LEGEND_HEIGHT 24.0f /* layout length above the drag plots */

stf_result frame_start(frame *f, const session *s, bool keep_look)
{
    if (!keep_look)
        f->look = look_at_scene(s->settings.scene, s->main.world);
    return s->settings.scene == &scene_drag ? drag_plots_run(&f->plots, &s->settings) : STF_OK;
}

camera frame_camera(const canvas *c, const frame *f, const session *s)
{
    return camera_make(s->settings.scene, &f->look, hud_free_area(c, f->show_hud));
}

bool frame_draw(canvas *c, const frame *f, session *s)
{
    if (!canvas_begin(c))
        return false;

    const camera view = frame_camera(c, f, s);
    const stf_result bad = session_place(s);
    SDL_FRect below_legend = view.area;

    below_legend.y += LEGEND_HEIGHT * c->unit;
    below_legend.h -= LEGEND_HEIGHT * c->unit;
    if (bad)
        return SDL_SetError("%s", stf_result_text(bad)), false;
    if (s->settings.scene == &scene_drag)
        drag_plots_draw(c, &f->plots, s, below_legend);
    else
        stage_draw(c, s, &view);
    if (f->hand && f->hand->active)
        stage_draw_hand(c, s, &view, f->hand);
    stage_legend(c, s, (double)(view.area.x + view.area.w - 4 * c->unit), (double)(view.area.y + 2 * c->unit));
    const double free_y = f->show_hud ? hud_draw(c, &f->figures, s) : (double)view.area.y;
    const double panels_end = hud_draw_messages(c, s, free_y, f->still, f->message);
    if (f->show_hints)
        hud_draw_hints(c, s, panels_end);
    if (f->show_help)
        hud_draw_help(c);
    return canvas_end(c);
}

bool save_png(SDL_Surface *surface, const char *path)
{
    SDL_RWops *file = SDL_RWFromFile(path, "wb");

    if (!file)
        return false;
    const bool saved = IMG_SavePNG_RW(surface, file, 0) == 0;
    return SDL_RWclose(file) == 0 && saved;
}

bool is_writable(const char *path)
{
    FILE *file = fopen(path, "ab");

    return file && fclose(file) == 0;
}

bool frame_save(frame *f, session *s, int width, int height, const char *path)
{
    SDL_Surface *surface = SDL_CreateRGBSurfaceWithFormat(0, width, height, 32, SDL_PIXELFORMAT_ARGB8888);
    SDL_Renderer *renderer = surface ? SDL_CreateSoftwareRenderer(surface) : NULL;
    canvas *c = renderer ? canvas_create(renderer, width * height > FINE_PIXELS_MAX ? SAMPLES_QUICK : SAMPLES_FINE) : NULL;

    f->still = true;
    figures_of_session(&f->figures, s, true);
    const bool drawn = c && frame_draw(c, f, s);
    if (drawn)
        SDL_RenderPresent(renderer);
    const bool saved = drawn && save_png(surface, path);
    canvas_destroy(c);
    if (renderer)
        SDL_DestroyRenderer(renderer);
    SDL_FreeSurface(surface);
    return saved;
}
