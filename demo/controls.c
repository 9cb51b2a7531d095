#include "controls.h"

#include <math.h>

#define PICK_REACH 30.0 /* layout length from the pointer to a particle */
#define ZOOM_PER_NOTCH 1.15
#define SPEED_MIN (1.0 / 64)
#define SPEED_MAX 64.0
#define SUBSTEPS_MAX 4096u
#define STEP_RANGE_DOWN 1024
#define STEP_RANGE_UP 64

/* ---- keys ---------------------------------------------------------------------------------------------------------------- */

static void change_scene(app *a, int by)
{
    int count = 0, now = 0;

    for (; scenes[count]; count++)
        if (scenes[count] == a->session.settings.scene)
            now = count;
    app_restart(a, &(settings){.scene = scenes[(now + by + count) % count],
                               .ghost = a->session.settings.ghost,
                               .workers = a->session.settings.workers});
}

static void change_speed(app *a, double factor)
{
    const double speed = a->session.speed * factor;

    if (speed >= SPEED_MIN && speed <= SPEED_MAX)
        app_check(a, session_set_speed(&a->session, speed));
}

static void change_step(app *a, double factor)
{
    settings chosen = a->session.settings;
    const double least = chosen.scene->step / STEP_RANGE_DOWN, most = chosen.scene->step * STEP_RANGE_UP;
    const double before = chosen.step, wanted = before * factor;

    chosen.step = fmax(least, fmin(most, wanted));
    if (chosen.step != before)
        app_restart(a, &chosen);
    if (chosen.step != wanted)
        app_say(a, factor < 1 ? "shortest step: 1/1024 of the scene's own" : "longest step: 64 times the scene's own");
    else if (chosen.scene == &scene_drag)
        app_say(a, "the four plots keep their steps");
}

static void change_substeps(app *a, int by)
{
    settings chosen = a->session.settings;

    if ((by < 0 && chosen.substeps == 1) || (by > 0 && chosen.substeps == SUBSTEPS_MAX))
        return;
    chosen.substeps = by < 0 ? chosen.substeps - 1 : chosen.substeps + 1;
    app_restart(a, &chosen);
}

static void choose_integrator(app *a, int index, bool of_ghost)
{
    settings chosen = a->session.settings;

    for (int i = 0; i <= index; i++)
        if (!stf_integrators[i])
            return;
    if (of_ghost)
        a->ghost = chosen.ghost = stf_integrators[index];
    else
        chosen.integrator = stf_integrators[index];
    app_restart(a, &chosen);
}

static void scene_before(app *a) { change_scene(a, -1); }
static void scene_after(app *a) { change_scene(a, 1); }
static void faster(app *a) { change_speed(a, 2); }
static void slower(app *a) { change_speed(a, 0.5); }
static void halve_step(app *a) { change_step(a, 0.5); }
static void double_step(app *a) { change_step(a, 2); }
static void fewer_substeps(app *a) { change_substeps(a, -1); }
static void more_substeps(app *a) { change_substeps(a, 1); }
static void restart(app *a) { app_restart(a, &a->session.settings); }
static void pause_or_go(app *a) { app_check(a, session_set_paused(&a->session, !a->session.paused)); }
static void toggle_help(app *a) { a->frame.show_help = !a->frame.show_help; }
static void toggle_hud(app *a) { a->frame.show_hud = !a->frame.show_hud; }
static void save_picture(app *a) { a->save_asked = true; }
static void quit(app *a) { a->running = false; }

static void step_once(app *a)
{
    app_check(a, session_set_paused(&a->session, true));
    app_check(a, stf_clock_single_step(&a->session.clock));
}

static void toggle_ghost(app *a)
{
    settings chosen = a->session.settings;
    const stf_integrator *telling = chosen.integrator == &stf_explicit_euler ? &stf_rk4 : &stf_explicit_euler;

    chosen.ghost = chosen.ghost ? NULL : a->ghost ? a->ghost : telling;
    app_restart(a, &chosen);
}

static void reset_view(app *a) { a->frame.look = look_at_scene(a->session.settings.scene, a->session.main.world); }

typedef struct binding {
    SDL_Keycode key;
    void (*act)(app *a);
    bool repeats; /* while the key is held */
} binding;

static const binding bindings[] = {
    {SDLK_LEFTBRACKET, scene_before, false}, {SDLK_RIGHTBRACKET, scene_after, false},
    {SDLK_p, pause_or_go, false},            {SDLK_SPACE, pause_or_go, false},
    {SDLK_o, step_once, true},               {SDLK_r, restart, false},
    {SDLK_PLUS, faster, true},               {SDLK_EQUALS, faster, true},
    {SDLK_KP_PLUS, faster, true},            {SDLK_MINUS, slower, true},
    {SDLK_KP_MINUS, slower, true},           {SDLK_COMMA, halve_step, false},
    {SDLK_PERIOD, double_step, false},       {SDLK_SEMICOLON, fewer_substeps, true},
    {SDLK_QUOTE, more_substeps, true},       {SDLK_PAGEDOWN, fewer_substeps, true},
    {SDLK_PAGEUP, more_substeps, true},      {SDLK_g, toggle_ghost, false},
    {SDLK_v, reset_view, false},             {SDLK_h, toggle_hud, false},
    {SDLK_F1, toggle_help, false},           {SDLK_F12, save_picture, false},
    {SDLK_ESCAPE, quit, false},
};

