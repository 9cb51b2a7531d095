/*
 * peer: the same work, done by another library. One file a peer; workload.c makes what they are given, and the tables (peers.c,
 * race.c) see nothing but this.
 */
#ifndef STEADFAST_TESTS_PEER_H
#define STEADFAST_TESTS_PEER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum workload_kind {
    FLIGHT,      /* v' = g - k v, along three axes (two: x and y) */
    CLOTH,       /* the net of demo/scenes/cloth.c: springs along rows, columns and diagonals, gravity, drag */
    KEPLER,      /* x'' = -x / |x|^3 in the plane, each with an orbit of its own */
    OSCILLATORS, /* x'' = -omega^2 x on a line, each with an omega of its own */
    WORKLOAD_KINDS
} workload_kind;

enum { DOES_FLIGHT = 1 << FLIGHT, DOES_CLOTH = 1 << CLOTH, DOES_RACE = 1 << KEPLER | 1 << OSCILLATORS };

typedef struct tie {
    uint32_t a, b;
    double rest_length; /* m */
} tie;

/* A body's three components stand together. Whatever a workload says, a body of inverse mass 0 is immovable. */
typedef struct workload {
    workload_kind kind;
    unsigned dimensions; /* those that move */
    size_t count, tie_count;
    double *position, *velocity; /* m, m/s: [3 count] */
    double *inverse_mass;        /* 1/kg: [count], the same for all that move */
    double *stiffness;           /* omega^2, N/m: [count] of OSCILLATORS */
    tie *ties;                 /* of CLOTH */
    double tie_stiffness, tie_damping; /* N/m, N s/m */
    double gravity;  /* m/s^2, along -y */
    double drag;     /* k, 1/s: the coefficient over the mass */
    double step;     /* s, of FLIGHT and CLOTH */
    double duration; /* s, of the race */
} workload;

/* A way in which a peer solves workloads. */
typedef struct method {
    const char *name;    /* NULL ends a list */
    unsigned workloads;  /* DOES_... */
    unsigned dimensions; /* of FLIGHT and CLOTH */
    unsigned order;      /* of FLIGHT and CLOTH: 1 or 4 */
    bool adaptive;       /* of the race: its setting is a tolerance, else a number of steps */
    size_t group;        /* bodies that are one state of an ODE; 0: all */
    bool other_cloth;    /* solves another cloth: shown, not checked */
    int variant;         /* the peer's own */
} method;

typedef struct peer {
    const char *name;
    const char *package; /* Debian's */
    const char *reals;   /* "float" or "double" */
    bool from_positions; /* keeps no velocity but the difference of two positions, which rounds coarsely */
    const char *note;    /* how it is used, and what distorts its figures; lines of at most 100 characters */
    void (*version)(char *text, size_t size);
    const method *(*methods)(void);

    /* Memory may be as much as it needs; NULL: it can't. setting: a step in s, for an adaptive method its tolerance. The
       workload outlives what is created. */
    void *(*create)(const workload *w, const method *m, double setting);
    void (*advance)(void *self, double duration); /* s: a multiple of a step */
    void (*read)(const void *self, double *position, double *velocity); /* [3 count] each, unmoved dimensions untouched */
    void (*destroy)(void *self);
} peer;

/* The acceleration of body i of the race, for peers that push their bodies one by one. */
void workload_pull(const workload *w, size_t i, const double position[3], double acceleration[3]);

/* flight(count, dimensions); cloth(side, dimensions); the race. The exact state after w->duration, [3 count] each. */
workload *workload_flight(size_t count, unsigned dimensions);
workload *workload_cloth(size_t side, unsigned dimensions);
workload *workload_race(workload_kind kind, size_t count);
void workload_exact(const workload *w, double time, double *position, double *velocity);
void workload_free(workload *w);

/* malloc, or the end of the program. */
void *need(size_t size);

#ifdef __cplusplus
}
#endif

#endif
