/* A host of its own: host LIBRARY RESOURCES TOKEN VERSION STEP OUTPUTS < inputs > outputs
   Steps a unit by co-simulation, one line of three inputs a step; the state is saved, serialised,
   read back and restored around a step that is thrown away. */
#include <dlfcn.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    void (*log)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void *none, *environment;
} Callbacks;

static void *library;
static void log2(void *e, const char *n, int s, const char *c, const char *m, ...) {
    (void)e, (void)n, (void)c;
    fprintf(stderr, "status %d: %s\n", s, m);
}
static void log3(void *e, int s, const char *c, const char *m) {
    (void)e, (void)c;
    fprintf(stderr, "status %d: %s\n", s, m);
}
static void (*find(int version, const char *name))(void) {
    char whole[80];
    void (*function)(void);
    snprintf(whole, sizeof whole, "fmi%d%s", version, name);
    void *found = dlsym(library, whole);
    if (!found) fprintf(stderr, "no %s\n", whole), exit(3);
    memcpy(&function, &found, sizeof function);
    return function;
}
#define CALL(name, result, ...) ((result(*)(__VA_ARGS__))find(version, name))
#define MUST(call) do { if ((call) != 0) { fprintf(stderr, "%s\n", #call); return 4; } } while (0)

int main(int n, char **words) {
    if (n != 7) return 2;
    int version = atoi(words[4]), outputs = atoi(words[6]);
    double step = atof(words[5]), u[3], time = 0.0;
    library = dlopen(words[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) return fprintf(stderr, "%s\n", dlerror()), 3;
    Callbacks back = {log2, calloc, free, NULL, NULL};
    void *p;
    unsigned in[] = {0, 1, 2}, *out = calloc(outputs, sizeof *out);
    double *y = calloc(outputs, sizeof *y);
    for (int i = 0; i < outputs; i++) out[i] = 3 + i;
    if (version == 2) {
        p = CALL("Instantiate", void *, const char *, int, const char *, const char *,
                 const Callbacks *, int, int)("one", 1, words[3], words[2], &back, 0, 0);
        if (!p) return 5;
        MUST(CALL("SetupExperiment", int, void *, int, double, double, int, double)(
            p, 0, 0.0, 0.0, 0, 0.0));
        MUST(CALL("EnterInitializationMode", int, void *)(p));
    } else {
        p = CALL("InstantiateCoSimulation", void *, const char *, const char *, const char *,
                 bool, bool, bool, bool, const unsigned *, size_t, void *,
                 void (*)(void *, int, const char *, const char *), void *)(
            "one", words[3], words[2], false, false, false, false, NULL, 0, NULL, log3, NULL);
        if (!p) return 5;
        MUST(CALL("EnterInitializationMode", int, void *, bool, double, double, bool, double)(
            p, false, 0.0, 0.0, false, 0.0));
    }
    MUST(CALL("ExitInitializationMode", int, void *)(p));
    const char *set = version == 2 ? "SetReal" : "SetFloat64";
    const char *get = version == 2 ? "GetReal" : "GetFloat64";
    const char *state = version == 2 ? "FMUstate" : "FMUState";
    const char *from = version == 2 ? "DeSerializeFMUstate" : "DeserializeFMUState";
    char name[40];
    while (scanf("%lf %lf %lf", u, u + 1, u + 2) == 3) {
        MUST(CALL(set, int, void *, const unsigned *, size_t, const double *, size_t)(
            p, in, 3, u, 3));
        void *saved = NULL, *again = NULL;
        size_t size;
        snprintf(name, sizeof name, "Get%s", state);
        MUST(CALL(name, int, void *, void **)(p, &saved));
        snprintf(name, sizeof name, "Serialized%sSize", state);
        MUST(CALL(name, int, void *, void *, size_t *)(p, saved, &size));
        unsigned char *bytes = malloc(size);
        snprintf(name, sizeof name, "Serialize%s", state);
        MUST(CALL(name, int, void *, void *, unsigned char *, size_t)(p, saved, bytes, size));
        for (int twice = 0; twice < 2; twice++) {
            if (version == 2) {
                MUST(CALL("DoStep", int, void *, double, double, int)(
                    p, time, twice ? step : 0.37 * step, 0));
            } else {
                bool event, stop, early;
                double reached;
                MUST(CALL("DoStep", int, void *, double, double, bool, bool *, bool *, bool *,
                          double *)(p, time, twice ? step : 0.37 * step, false, &event, &stop,
                                    &early, &reached));
                if (event || stop || early) return 6;
            }
            if (!twice) {
                MUST(CALL(from, int, void *, const unsigned char *, size_t, void **)(
                    p, bytes, size, &again));
                snprintf(name, sizeof name, "Set%s", state);
                MUST(CALL(name, int, void *, void *)(p, again));
            }
        }
        snprintf(name, sizeof name, "Free%s", state);
        MUST(CALL(name, int, void *, void **)(p, &saved));
        MUST(CALL(name, int, void *, void **)(p, &again));
        free(bytes);
        time += step;
        MUST(CALL(get, int, void *, const unsigned *, size_t, double *, size_t)(
            p, out, outputs, y, outputs));
        for (int i = 0; i < outputs; i++) printf("%.17g ", y[i]);
        printf("\n");
    }
    MUST(CALL("Terminate", int, void *)(p));
    CALL("FreeInstance", void, void *)(p);
    return 0;
}
