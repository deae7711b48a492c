#include "plant.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(OLD_GLIBC) && defined(__GLIBC__) && defined(__x86_64__) /* 2.14 is enough, not 2.29 */
__asm__(".symver exp,exp@GLIBC_2.2.5");
#endif

static const double TWO_PI = 6.283185307179586476925286766559;

static int fail(Plant *p, const char *sentence) {
    p->report(p, ERROR, sentence);
    return ERROR;
}

/* ---- modes ---------------------------------------------------------------------------- */

static void forces(const Plant *p, const double *u, double *restrict push) {
    memset(push, 0, p->modes * sizeof *push);
    for (size_t j = 0; j < p->inputs; j++) {
        const double *restrict b = p->B + j * p->modes, force = u[j];
        for (size_t k = 0; k < p->modes; k++) push[k] += b[k] * force;
    }
}

static void accelerations(const Plant *p, const double *x, const double *push, double *a) {
    for (size_t k = 0; k < p->modes; k++) {
        const double w = TWO_PI * p->f[k];
        a[k] = push[k] - 2.0 * p->z[k] * w * x[2 * k + 1] - w * w * x[2 * k];
    }
}

static void outputs(const Plant *p, const double *x, const double *a, double *restrict y) {
    memset(y, 0, p->outputs * sizeof *y);
    for (size_t k = 0; k < p->modes; k += 2) { /* two modes at a time; the last may be alone */
        const size_t next = k + 1 < p->modes ? k + 1 : k;
        const double *restrict row = p->P + k * p->outputs;
        const double *restrict other = p->P + next * p->outputs;
        const double one[] = {x[2 * k], x[2 * k + 1], a[k]}, pair = next > k;
        const double two[] = {pair * x[2 * next], pair * x[2 * next + 1], pair * a[next]};
        for (int s = 0; s < QUANTITIES; s++) {
            const double of = one[s], and = two[s];
            for (size_t i = p->first[s]; i < p->first[s + 1]; i++)
                y[i] += row[i] * of + other[i] * and;
        }
    }
}

static void push(Plant *p) {
    if (p->pushed) return;
    forces(p, p->u, p->push);
    p->pushed = 1;
}

static void know(Plant *p) {
    if (p->known) return;
    push(p);
    accelerations(p, p->x, p->push, p->a);
    outputs(p, p->x, p->a, p->y);
    p->known = 1;
}

/* Motion after h seconds under a unit force from rest (g'' + 2 d g' + w^2 g = 1: term = h^2 / 2,
   first = 2), or under one that grows by a unit a second (h^3 / 6, 3): the power series, free of
   cancellation where w h and d h are small. */
static double pushed(double w, double d, double h, double term, int first) {
    double before = 0.0, sum = term;
    for (int k = first; k < first + 58; k++) {
        double next = -(2.0 * d * h * k * term + w * w * h * h * before) / (k * (k + 1.0));
        before = term;
        term = next;
        sum += term;
        if (fabs(term) + fabs(before) < 1e-18 * fabs(sum)) break;
    }
    return sum;
}

/* The exponential of one mode, exp([[0, 1], [-w^2, -2 d]] h), and what a held and what a growing
   force add. */
static void exponential(double f, double z, double h, double *c) {
    double w = TWO_PI * f, d = z * w, s = w * sqrt(fabs(1.0 - z) * (1.0 + z)), S, C, g;
    if (s * h < 1e-4) { /* near critical damping, or no stiffness */
        double square = (z > 1.0 ? 1.0 : -1.0) * s * s * h * h, e = exp(-d * h);
        S = e * h * (1.0 + square / 6.0 * (1.0 + square / 20.0));
        C = e * (1.0 + square / 2.0 * (1.0 + square / 12.0));
    } else if (z > 1.0) {
        double slow = exp(-w * w / (d + s) * h), fast = exp(-(d + s) * h);
        S = (slow - fast) / (2.0 * s);
        C = (slow + fast) / 2.0;
    } else {
        double e = exp(-d * h);
        S = e * sin(s * h) / s;
        C = e * cos(s * h);
    }
    if (w * h < 0.5 && d * h < 0.5) {
        g = pushed(w, d, h, h * h / 2.0, 2);
        c[5] = pushed(w, d, h, h * h * h / 6.0, 3);
    } else {
        g = (1.0 - C - d * S) / (w * w);
        c[5] = (h - 2.0 * d * g - S) / (w * w);
    }
    c[0] = C + d * S;
    c[1] = S;
    c[2] = -w * w * S;
    c[3] = C - d * S;
    c[4] = g;
}