static void press(app *a, const SDL_KeyboardEvent *event)
{
    const SDL_Keysym *key = &event->keysym;
    const bool shift = (key->mod & KMOD_SHIFT) != 0;

    /* Digits and brackets by place: other keyboards have them on other levels. */
    if (key->scancode >= SDL_SCANCODE_1 && key->scancode <= SDL_SCANCODE_9 && !event->repeat) {
        choose_integrator(a, (int)(key->scancode - SDL_SCANCODE_1), shift);
        return;
    }
    if (key->scancode >= SDL_SCANCODE_KP_1 && key->scancode <= SDL_SCANCODE_KP_9 && !event->repeat) {
        choose_integrator(a, (int)(key->scancode - SDL_SCANCODE_KP_1), shift);
        return;
    }
    for (size_t i = 0; i < sizeof bindings / sizeof *bindings; i++)
        if (bindings[i].key == key->sym) {
            if (!event->repeat || bindings[i].repeats)
                bindings[i].act(a);
            return;
        }
    if (!event->repeat && (key->scancode == SDL_SCANCODE_LEFTBRACKET || key->scancode == SDL_SCANCODE_RIGHTBRACKET))
        change_scene(a, key->scancode == SDL_SCANCODE_LEFTBRACKET ? -1 : 1);
}

/* ---- mouse --------------------------------------------------------------------------------------------------------------- */

static bool has_stage(const app *a) { return a->session.settings.scene != &scene_drag; }

/* Events come in window coordinates, which on dense displays are not pixels. */
static void note_pointer(app *a, double x, double y)
{
    int width, height;

    SDL_GetWindowSize(a->window, &width, &height);
    a->pointer_x = width > 0 ? x * a->canvas->width / width : x;
    a->pointer_y = height > 0 ? y * a->canvas->height / height : y;
}

static void take_hold(app *a)
{
    const camera view = frame_camera(a->canvas, &a->frame, &a->session);
    const double reach = PICK_REACH * (double)a->canvas->unit;
    size_t particle;

    if (has_stage(a) && stage_pick(&a->session, &view, a->pointer_x, a->pointer_y, reach, &particle))
        app_check(a, grab_start(&a->grab, &a->session, particle));
}

static void pull(app *a)
{
    const camera view = frame_camera(a->canvas, &a->frame, &a->session);
    const point at = camera_project_vector(&view, a->grab.target);

    a->grab.target = camera_move(&view, a->grab.target, a->pointer_x - at.x, a->pointer_y - at.y,
                                 a->session.settings.scene->dimensions);
}

static void move_pointer(app *a, const SDL_MouseMotionEvent *event)
{
    const double before_x = a->pointer_x, before_y = a->pointer_y;

    note_pointer(a, event->x, event->y);
    if (a->grab.active)
        pull(a);
    else if (has_stage(a) && (event->state & (SDL_BUTTON_RMASK | SDL_BUTTON_MMASK)) != 0) {
        const camera view = frame_camera(a->canvas, &a->frame, &a->session);
        look_pan(&a->frame.look, &view, a->pointer_x - before_x, a->pointer_y - before_y);
    }
}

static void turn_wheel(app *a, const SDL_MouseWheelEvent *event)
{
    const camera view = frame_camera(a->canvas, &a->frame, &a->session);
    const double notches = (event->direction == SDL_MOUSEWHEEL_FLIPPED ? -1 : 1) * (double)event->preciseY;
    const double factor = notches >= 0 ? 1 + (ZOOM_PER_NOTCH - 1) * notches : 1 / (1 - (ZOOM_PER_NOTCH - 1) * notches);

    if (has_stage(a))
        look_zoom(&a->frame.look, &view, factor, a->pointer_x, a->pointer_y);
}

void controls_handle(app *a, const SDL_Event *event)
{
    const double renewed = 1e9; /* s: figures as old as this are renewed at once */

    if (event->type == SDL_QUIT) {
        a->running = false;
    } else if (event->type == SDL_KEYDOWN) {
        press(a, &event->key);
        a->hud_age = renewed;
    } else if (event->type == SDL_MOUSEMOTION) {
        move_pointer(a, &event->motion);
    } else if (event->type == SDL_MOUSEBUTTONDOWN && event->button.button == SDL_BUTTON_LEFT) {
        note_pointer(a, event->button.x, event->button.y);
        if (!a->grab.active)
            take_hold(a);
    } else if (event->type == SDL_MOUSEBUTTONUP && event->button.button == SDL_BUTTON_LEFT) {
        app_check(a, grab_end(&a->grab, &a->session));
    } else if (event->type == SDL_MOUSEWHEEL) {
        turn_wheel(a, &event->wheel);
    } else if (event->type == SDL_RENDER_TARGETS_RESET || event->type == SDL_RENDER_DEVICE_RESET) {
        canvas_forget_textures(a->canvas);
    }
}
