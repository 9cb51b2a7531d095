/*
 * A square cloth, held at five points of one edge and let fall from the horizontal: springs along rows, columns and
 * diagonals.
 */
#include "scene.h"

#define SIDE 32        /* masses */
#define SPACING 0.05   /* m */
#define MASS 0.002     /* kg */
#define STIFFNESS 500  /* N/m */
#define DAMPING 0.05   /* N s/m */
#define AIR_DRAG 0.006 /* kg/s a mass: the swing dies away within seconds */
#define GRAVITY 9.81   /* m/s^2 */
#define SPRINGS (2 * SIDE * (SIDE - 1) + 2 * (SIDE - 1) * (SIDE - 1))

static const double sqrt_2 = 1.4142135623730951;

static bool is_held(uint32_t row, uint32_t column)
{
    return row == 0 && (column % 8 == 0 || column == SIDE - 1);
}

static uint32_t at(uint32_t row, uint32_t column) { return row * SIDE + column; }

static stf_result add_masses(stf_world *world)
{
    stf_particle masses[SIDE * SIDE];

    for (uint32_t row = 0; row < SIDE; row++)
        for (uint32_t column = 0; column < SIDE; column++)
            masses[at(row, column)] =
                (stf_particle){.position = {(stf_real)(SPACING * (column - (SIDE - 1) / 2.0)), 0, (stf_real)(SPACING * row)},
                               .inverse_mass = is_held(row, column) ? 0 : (stf_real)(1 / MASS)};
    return stf_world_add_many(world, masses, SIDE * SIDE, NULL);
}

static stf_spring spring(uint32_t a, uint32_t b, double length)
{
    return (stf_spring){
        .a = a, .b = b, .stiffness = STIFFNESS, .damping = (stf_real)DAMPING, .rest_length = (stf_real)length};
}

static stf_result add_springs(stf_world *world)
{
    stf_spring springs[SPRINGS];
    size_t count = 0;

    for (uint32_t row = 0; row < SIDE; row++)
        for (uint32_t column = 0; column < SIDE; column++) {
            const bool right = column + 1 < SIDE, down = row + 1 < SIDE;
            if (right)
                springs[count++] = spring(at(row, column), at(row, column + 1), SPACING);
            if (down)
                springs[count++] = spring(at(row, column), at(row + 1, column), SPACING);
            if (right && down) {
                springs[count++] = spring(at(row, column), at(row + 1, column + 1), SPACING * sqrt_2);
                springs[count++] = spring(at(row, column + 1), at(row + 1, column), SPACING * sqrt_2);
            }
        }
    return stf_world_add_force(world, &stf_force_springs, springs, count, NULL);
}

static stf_result populate(stf_world *world)
{
    const stf_linear_drag air = {.coefficient = (stf_real)AIR_DRAG};
    stf_result result = add_masses(world);

    if (!result)
        result = add_springs(world);
    if (!result)
        result = stf_world_add_force(world, &stf_force_linear_drag, &air, 1, NULL);
    return result;
}

const scene scene_cloth = {
    .name = "cloth",
    .title = "A damped cloth, 32 × 32 masses",
    .length_unit = "m",
    .time_unit = "s",
    .dimensions = 3,
    .integrator = &stf_semi_implicit_euler,
    .step = 1.0 / 1200,
    .duration = 1,
    .size = SPACING * (SIDE - 1),
    .time_scale = 1,
    .gravity = {0, (stf_real)-GRAVITY, 0},
    .view_y = -0.7,
    .view_half_height = 1,
    .populate = populate,
};
