/* What the programs in C have in common: fmu2.c and fmu3.c. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Messages of the logger that are as they have to be. */
static int told = 0;

#define CHECK(call, status)                                  \
    do {                                                     \
        if ((call) != (status)) {                            \
            fprintf(stderr, "line %d: %s\n", __LINE__, #call); \
            return 1;                                        \
        }                                                    \
    } while (0)
