@TOP@
#ifndef @U@_H
#define @U@_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

@DECLARATIONS@
/* Everything forgotten, switched off, limits as exported. Before any other call; a state that was never
 * inited is inited by the first one. */
void @X@_init(@X@ *x);

/* The next step is the first of a motion from rest. The guard keeps its state, and goes over from what it
 * let through last to the new motion's corrections: no jump, switched on or off. */
void @X@_reset(@X@ *x);

/* Other limits from the next step on, at any moment. Returns 0, and changes nothing, unless position, effort
 * and surprise are above 0. */
int @X@_limit(@X@ *x, const @X@_limits *limits);

/* Fades the correction in (on is not 0) or out, at any moment. Switching on takes back a trip. */
void @X@_switch(@X@ *x, int on);

/* One control cycle. Call it while switched off too: it goes on observing. */
void @X@_step(@X@ *x, const @X@_input *in, @X@_output *out);

#ifdef __cplusplus
}
#endif

#endif
