/* A small co-simulation FMU 2.0 by hand, y = gain * v of the step's input, which fails in the way that its resources' folder asks for. */
#include <stddef.h>
#include <stdlib.h>

#ifndef FAILURE
#define FAILURE 0
#endif

typedef void *component;
typedef unsigned int reference;
static double v, y;

component fmi2Instantiate(const char *name, int kind, const char *guid, const char *place, const void *callbacks, int visible, int logging) {
    (void)name; (void)kind; (void)guid; (void)place; (void)callbacks; (void)visible; (void)logging;
    return FAILURE == 4 ? NULL : &v;
}
void fmi2FreeInstance(component c) { (void)c; }
int fmi2SetupExperiment(component c, int has, double tolerance, double begin, int ends, double end) {
    (void)c; (void)has; (void)tolerance; (void)begin; (void)ends; (void)end;
    return 0;
}
int fmi2EnterInitializationMode(component c) { (void)c; return 0; }
int fmi2ExitInitializationMode(component c) { (void)c; y = 2.0 * v; return 0; }
int fmi2Terminate(component c) { (void)c; return 0; }
int fmi2Reset(component c) { (void)c; return 0; }
int fmi2SetReal(component c, const reference *r, size_t count, const double *x) {
    (void)c; (void)r; (void)count;
    v = x[0];
    return 0;
}
int fmi2GetReal(component c, const reference *r, size_t count, double *x) {
    (void)c; (void)r; (void)count;
    x[0] = y;
    return 0;
}
int fmi2DoStep(component c, double point, double step, int keeps) {
    (void)c; (void)step; (void)keeps;
    if (point > 0.3) {
        if (FAILURE == 1) abort();
        if (FAILURE == 2) for (;;) {}
        if (FAILURE == 3) return 3;
        if (FAILURE == 5) { y = 0.0 / (v - v); return 0; }
    }
    y = 2.0 * v;
    return 0;
}
