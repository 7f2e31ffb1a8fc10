/* Runs a compensator over recorded cycles and compares it with what stands beside them. Prints
 * cycles, those equal to the bit, greatest deviation of an output over its value, cycles with
 * another status, sizeof the state, nanoseconds a step. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "@X@.h"

#ifndef NOW /* a clock and its rate, of a target that has no clock() */
#define NOW clock
#define NOW_PER_SECOND CLOCKS_PER_SEC
#else
unsigned long NOW(void);
#endif

typedef struct {
    uint32_t event, status;
    @X@_input in;
    REAL position, effort;
} cycle;

static double deviation(REAL is, REAL expected)
{
    const double d = (double)is - (double)expected, e = (double)expected;
    if (!(d < 0.0) && !(d > 0.0)) {
        return d >= 0.0 ? 0.0 : 1e300; /* equal, or not a number */
    }
    return !(e < 0.0) && !(e > 0.0) ? 1e300 : (d < 0.0 ? -d : d) / (e < 0.0 ? -e : e);
}

int main(int count, char **arguments)
{
    enum { AT_ONCE = 1024 };
    static cycle cycles[AT_ONCE];
    static @X@_output outs[AT_ONCE];
    static @X@ x;
    unsigned long all = 0, equal = 0, statuses = 0;
    double worst = 0.0, seconds = 0.0;
    size_t read, i;
    FILE *file = fopen(count > 1 ? arguments[1] : "cases.bin", "rb");

    if (file == NULL) {
        printf("no cases\n");
        return 1;
    }
    @X@_init(&x);
    while ((read = fread(cycles, sizeof cycles[0], AT_ONCE, file)) > 0) {
        const unsigned long begin = (unsigned long)NOW();
        for (i = 0; i < read; i++) {
            if (cycles[i].event == 1 || cycles[i].event == 2) {
                @X@_switch(&x, cycles[i].event == 1);
            } else if (cycles[i].event == 3) {
                @X@_reset(&x);
            }
            @X@_step(&x, &cycles[i].in, &outs[i]);
        }
        seconds += (double)((unsigned long)NOW() - begin) / NOW_PER_SECOND;
        for (i = 0; i < read; i++) {
            const double p = deviation(outs[i].position, cycles[i].position);
            const double e = deviation(outs[i].effort, cycles[i].effort);
            equal += p <= 0.0 && e <= 0.0;
            worst = p > worst ? p : worst;
            worst = e > worst ? e : worst;
            statuses += outs[i].status != (int32_t)cycles[i].status;
        }
        all += (unsigned long)read;
    }
    printf("%lu %lu %g %lu %lu %.1f\n", all, equal, worst, statuses, (unsigned long)sizeof x,
           1e9 * seconds / (double)(all > 0 ? all : 1));
    return !(worst <= (sizeof(REAL) == 8 ? 1e-12 : 2.5e-7) && statuses == 0);
}
