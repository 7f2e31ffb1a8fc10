/* Start-up of a Cortex-M4F under qemu (machine mps2-an386), and a count of its instructions. */
#include <stdint.h>
#include <stdlib.h>

extern uint32_t bss_begin[], bss_end[], stack_top[];
extern void initialise_monitor_handles(void);
extern int main(int, char **);
unsigned long instructions(void);
void _init(void);
void _fini(void);

/* What the library calls at start and end; there is nothing to do. */
void _init(void) {}
void _fini(void) {}

#define SYSTICK ((volatile uint32_t *)0xE000E010u)
#define COPROCESSORS ((volatile uint32_t *)0xE000ED88u)

static void begin(void)
{
    uint32_t *word;

    *COPROCESSORS |= 0xFu << 20; /* the floating-point unit */
    for (word = bss_begin; word < bss_end; word++) {
        *word = 0;
    }
    SYSTICK[1] = 0xFFFFFF;
    SYSTICK[2] = 0;
    SYSTICK[0] = 5; /* on, at the processor's 25 MHz */
    initialise_monitor_handles();
    exit(main(0, NULL));
}

static void fault(void)
{
    exit(2);
}

__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    void (*handlers[6])(void);
} vectors = {stack_top, {begin, fault, fault, fault, fault, fault}};

/* Instructions so far: with -icount shift=0 each takes 1 ns, and a tick 40 of them. */
unsigned long instructions(void)
{
    static uint32_t before = 0xFFFFFF;
    static unsigned long ticks = 0;
    const uint32_t now = SYSTICK[2];

    ticks += (before - now) & 0xFFFFFF;
    before = now;
    return 40 * ticks;
}
