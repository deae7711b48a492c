/* FMI 3.0: model exchange and co-simulation. */
#include "plant.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif
#ifdef FMI3_FUNCTION_PREFIX /* of a source unit that is linked statically */
#define JOIN(a, b) a##b
#define JOINED(a, b) JOIN(a, b)
#define FMI3(name) JOINED(FMI3_FUNCTION_PREFIX, fmi3##name)
#else
#define FMI3(name) fmi3##name
#endif

typedef uint32_t Vr;
typedef const char *String;
typedef const uint8_t *Binary;
typedef void (*Log)(void *, int, String, String);

static void report(Plant *p, int status, const char *sentence) {
    Log log;
    memcpy(&log, &p->logger, sizeof log);
    if (log) log(p->environment, status, "logStatusError", sentence);
}

static int unknown(Plant *p, size_t n) {
    if (!n) return OK;
    report(p, ERROR, "all variables are Float64, without clocks");
    return ERROR;
}

static Plant *instance(String name, String token, String resources, void *environment, Log log) {
    void *logger;
    memcpy(&logger, &log, sizeof logger);
    return plant_new(name, token, resources, report, environment, logger);
}

EXPORT String FMI3(GetVersion)(void) { return "3.0"; }

EXPORT Plant *FMI3(InstantiateModelExchange)(String name, String token, String resources,
                                             bool visible, bool logging, void *environment,
                                             Log log) {
    (void)visible, (void)logging;
    return instance(name, token, resources, environment, log);
}
EXPORT Plant *FMI3(InstantiateCoSimulation)(String name, String token, String resources,
                                            bool visible, bool logging, bool events, bool early,
                                            const Vr vr[], size_t n, void *environment, Log log,
                                            void (*update)(void)) {
    (void)visible, (void)logging, (void)events, (void)early, (void)vr, (void)n, (void)update;
    return instance(name, token, resources, environment, log);
}
EXPORT Plant *FMI3(InstantiateScheduledExecution)(String name, String token, String resources,
                                                  bool visible, bool logging, void *environment,
                                                  Log log, void (*clock)(void),
                                                  void (*lock)(void), void (*unlock)(void)) {
    (void)name, (void)token, (void)resources, (void)visible, (void)logging;
    (void)clock, (void)lock, (void)unlock;
    if (log) log(environment, ERROR, "logStatusError", "there is no scheduled execution");
    return NULL;
}
EXPORT void FMI3(FreeInstance)(Plant *p) { plant_free(p); }
EXPORT int FMI3(SetDebugLogging)(Plant *p, bool on, size_t n, const String categories[]) {
    (void)p, (void)on, (void)n, (void)categories;
    return OK;
}
EXPORT int FMI3(EnterInitializationMode)(Plant *p, bool toleranced, double tolerance,
                                         double start, bool stops, double stop) {
    (void)toleranced, (void)tolerance, (void)stops, (void)stop;
    *p->time = start;
    return OK;
}
EXPORT int FMI3(ExitInitializationMode)(Plant *p) { return p ? OK : ERROR; }
EXPORT int FMI3(EnterConfigurationMode)(Plant *p) { return p ? OK : ERROR; }
EXPORT int FMI3(ExitConfigurationMode)(Plant *p) { return p ? OK : ERROR; }
EXPORT int FMI3(EnterEventMode)(Plant *p) { return p ? OK : ERROR; }
EXPORT int FMI3(EnterStepMode)(Plant *p) { return p ? OK : ERROR; }
EXPORT int FMI3(EnterContinuousTimeMode)(Plant *p) { return p ? OK : ERROR; }
EXPORT int FMI3(EvaluateDiscreteStates)(Plant *p) { return p ? OK : ERROR; }
EXPORT int FMI3(Terminate)(Plant *p) { return p ? OK : ERROR; }
EXPORT int FMI3(Reset)(Plant *p) {
    plant_reset(p);
    return OK;
}
EXPORT int FMI3(UpdateDiscreteStates)(Plant *p, bool *again, bool *terminate, bool *nominals,
                                      bool *states, bool *defined, double *next) {
    (void)p, (void)next;
    *again = *terminate = *nominals = *states = *defined = false;
    return OK;
}

