/* Limits, fading and watchdog. */
typedef struct {
    int32_t status;     /* of enum @X@_status */
    uint32_t faded;     /* cycles faded in */
    uint32_t beyond[3]; /* cycles for which position, effort and surprise were beyond their limits */
    @real@ position;    /* @L@: the last offset that was a number, within its limit */
    @real@ effort;      /* @E@: likewise */
} @X@_guard;
