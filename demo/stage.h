/* stage: a scene's world as it looks from a camera: springs, trails, particles, the ghost, and where all should be exactly. */
#ifndef STEADFAST_DEMO_STAGE_H
#define STEADFAST_DEMO_STAGE_H

#include "camera.h"
#include "draw.h"
#include "grab.h"
#include "session.h"

/* session_place has to have been called. */
void stage_draw(canvas *c, const session *s, const camera *view);

/* The held particle, and the line that it is pulled by. */
void stage_draw_hand(canvas *c, const session *s, const camera *view, const grab *hand);

/* What stands for what, right-aligned at (right, y). */
void stage_legend(canvas *c, const session *s, double right, double y);

/* The drawn particle nearest to the pixel (x, y), at most `reach` pixels away; false: none. */
bool stage_pick(const session *s, const camera *view, double x, double y, double reach, size_t *particle);

#endif