EXPORT int FMI3(GetFloat64)(Plant *p, const Vr vr[], size_t n, double value[], size_t m) {
    return n == m ? plant_get(p, vr, n, value) : ERROR;
}
EXPORT int FMI3(SetFloat64)(Plant *p, const Vr vr[], size_t n, const double value[], size_t m) {
    return n == m ? plant_set(p, vr, n, value) : ERROR;
}
#define NO_VARIABLES(name, kind)                                                              \
    EXPORT int FMI3(Get##name)(Plant * p, const Vr vr[], size_t n, kind value[], size_t m) {  \
        (void)vr, (void)value, (void)m;                                                       \
        return unknown(p, n);                                                                 \
    }                                                                                         \
    EXPORT int FMI3(Set##name)(Plant * p, const Vr vr[], size_t n, const kind value[],        \
                               size_t m) {                                                    \
        (void)vr, (void)value, (void)m;                                                       \
        return unknown(p, n);                                                                 \
    }
NO_VARIABLES(Float32, float)
NO_VARIABLES(Int8, int8_t)
NO_VARIABLES(UInt8, uint8_t)
NO_VARIABLES(Int16, int16_t)
NO_VARIABLES(UInt16, uint16_t)
NO_VARIABLES(Int32, int32_t)
NO_VARIABLES(UInt32, uint32_t)
NO_VARIABLES(Int64, int64_t)
NO_VARIABLES(UInt64, uint64_t)
NO_VARIABLES(Boolean, bool)
NO_VARIABLES(String, String)
EXPORT int FMI3(GetBinary)(Plant *p, const Vr vr[], size_t n, size_t sizes[], Binary value[],
                           size_t m) {
    (void)vr, (void)sizes, (void)value, (void)m;
    return unknown(p, n);
}
EXPORT int FMI3(SetBinary)(Plant *p, const Vr vr[], size_t n, const size_t sizes[],
                           const Binary value[], size_t m) {
    (void)vr, (void)sizes, (void)value, (void)m;
    return unknown(p, n);
}
#define NO_CLOCKS(name, first, second)                                                        \
    EXPORT int FMI3(name)(Plant * p, const Vr vr[], size_t n, first, second) {                \
        (void)vr, (void)a, (void)b;                                                           \
        return unknown(p, n);                                                                 \
    }
#define NO_CLOCK(name, first)                                                                 \
    EXPORT int FMI3(name)(Plant * p, const Vr vr[], size_t n, first) {                        \
        (void)vr, (void)a;                                                                    \
        return unknown(p, n);                                                                 \
    }
NO_CLOCK(GetClock, bool a[])
NO_CLOCK(SetClock, const bool a[])
NO_CLOCK(GetShiftDecimal, double a[])
NO_CLOCK(SetShiftDecimal, const double a[])
NO_CLOCK(SetIntervalDecimal, const double a[])
NO_CLOCKS(GetIntervalDecimal, double a[], int b[])
NO_CLOCKS(GetShiftFraction, uint64_t a[], uint64_t b[])
NO_CLOCKS(SetShiftFraction, const uint64_t a[], const uint64_t b[])
NO_CLOCKS(SetIntervalFraction, const uint64_t a[], const uint64_t b[])
EXPORT int FMI3(GetIntervalFraction)(Plant *p, const Vr vr[], size_t n, uint64_t counters[],
                                     uint64_t resolutions[], int qualifiers[]) {
    (void)vr, (void)counters, (void)resolutions, (void)qualifiers;
    return unknown(p, n);
}
EXPORT int FMI3(ActivateModelPartition)(Plant *p, Vr clock, double time) {
    (void)clock, (void)time;
    return unknown(p, 1);
}
EXPORT int FMI3(GetNumberOfVariableDependencies)(Plant *p, Vr vr, size_t *n) {
    (void)vr, (void)n;
    return unknown(p, 1);
}
EXPORT int FMI3(GetVariableDependencies)(Plant *p, Vr of, size_t at[], Vr by[], size_t where[],
                                         int kinds[], size_t n) {
    (void)of, (void)at, (void)by, (void)where, (void)kinds, (void)n;
    return unknown(p, 1);
}

