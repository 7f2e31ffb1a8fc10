@TOP@
#ifndef @U@_H
#define @U@_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

@DECLARATIONS@
/* Everything forgotten, switched off. Before any other call. */
void @X@_init(@X@ *x);

/* The next step is the first of a motion from rest. The guard keeps its state. */
void @X@_reset(@X@ *x);

/* Fades the correction in (on is not 0) or out, at any moment. Switching on takes back a trip. */
void @X@_switch(@X@ *x, int on);

/* One control cycle. Call it while switched off too: it goes on observing. */
void @X@_step(@X@ *x, const @X@_input *in, @X@_output *out);

#ifdef __cplusplus
}
#endif

#endif