int plant_advance(Plant *p, double from, double by) {
    if (!(by >= 0.0) || !isfinite(from + by)) return fail(p, "a step must be 0 s or longer");
    if (by != p->held) {
        for (size_t k = 0; k < p->modes; k++)
            exponential(p->f[k], p->z[k], by, p->step + 6 * k);
        p->held = by;
    }
    int growing = 0;
    push(p);
    for (size_t k = 0; k < p->modes; k++) {
        const double *c = p->step + 6 * k, force = p->push[k];
        const double q = p->x[2 * k], v = p->x[2 * k + 1];
        p->x[2 * k] = c[0] * q + c[1] * v + c[4] * force;
        p->x[2 * k + 1] = c[2] * q + c[3] * v + c[1] * force;
    }
    for (size_t j = 0; j < p->inputs; j++) growing |= p->slope[j] != 0.0;
    if (growing) {
        forces(p, p->slope, p->a);
        for (size_t k = 0; k < p->modes; k++) {
            p->x[2 * k] += p->step[6 * k + 5] * p->a[k];
            p->x[2 * k + 1] += p->step[6 * k + 4] * p->a[k];
        }
        for (size_t j = 0; j < p->inputs; j++) p->u[j] += by * p->slope[j];
        p->pushed = 0;
    }
    *p->time = from + by;
    p->known = 0;
    return OK;
}

void plant_derivatives(Plant *p, double dx[]) {
    know(p);
    for (size_t k = 0; k < p->modes; k++) {
        dx[2 * k] = p->x[2 * k + 1];
        dx[2 * k + 1] = p->a[k];
    }
}

/* ---- variables ------------------------------------------------------------------------ */

enum { INPUT, OUTPUT, STATE, DERIVATIVE, FREQUENCY, DAMPING, TIME, NOTHING };

static int kind_of(const Plant *p, unsigned vr, size_t *i) {
    const size_t sizes[] = {p->inputs, p->outputs, 2 * p->modes, 2 * p->modes,
                            p->modes,  p->modes,   1};
    *i = vr;
    for (int kind = INPUT; kind < NOTHING; kind++) {
        if (*i < sizes[kind]) return kind;
        *i -= sizes[kind];
    }
    return NOTHING;
}

int plant_get(Plant *p, const unsigned vr[], size_t n, double value[]) {
    for (size_t j = 0; j < n; j++) {
        size_t i;
        switch (kind_of(p, vr[j], &i)) {
        case INPUT: value[j] = p->u[i]; break;
        case OUTPUT: know(p); value[j] = p->y[p->place[i]]; break;
        case STATE: value[j] = p->x[i]; break;
        case DERIVATIVE: know(p); value[j] = i % 2 ? p->a[i / 2] : p->x[i + 1]; break;
        case FREQUENCY: value[j] = p->f[i]; break;
        case DAMPING: value[j] = p->z[i]; break;
        case TIME: value[j] = *p->time; break;
        default: return fail(p, "a value reference that no variable has");
        }
    }
    return OK;
}

