/* A set point and the forces along it. */
typedef struct {
    @real@ position;     /* @L@ */
    @real@ velocity;     /* @L@/s */
    @real@ acceleration; /* @L@/s^2 */
    @real@ sticking;     /* share of bristles that follow the motion */
    @real@ rigid;        /* N m: torque without wind-up */
    @real@ inertia;      /* kg m^2: that turns with the wind-up */
} @X@_ahead;

/* A set point with wind-up and torque. */
typedef struct {
    @X@_ahead at;
    @real@ wind_up;     /* rad */
    @real@ motor_speed; /* rad/s */
    @real@ torque;      /* N m */
} @X@_wound;

/* The plan: forces along the motion ahead, wind-up behind a Gaussian, the actuator inverted. */
typedef struct {
    @X@_ahead ahead[@HALF@ + 2];
    @X@_wound wound[@LATE@ + 2];
    @real@ samples[2 * (2 * @HALF@ + 1)]; /* rad: wind-up, each twice */
    @real@ bristle, speed;                /* of the friction, in its coordinate */
    @real@ home;                          /* rad: wind-up at the start */
    @real@ held;                          /* @E@: what the drive's integrator holds */
    @real@ own;                           /* @E@: what this compensator added last */
    @real@ torque, integral_d, integral_q; /* of the actuator: N m, V */
    @real@ past_d[@SAMPLED@], past_q[@SAMPLED@]; /* A: its currents, the newest first */
    uint32_t ahead_at, wound_at, sample_at; /* where the next one goes */
    uint32_t pushed;                        /* set points since the start, up to the first planned one */
    int32_t started;
} @X@_plan;
