/* Observer of the deviations from the plan, and what it took back last. */
typedef struct {
    @real@ expected[@STATES@], estimated[@STATES@]; /* in units of their own, the force's last */
    @real@ before_sticking, before_planned, before_effort; /* of the cycle before; @E@ */
    @real@ own, own_rate;                     /* @E@: what the drive's own loops add, and a cycle's change */
    @real@ speed;                             /* rad/s: of the motor along the plan, in the cycle before */
    @real@ surprise;                          /* deviations of the noise */
    @real@ effort;                            /* @E@: what the feedback added last */
    int32_t has_before;
} @X@_feedback;
