/* Limits, fading and watchdog. */
typedef struct {
    int32_t status;     /* of enum @X@_status */
    uint32_t faded;     /* cycles faded in */
    uint32_t beyond[3]; /* cycles for which position, effort and surprise were beyond their limits */
    uint32_t blend;     /* cycles in which it still goes over from what it let through before */
    @X@_limits limits;
    @real@ position;    /* @L@: the last offset that was a number, within its limit */
    @real@ effort;      /* @E@: likewise */
    @real@ passed[2];   /* @L@, @E@: what was let through last */
    @real@ from[2];     /* and what is gone over from */
} @X@_guard;
