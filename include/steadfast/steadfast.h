/* Steadfast: all of it. Particles moved by forces, integrators to choose from, a clock for fixed steps. */
#ifndef STEADFAST_H
#define STEADFAST_H

#include "steadfast/base.h"
#include "steadfast/clock.h"
#include "steadfast/force.h"
#include "steadfast/integrator.h"
#include "steadfast/particle.h"
#include "steadfast/save.h"
#include "steadfast/stability.h"
#include "steadfast/trade.h"
#include "steadfast/world.h"

#endif
