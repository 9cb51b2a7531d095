/* controls: what keys and mouse do. */
#ifndef STEADFAST_DEMO_CONTROLS_H
#define STEADFAST_DEMO_CONTROLS_H

#include "app.h"

void controls_handle(app *a, const SDL_Event *event);

#endif