int plant_set(Plant *p, const unsigned vr[], size_t n, const double value[]) {
    for (size_t j = 0; j < n; j++) {
        size_t i;
        int kind = kind_of(p, vr[j], &i);
        double *all[] = {p->u, NULL, p->x, NULL, p->f, p->z, NULL, NULL};
        if (!all[kind]) return fail(p, "a variable that cannot be set");
        if (!isfinite(value[j])) return fail(p, "a value that is not finite");
        if (kind == FREQUENCY || kind == DAMPING) {
            if (value[j] < 0.0) return fail(p, "a frequency or damping ratio below 0");
            p->held = -1.0;
        }
        all[kind][i] = value[j];
        p->known = 0;
        if (kind == INPUT) p->pushed = 0;
    }
    return OK;
}

int plant_set_slopes(Plant *p, const unsigned vr[], size_t n, const int order[],
                     const double value[]) {
    for (size_t j = 0; j < n; j++) {
        size_t i;
        if (kind_of(p, vr[j], &i) != INPUT || order[j] != 1 || !isfinite(value[j]))
            return fail(p, "only first derivatives of inputs can be set");
        p->slope[i] = value[j];
    }
    return OK;
}

void plant_set_states(Plant *p, const double x[]) {
    memcpy(p->x, x, 2 * p->modes * sizeof *x);
    p->known = 0;
}

/* All is linear in states and inputs: the answer to a seed is the answer to that motion. */
int plant_sensitivity(Plant *p, const unsigned unknown[], size_t n, const unsigned known[],
                      size_t m, const double seed[], double value[]) {
    double *x = p->seed, *u = x + 2 * p->modes, *a = u + p->inputs, *y = a + p->modes;
    double *force = y + p->outputs;
    size_t i;
    int moved = 0, read = 0;
    memset(x, 0, (2 * p->modes + p->inputs) * sizeof *x);
    for (size_t j = 0; j < m; j++) {
        int kind = kind_of(p, known[j], &i);
        if (kind != INPUT && kind != STATE)
            return fail(p, "derivatives are by inputs and states only");
        (kind == INPUT ? u : x)[i] += seed[j];
    }
    for (size_t j = 0; j < n; j++) {
        int kind = kind_of(p, unknown[j], &i);
        if (kind != OUTPUT && kind != DERIVATIVE)
            return fail(p, "derivatives are of outputs and of the derivatives of states only");
        if (!moved++) {
            forces(p, u, force);
            accelerations(p, x, force, a);
        }
        if (kind == OUTPUT && !read++) outputs(p, x, a, y);
        value[j] = kind == OUTPUT ? y[p->place[i]] : i % 2 ? a[i / 2] : x[i + 1];
    }
    return OK;
}

double *plant_snapshot(const Plant *p) {
    double *copy = malloc(p->length * sizeof *copy);
    if (copy) memcpy(copy, p->time, p->length * sizeof *copy);
    return copy;
}

void plant_restore(Plant *p, const double snapshot[]) {
    memcpy(p->time, snapshot, p->length * sizeof *snapshot);
    p->known = p->pushed = 0;
    p->held = -1.0;
}

/* ---- life ----------------------------------------------------------------------------- */

void plant_reset(Plant *p) {
    memset(p->time, 0, p->length * sizeof *p->time);
    memcpy(p->f, p->file, 2 * p->modes * sizeof *p->f);
    p->known = p->pushed = 0;
    p->held = -1.0;
}

void plant_free(Plant *p) {
    if (!p) return;
    free(p->file);
    free(p->time);
    free(p->place);
    free(p->name);
    free(p);
}

