#include "steadfast/base.h"

static const char *const texts[STF_RESULT_COUNT] = {
    [STF_OK] = "no error",
    [STF_ERROR_NULL] = "a required pointer is NULL",
    [STF_ERROR_MEMORY] = "no memory, or a size that does not fit the address space",
    [STF_ERROR_NOT_FINITE] = "a value is NaN or infinite",
    [STF_ERROR_DIMENSIONS] = "dimensions are not 1, 2 or 3, or a vector is not 0 in a dimension that the world lacks",
    [STF_ERROR_STEP] = "the step (over the substeps) is not a positive finite number that the precision can hold",
    [STF_ERROR_SUBSTEPS] = "substeps are 0, or more than STF_SUBSTEPS_MAX",
    [STF_ERROR_MASS] = "the inverse mass is negative, not finite, or of a mass too large for the precision (0 is immovable)",
    [STF_ERROR_RADIUS] = "the radius is negative or not finite, or the world was not created with keep_radius",
    [STF_ERROR_PARTICLE] = "no particle has this index",
    [STF_ERROR_FORCE] = "no force of this world has this id",
    [STF_ERROR_PARAMETERS] = ("a parameter is negative or not finite, a spring has one end twice, "
                              "or the force has no parameters"),
    [STF_ERROR_DESCRIPTOR] = "an integrator, force or allocator lacks what is required of it or asks for too many arrays",
    [STF_ERROR_FRAME_TIME] = "a frame time, time scale or display period is negative or not finite",
    [STF_ERROR_ALPHA] = "the blending factor is not in [0, 1]",
    [STF_ERROR_STRIDE] = "the stride is smaller than the vector that it steps over, or so large that no memory holds all",
    [STF_ERROR_NO_PREVIOUS] = "the world was not created with keep_previous",
    [STF_ERROR_BUFFER] = "the buffer is too small",
    [STF_ERROR_UNSAVABLE] = "a force has records but no fields that say what they are made of",
    [STF_ERROR_FOREIGN] = "the buffer holds no saved world",
    [STF_ERROR_VERSION] = "the world was saved in a format that this version of the library does not read",
    [STF_ERROR_PRECISION] = "the world was saved in the other precision",
    [STF_ERROR_TRUNCATED] = "the end of the saved world is missing",
    [STF_ERROR_ALTERED] = "the saved world has been altered",
    [STF_ERROR_MISMATCH] = "the world has not the dimensions, options, integrator or forces of the saved one",
    [STF_ERROR_SNAPSHOT] = "the memory holds no snapshot, or the world lacks forces or room that it had",
    [STF_ERROR_DIVERGED] = "a particle is no longer finite or within the bounds of the guard: see stf_world_fault",
};

const char *stf_result_text(stf_result result)
{
    const unsigned index = (unsigned)result;

    return index < STF_RESULT_COUNT ? texts[index] : "not a result of this library";
}

#define TEXT_OF(number) #number
#define VERSION(major, minor, patch) TEXT_OF(major) "." TEXT_OF(minor) "." TEXT_OF(patch)

const char *stf_version(void) { return VERSION(STF_VERSION_MAJOR, STF_VERSION_MINOR, STF_VERSION_PATCH); }
