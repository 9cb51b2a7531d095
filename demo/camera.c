#include "camera.h"

#include <math.h>

#define SCENE_ASPECT 1.5 /* a scene is taken to be this much wider than high */
#define ZOOM_MIN 0.02
#define ZOOM_MAX 500.0

/* Turned by 35 degrees about the vertical and looked down on by 20. */
static const double oblique_right[3] = {0.819152, 0, -0.573576}, oblique_up[3] = {-0.196175, 0.939693, -0.280167};

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(double result[3], const double a[3], const double b[3])
{
    result[0] = a[1] * b[2] - a[2] * b[1];
    result[1] = a[2] * b[0] - a[0] * b[2];
    result[2] = a[0] * b[1] - a[1] * b[0];
}

static bool normalise(double a[3])
{
    const double length = sqrt(dot(a, a));

    for (int d = 0; d < 3; d++)
        a[d] /= length > 0 ? length : 1;
    return length > 0;
}

/* The axis that everything turns about: the angular momentum. */
static void add_angular_momentum(const stf_world *world, double axis[3])
{
    for (size_t i = 0; i < stf_world_count(world); i++) {
        stf_particle p;
        if (stf_world_get(world, i, &p) || !(p.inverse_mass > 0))
            continue;
        const double x[3] = {(double)p.position.x, (double)p.position.y, (double)p.position.z};
        const double v[3] = {(double)p.velocity.x, (double)p.velocity.y, (double)p.velocity.z};
        double turn[3];
        cross(turn, x, v);
        for (int d = 0; d < 3; d++)
            axis[d] += turn[d] / (double)p.inverse_mass;
    }
}

static void face_plane(look *l, const stf_world *world)
{
    double axis[3] = {0};

    add_angular_momentum(world, axis);
    if (!normalise(axis) || fabs(axis[0]) > 0.99)
        return;
    for (int d = 0; d < 3; d++)
        l->right[d] -= axis[0] * axis[d]; /* right is x here: what of x lies in the plane */
    normalise(l->right);
    cross(l->up, axis, l->right);
}

/* Scenes say nothing about z: what falls swings from here to 0, and is looked at half-way. */
static double mean_depth(const stf_world *world)
{
    const size_t count = stf_world_count(world);
    double sum = 0;

    for (size_t i = 0; i < count; i++) {
        stf_particle p;
        if (stf_world_get(world, i, &p) == STF_OK)
            sum += (double)p.position.z;
    }
    return count > 0 && isfinite(sum) ? sum / (double)count : 0;
}

look look_at_scene(const scene *s, const stf_world *world)
{
    look l = {.right = {1, 0, 0}, .up = {0, 1, 0}, .zoom = 1};
    const bool falls = s->gravity.x != 0 || s->gravity.y != 0 || s->gravity.z != 0;

    if (s->dimensions == 3 && falls)
        for (int d = 0; d < 3; d++)
            l.right[d] = oblique_right[d], l.up[d] = oblique_up[d];
    else if (s->dimensions == 3)
        face_plane(&l, world);
    const double centre[3] = {s->view_x, s->view_y, falls ? mean_depth(world) / 2 : 0};
    l.centre_x = dot(l.right, centre);
    l.centre_y = dot(l.up, centre);
    return l;
}

camera camera_make(const scene *s, const look *l, SDL_FRect area)
{
    const double high = (double)area.h / (2 * s->view_half_height);
    const double wide = (double)area.w / (2 * s->view_half_height * SCENE_ASPECT);

    return (camera){.look = *l, .area = area, .scale = l->zoom * fmin(high, wide)};
}

point camera_project(const camera *c, const double position[3])
{
    return (point){(double)c->area.x + (double)c->area.w / 2 + (dot(c->look.right, position) - c->look.centre_x) * c->scale,
                   (double)c->area.y + (double)c->area.h / 2 - (dot(c->look.up, position) - c->look.centre_y) * c->scale};
}

point camera_project_vector(const camera *c, stf_vector position)
{
    const double components[3] = {(double)position.x, (double)position.y, (double)position.z};

    return camera_project(c, components);
}

stf_vector camera_move(const camera *c, stf_vector from, double pixels_x, double pixels_y, unsigned dimensions)
{
    double to[3] = {(double)from.x, (double)from.y, (double)from.z};

    for (unsigned d = 0; d < dimensions; d++)
        to[d] += (c->look.right[d] * pixels_x - c->look.up[d] * pixels_y) / c->scale;
    return (stf_vector){(stf_real)to[0], (stf_real)to[1], (stf_real)to[2]};
}

void look_zoom(look *l, const camera *c, double factor, double x, double y)
{
    const double zoom = fmax(ZOOM_MIN, fmin(ZOOM_MAX, l->zoom * factor)), kept = 1 - l->zoom / zoom;

    l->centre_x += (x - (double)c->area.x - (double)c->area.w / 2) / c->scale * kept;
    l->centre_y -= (y - (double)c->area.y - (double)c->area.h / 2) / c->scale * kept;
    l->zoom = zoom;
}

void look_pan(look *l, const camera *c, double pixels_x, double pixels_y)
{
    l->centre_x -= pixels_x / c->scale;
    l->centre_y += pixels_y / c->scale;
}
