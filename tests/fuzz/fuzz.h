/* What the fuzz targets share: programs out of bytes, claims, memory that is watched, and what a program can name. */
#ifndef STEADFAST_TESTS_FUZZ_H
#define STEADFAST_TESTS_FUZZ_H

#include "../support/real.h"
#include "steadfast/steadfast.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* What libFuzzer, AFL++ and replay.c call; a fault aborts. */
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

/* Whether every call of the library is written to stdout, to see what an input does: replay.c's -v. */
extern bool fuzz_verbose;

#define claim(condition) ((condition) ? (void)0 : broken(#condition, __FILE__, __LINE__))
void broken(const char *what, const char *file, int line);

/* ---- bytes that are read as numbers; behind their end there are zeros ------------------------------------------------- */

typedef struct program {
    const uint8_t *at;
    size_t left;
} program;

unsigned take(program *p); /* a byte */
uint64_t take_integer(program *p, size_t bytes);
stf_real take_real(program *p); /* mostly quarters from -25 to 25; else an extreme, or any bits */
double take_double(program *p);
stf_vector take_vector(program *p, unsigned dimensions);

/* ---- memory ------------------------------------------------------------------------------------------------------------ */

/* An allocator: blocks end where their memory ends, and start as garbage, other garbage in each world. */
typedef struct ration {
    int garbage;
    unsigned fail_in; /* the allocation, from here, that returns NULL; 0: none */
    bool refused;     /* one did */
    bool closed;      /* none may be asked for */
    size_t blocks;    /* out now */
} ration;

stf_allocator ration_allocator(ration *r);

/* ---- what a program can name ------------------------------------------------------------------------------------------ */

/*
 * A force. `layout` is its record, a letter a number: i the index of a particle, v a vector, k a coefficient of 0 or more, s
 * one of any sign, r any real, 1 2 4 8 an integer of so many bytes. Its descriptor is bad where `layout` is NULL.
 */
typedef struct subject {
    const stf_force *force;
    const char *layout;
} subject;

#define RECORD_BYTES_MAX 64
#define SUBJECTS 20
extern const subject subjects[SUBJECTS];

void take_record(program *p, const subject *s, unsigned dimensions, size_t particle_count, void *record);

/* Bits, 1 << stf_result, of what may be said against a record in a world of so many particles; 0: nothing. */
unsigned record_faults(const subject *s, const void *record, unsigned dimensions, size_t particle_count);

/* Of the numbers in a record, not of its pads. */
uint64_t record_hash(const subject *s, const void *record);

/* What stf_world_remove makes of a record; false: it is dropped. */
bool record_renumber(const subject *s, void *record, size_t removed, size_t last);

/* Bits of what may be said against a particle, and against a step. */
unsigned particle_faults(const stf_particle *particle, unsigned dimensions, bool keep_radius);
unsigned vector_faults(stf_vector v, unsigned dimensions);
bool is_step(double step, unsigned substeps);

/* Integrators; from GOOD_INTEGRATORS on their descriptors are bad. */
#define INTEGRATORS 14
#define GOOD_INTEGRATORS 10
extern const stf_integrator *const integrators[INTEGRATORS];

/* Whether a world refuses this one of them. */
bool is_refused(unsigned integrator, bool compensated);

/* For stf_parallel: backwards, as a test that the order does not matter. */
void run_backwards(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context);

/* The same number, or both NaN: machines do not agree on the bits of a NaN. */
bool is_same_real(stf_real a, stf_real b);
bool is_same_vector(stf_vector a, stf_vector b);

/* Has the next world that is made run the loops of one instruction set, if the machine has it. */
void choose_instructions(unsigned byte);

#endif
