/* FMI 2.0: model exchange and co-simulation. */
#include "plant.h"

#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif
#ifdef FMI2_FUNCTION_PREFIX /* of a source unit that is linked statically */
#define JOIN(a, b) a##b
#define JOINED(a, b) JOIN(a, b)
#define FMI2(name) JOINED(FMI2_FUNCTION_PREFIX, fmi2##name)
#else
#define FMI2(name) fmi2##name
#endif

typedef unsigned Vr;
typedef const char *String;
typedef struct {
    void (*logger)(void *, String, int, String, String, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;
typedef struct {
    int new_discrete_states_needed, terminate, nominals_changed, states_changed, next_defined;
    double next;
} EventInfo;

static void report(Plant *p, int status, const char *sentence) {
    void (*logger)(void *, String, int, String, String, ...);
    memcpy(&logger, &p->logger, sizeof logger);
    if (logger) logger(p->environment, p->name, status, "logStatusError", "%s", sentence);
}

static int unknown(Plant *p, size_t n) {
    if (!n) return OK;
    report(p, ERROR, "all variables are real");
    return ERROR;
}

EXPORT String FMI2(GetTypesPlatform)(void) { return "default"; }
EXPORT String FMI2(GetVersion)(void) { return "2.0"; }

EXPORT Plant *FMI2(Instantiate)(String name, int type, String guid, String resources,
                                const Callbacks *back, int visible, int logging) {
    void *logger = NULL;
    (void)type, (void)visible, (void)logging;
    if (back) memcpy(&logger, &back->logger, sizeof logger);
    return plant_new(name, guid, resources, report, back ? back->environment : NULL, logger);
}
EXPORT void FMI2(FreeInstance)(Plant *p) { plant_free(p); }
EXPORT int FMI2(SetDebugLogging)(Plant *p, int on, size_t n, const String categories[]) {
    (void)p, (void)on, (void)n, (void)categories;
    return OK;
}
EXPORT int FMI2(SetupExperiment)(Plant *p, int toleranced, double tolerance, double start,
                                 int stops, double stop) {
    (void)toleranced, (void)tolerance, (void)stops, (void)stop;
    *p->time = start;
    return OK;
}
EXPORT int FMI2(EnterInitializationMode)(Plant *p) { return p ? OK : ERROR; }
EXPORT int FMI2(ExitInitializationMode)(Plant *p) { return p ? OK : ERROR; }
EXPORT int FMI2(Terminate)(Plant *p) { return p ? OK : ERROR; }
EXPORT int FMI2(Reset)(Plant *p) {
    plant_reset(p);
    return OK;
}

EXPORT int FMI2(GetReal)(Plant *p, const Vr vr[], size_t n, double value[]) {
    return plant_get(p, vr, n, value);
}
EXPORT int FMI2(SetReal)(Plant *p, const Vr vr[], size_t n, const double value[]) {
    return plant_set(p, vr, n, value);
}
#define NO_VARIABLES(name, kind)                                                              \
    EXPORT int FMI2(Get##name)(Plant * p, const Vr vr[], size_t n, kind value[]) {            \
        (void)vr, (void)value;                                                                \
        return unknown(p, n);                                                                 \
    }                                                                                         \
    EXPORT int FMI2(Set##name)(Plant * p, const Vr vr[], size_t n, const kind value[]) {      \
        (void)vr, (void)value;                                                                \
        return unknown(p, n);                                                                 \
    }
NO_VARIABLES(Integer, int)
NO_VARIABLES(Boolean, int)
NO_VARIABLES(String, String)

EXPORT int FMI2(FreeFMUstate)(Plant *p, void **state) {
    (void)p;
    free(*state);
    *state = NULL;
    return OK;
}
EXPORT int FMI2(GetFMUstate)(Plant *p, void **state) {
    free(*state);
    *state = plant_snapshot(p);
    return *state ? OK : ERROR;
}
EXPORT int FMI2(SetFMUstate)(Plant *p, void *state) {
    plant_restore(p, state);
    return OK;
}
EXPORT int FMI2(SerializedFMUstateSize)(Plant *p, void *state, size_t *size) {
    (void)state;
    *size = p->length * sizeof(double);
    return OK;
}
EXPORT int FMI2(SerializeFMUstate)(Plant *p, void *state, char bytes[], size_t size) {
    if (size < p->length * sizeof(double)) return ERROR;
    memcpy(bytes, state, p->length * sizeof(double));
    return OK;
}
EXPORT int FMI2(DeSerializeFMUstate)(Plant *p, const char bytes[], size_t size, void **state) {
    if (size != p->length * sizeof(double)) return ERROR;
    if (!*state) *state = malloc(size);
    if (!*state) return ERROR;
    memcpy(*state, bytes, size);
    return OK;
}

EXPORT int FMI2(GetDirectionalDerivative)(Plant *p, const Vr of[], size_t n, const Vr by[],
                                          size_t m, const double seed[], double value[]) {
    return plant_sensitivity(p, of, n, by, m, seed, value);
}

/* ---- model exchange ------------------------------------------------------------------- */

EXPORT int FMI2(EnterEventMode)(Plant *p) { return p ? OK : ERROR; }
EXPORT int FMI2(EnterContinuousTimeMode)(Plant *p) { return p ? OK : ERROR; }
EXPORT int FMI2(NewDiscreteStates)(Plant *p, EventInfo *info) {
    (void)p;
    memset(info, 0, sizeof *info);
    return OK;
}
EXPORT int FMI2(CompletedIntegratorStep)(Plant *p, int keep, int *event, int *terminate) {
    (void)p, (void)keep;
    *event = *terminate = 0;
    return OK;
}
EXPORT int FMI2(SetTime)(Plant *p, double time) {
    *p->time = time;
    return OK;
}
EXPORT int FMI2(SetContinuousStates)(Plant *p, const double x[], size_t n) {
    if (n != 2 * p->modes) return ERROR;
    plant_set_states(p, x);
    return OK;
}
EXPORT int FMI2(GetContinuousStates)(Plant *p, double x[], size_t n) {
    if (n != 2 * p->modes) return ERROR;
    memcpy(x, p->x, n * sizeof *x);
    return OK;
}
EXPORT int FMI2(GetNominalsOfContinuousStates)(Plant *p, double nominal[], size_t n) {
    if (n != 2 * p->modes) return ERROR;
    memcpy(nominal, p->nominal, n * sizeof *nominal);
    return OK;
}
EXPORT int FMI2(GetDerivatives)(Plant *p, double dx[], size_t n) {
    if (n != 2 * p->modes) return ERROR;
    plant_derivatives(p, dx);
    return OK;
}
EXPORT int FMI2(GetEventIndicators)(Plant *p, double z[], size_t n) {
    (void)p, (void)z;
    return n ? ERROR : OK;
}

/* ---- co-simulation -------------------------------------------------------------------- */

EXPORT int FMI2(DoStep)(Plant *p, double time, double step, int keep) {
    (void)keep;
    return plant_advance(p, time, step);
}
EXPORT int FMI2(CancelStep)(Plant *p) { return unknown(p, 1); }
EXPORT int FMI2(SetRealInputDerivatives)(Plant *p, const Vr vr[], size_t n, const int order[],
                                         const double value[]) {
    return plant_set_slopes(p, vr, n, order, value);
}
EXPORT int FMI2(GetRealOutputDerivatives)(Plant *p, const Vr vr[], size_t n, const int order[],
                                          double value[]) {
    (void)vr, (void)order, (void)value;
    return unknown(p, n);
}
EXPORT int FMI2(GetStatus)(Plant *p, int kind, int *value) {
    (void)p, (void)kind, (void)value;
    return DISCARD;
}
EXPORT int FMI2(GetRealStatus)(Plant *p, int kind, double *value) {
    if (kind != 2) return DISCARD;
    *value = *p->time;
    return OK;
}
EXPORT int FMI2(GetIntegerStatus)(Plant *p, int kind, int *value) {
    (void)p, (void)kind, (void)value;
    return DISCARD;
}
EXPORT int FMI2(GetBooleanStatus)(Plant *p, int kind, int *value) {
    if (kind != 3) return DISCARD;
    (void)p;
    *value = 0;
    return OK;
}
EXPORT int FMI2(GetStringStatus)(Plant *p, int kind, String *value) {
    (void)p, (void)kind, (void)value;
    return DISCARD;
}