EXPORT int FMI3(FreeFMUState)(Plant *p, void **state) {
    (void)p;
    free(*state);
    *state = NULL;
    return OK;
}
EXPORT int FMI3(GetFMUState)(Plant *p, void **state) {
    free(*state);
    *state = plant_snapshot(p);
    return *state ? OK : ERROR;
}
EXPORT int FMI3(SetFMUState)(Plant *p, void *state) {
    plant_restore(p, state);
    return OK;
}
EXPORT int FMI3(SerializedFMUStateSize)(Plant *p, void *state, size_t *size) {
    (void)state;
    *size = p->length * sizeof(double);
    return OK;
}
EXPORT int FMI3(SerializeFMUState)(Plant *p, void *state, uint8_t bytes[], size_t size) {
    if (size < p->length * sizeof(double)) return ERROR;
    memcpy(bytes, state, p->length * sizeof(double));
    return OK;
}
EXPORT int FMI3(DeserializeFMUState)(Plant *p, const uint8_t bytes[], size_t size, void **state) {
    if (size != p->length * sizeof(double)) return ERROR;
    if (!*state) *state = malloc(size);
    if (!*state) return ERROR;
    memcpy(*state, bytes, size);
    return OK;
}

EXPORT int FMI3(GetDirectionalDerivative)(Plant *p, const Vr of[], size_t n, const Vr by[],
                                          size_t m, const double seed[], size_t seeds,
                                          double value[], size_t values) {
    return seeds == m && values == n ? plant_sensitivity(p, of, n, by, m, seed, value) : ERROR;
}
EXPORT int FMI3(GetAdjointDerivative)(Plant *p, const Vr of[], size_t n, const Vr by[], size_t m,
                                      const double seed[], size_t seeds, double value[],
                                      size_t values) {
    (void)of, (void)n, (void)by, (void)m, (void)seed, (void)seeds, (void)value, (void)values;
    report(p, ERROR, "there are no adjoint derivatives");
    return ERROR;
}

/* ---- model exchange ------------------------------------------------------------------- */

EXPORT int FMI3(CompletedIntegratorStep)(Plant *p, bool keep, bool *event, bool *terminate) {
    (void)p, (void)keep;
    *event = *terminate = false;
    return OK;
}
EXPORT int FMI3(SetTime)(Plant *p, double time) {
    *p->time = time;
    return OK;
}
EXPORT int FMI3(SetContinuousStates)(Plant *p, const double x[], size_t n) {
    if (n != 2 * p->modes) return ERROR;
    plant_set_states(p, x);
    return OK;
}
EXPORT int FMI3(GetContinuousStates)(Plant *p, double x[], size_t n) {
    if (n != 2 * p->modes) return ERROR;
    memcpy(x, p->x, n * sizeof *x);
    return OK;
}
EXPORT int FMI3(GetNominalsOfContinuousStates)(Plant *p, double nominal[], size_t n) {
    if (n != 2 * p->modes) return ERROR;
    memcpy(nominal, p->nominal, n * sizeof *nominal);
    return OK;
}
EXPORT int FMI3(GetContinuousStateDerivatives)(Plant *p, double dx[], size_t n) {
    if (n != 2 * p->modes) return ERROR;
    plant_derivatives(p, dx);
    return OK;
}
EXPORT int FMI3(GetEventIndicators)(Plant *p, double z[], size_t n) {
    (void)p, (void)z;
    return n ? ERROR : OK;
}
EXPORT int FMI3(GetNumberOfEventIndicators)(Plant *p, size_t *n) {
    (void)p;
    *n = 0;
    return OK;
}
EXPORT int FMI3(GetNumberOfContinuousStates)(Plant *p, size_t *n) {
    *n = 2 * p->modes;
    return OK;
}

/* ---- co-simulation -------------------------------------------------------------------- */

EXPORT int FMI3(GetOutputDerivatives)(Plant *p, const Vr vr[], size_t n, const int32_t orders[],
                                      double values[], size_t m) {
    (void)vr, (void)orders, (void)values, (void)m;
    return unknown(p, n);
}
EXPORT int FMI3(DoStep)(Plant *p, double time, double step, bool keep, bool *event,
                        bool *terminate, bool *early, double *reached) {
    (void)keep;
    *event = *terminate = *early = false;
    int status = plant_advance(p, time, step);
    *reached = *p->time;
    return status;
}
