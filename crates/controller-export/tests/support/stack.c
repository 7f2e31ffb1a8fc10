/* Measures what a step takes of the stack and, where there is a counter of instructions (NOW), the most
 * that one took. Prints bytes and instructions (0 without a counter), each the greatest of all cycles. */
#include <stdio.h>
#include "@X@.h"

#ifdef NOW
unsigned long NOW(void);
#else
static unsigned long NOW(void)
{
    return 0ul;
}
#endif

typedef struct {
    uint32_t event, status;
    @X@_input in;
    REAL position, effort;
} cycle;

enum { ROOM = 16384 };

/* Where the frame of a function begins that is called from here, below its return address and the frame
 * pointer of before. */
static __attribute__((noinline)) volatile unsigned char *below(void)
{
    return (volatile unsigned char *)__builtin_frame_address(0);
}

/* Paints the stack below, makes a step, and looks how far down it was written. */
static __attribute__((noinline)) unsigned long stack_of(@X@ *x, const @X@_input *in, @X@_output *out, unsigned long *took)
{
    volatile unsigned char *const top = below();
    volatile unsigned char *at;
    unsigned long begin;

    for (at = top - ROOM; at < top; at++) {
        *at = 0xA5u;
    }
    begin = NOW();
    @X@_step(x, in, out);
    *took = NOW() - begin;
    for (at = top - ROOM; at < top && *at == 0xA5u; at++) {
    }
    return (unsigned long)(top - at) + 2ul * sizeof(void *);
}

int main(int count, char **arguments)
{
    static cycle now;
    static @X@_output out;
    static @X@ x;
    unsigned long most = 0, longest = 0, took;
    FILE *file = fopen(count > 1 ? arguments[1] : "cases.bin", "rb");

    if (file == NULL) {
        printf("no cases\n");
        return 1;
    }
    @X@_init(&x);
    while (fread(&now, sizeof now, 1, file) == 1) {
        unsigned long bytes;
        if (now.event == 1 || now.event == 2) {
            @X@_switch(&x, now.event == 1);
        } else if (now.event == 3) {
            @X@_reset(&x);
        }
        bytes = stack_of(&x, &now.in, &out, &took);
        most = bytes > most ? bytes : most;
        longest = took > longest ? took : longest;
    }
    printf("%lu %lu\n", most, longest);
    return most >= ROOM;
}