static int hex(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    c = (char)(c | 32);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* A path, or a file URI of FMI 2.0 with its %XX, with the name of the file behind it. */
static char *path_of(const char *resources) {
    static const char file[] = "plant.bin";
    char *path = malloc(strlen(resources) + sizeof file + 1), *end = path;
    int uri = !strncmp(resources, "file:", 5);
    if (!path) return NULL;
    if (uri) {
        resources += 5;
        if (!strncmp(resources, "//", 2)) {
            resources += 2;
            if (!strncmp(resources, "localhost/", 10)) resources += 9;
        }
        if (resources[0] == '/' && resources[1] && resources[2] == ':') resources++;
    }
    while (*resources) {
        if (uri && *resources == '%' && hex(resources[1]) >= 0 && hex(resources[2]) >= 0) {
            *end++ = (char)(16 * hex(resources[1]) + hex(resources[2]));
            resources += 3;
        } else {
            *end++ = *resources++;
        }
    }
    if (end > path && end[-1] != '/' && end[-1] != '\\') *end++ = '/';
    strcpy(end, file);
    return path;
}

static const char *load(Plant *p, const char *resources, const char *token) {
    int64_t head[4];
    char own[TOKEN];
    char *path = path_of(resources);
    FILE *stream = path ? fopen(path, "rb") : NULL;
    free(path);
    if (!stream) return "plant.bin cannot be opened in the resources";
    if (fread(head, sizeof head, 1, stream) != 1 || head[0] != 0x31746e616c70 ||
        fread(own, sizeof own, 1, stream) != 1) {
        fclose(stream);
        return "plant.bin in the resources is not of this model";
    }
    size_t n = p->modes = (size_t)head[1], nu = p->inputs = (size_t)head[2];
    size_t ny = p->outputs = (size_t)head[3], all = 4 * n + n * nu + ny + n * ny;
    p->file = malloc((all + 1) * sizeof(double));
    p->length = 1 + 4 * n + 2 * nu;
    p->time = calloc(p->length + 12 * n + nu + 2 * ny, sizeof(double));
    p->place = malloc((ny + 1) * sizeof(size_t));
    size_t got = p->file && p->time && p->place ? fread(p->file, sizeof(double), all, stream) : 0;
    fclose(stream);
    if (got != all) return "plant.bin in the resources is cut off, or memory is short";
    if (!token || strncmp(own, token, sizeof own)) return "the token is not that of this model";
    p->nominal = p->file + 2 * n;
    p->B = p->nominal + 2 * n;
    const double *quantity = p->B + n * nu, *rows = quantity + ny;
    p->x = p->time + 1;
    p->u = p->x + 2 * n;
    p->slope = p->u + nu;
    p->f = p->slope + nu;
    p->z = p->f + n;
    p->push = p->z + n;
    p->a = p->push + n;
    p->y = p->a + n;
    p->seed = p->y + ny;
    p->step = p->seed + 4 * n + nu + ny;
    size_t at = 0;
    for (int s = 0; s < QUANTITIES; s++) {
        p->first[s] = at;
        for (size_t i = 0; i < ny; i++)
            if (quantity[i] == s) p->place[i] = at++;
    }
    p->first[QUANTITIES] = at;
    if (at != ny) return "plant.bin in the resources is not of this model";
    p->P = rows;
    double *line = malloc((ny + 1) * sizeof *line);
    if (!line) return "memory is short";
    for (size_t k = 0; k < n; k++) {
        double *row = p->file + (rows - p->file) + k * ny;
        for (size_t i = 0; i < ny; i++) line[p->place[i]] = row[i];
        memcpy(row, line, ny * sizeof *row);
    }
    free(line);
    return NULL;
}

Plant *plant_new(const char *name, const char *token, const char *resources, Report report,
                 void *environment, void *logger) {
    Plant *p = calloc(1, sizeof *p);
    if (!p) return NULL;
    p->report = report;
    p->environment = environment;
    p->logger = logger;
    if (!name) name = "";
    p->name = malloc(strlen(name) + 1);
    if (p->name) strcpy(p->name, name);
    const char *wrong = !p->name     ? "memory is short"
                        : !resources ? "the location of the resources is missing"
                                     : load(p, resources, token);
    if (wrong) {
        fail(p, wrong);
        plant_free(p);
        return NULL;
    }
    plant_reset(p);
    return p;
}
