/* The double half of trade_scene.c for tests in float; those in double have it already. */
#ifdef STF_DOUBLE
typedef int nothing_to_add;
#else
#define STF_DOUBLE
#define TRADE_SCENE_BUILDER_ONLY
#include "trade_scene.c"
#endif
