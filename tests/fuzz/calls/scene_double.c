/* The double half of scene.c for targets in float; those in double have it already. */
#ifdef STF_DOUBLE
typedef int nothing_to_add;
#else
#define STF_DOUBLE
#include "scene.c"
#endif
