/* Observer of the load's motion. */
typedef struct {
    @real@ position;         /* @L@ */
    @real@ wind_up_rate;     /* @L@/s: at which the transmission winds up */
    @real@ motor_side_speed; /* @L@/s: of the motor, at the load */
    @real@ velocity;         /* @L@/s */
    @real@ acceleration;     /* @L@/s^2 */
    int32_t started;
} @X@_estimator;
