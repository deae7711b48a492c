/* A modal state space: what FMI 2.0 (fmi2.c) and FMI 3.0 (fmi3.c) have in common.

   Mode k, of modal mass 1:  q'' + 2 z w q' + w^2 q = sum_j B[j][k] u[j],  w = 2 pi f.
   Output i: sum_k P[k][i] times q, q' or q''. Value references, without gaps: inputs, outputs,
   states (q, q' of each mode in turn), their derivatives, frequencies f [Hz], damping ratios z,
   time. */
#ifndef PLANT_H
#define PLANT_H
#include <stddef.h>

enum { OK = 0, WARNING, DISCARD, ERROR, FATAL };
enum { QUANTITIES = 3, TOKEN = 64 };

typedef struct Plant Plant;
typedef void (*Report)(Plant *, int status, const char *sentence);

struct Plant {
    size_t modes, inputs, outputs;
    size_t first[QUANTITIES + 1]; /* of the outputs of a quantity, in the order of P */
    size_t *place;                /* of each output in that order */
    const double *B, *P, *nominal;
    double *file;                 /* what was read: f, z, nominal, B, quantities, P */
    size_t length;                /* of what a snapshot holds: */
    double *time, *x, *u, *slope, *f, *z; /* slope: of the inputs, by time */
    double *push, *a, *y, *seed;  /* modal forces, accelerations, outputs in the order of P, room */
    double *step, held;           /* six numbers a mode that step by `held` seconds */
    int pushed, known;            /* push belongs to the present inputs, a and y to all */
    Report report;
    void *environment, *logger;
    char *name;
};

Plant *plant_new(const char *name, const char *token, const char *resources, Report report,
                 void *environment, void *logger);
void plant_free(Plant *);
void plant_reset(Plant *);
int plant_get(Plant *, const unsigned vr[], size_t n, double value[]);
int plant_set(Plant *, const unsigned vr[], size_t n, const double value[]);
int plant_set_slopes(Plant *, const unsigned vr[], size_t n, const int order[],
                     const double value[]);
void plant_set_states(Plant *, const double x[]);
void plant_derivatives(Plant *, double dx[]);
int plant_advance(Plant *, double from, double by);
int plant_sensitivity(Plant *, const unsigned unknown[], size_t n, const unsigned known[],
                      size_t m, const double seed[], double value[]);
double *plant_snapshot(const Plant *);
void plant_restore(Plant *, const double snapshot[]);
#endif
