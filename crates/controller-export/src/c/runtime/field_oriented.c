/* Voltages that hold currents (A) at an electrical speed (rad/s). */
static real steady_d(real speed, real d, real q)
{
    return -speed * INDUCTANCE_Q * q + d * RESISTANCE;
}

static real steady_q(real speed, real d, real q)
{
    return speed * (INDUCTANCE_D * d + FLUX_LINKAGE) + q * RESISTANCE;
}

/* The currents after a cycle under a voltage, the motor turning at a mean speed (rad/s):
 * implicit midpoint rule. */
static void motor_step(real d, real q, real ud, real uq, real speed, real *after_d, real *after_q)
{
    const real half = R(0.5) * PERIOD;
    const real rhs_d = ud - steady_d(POLE_PAIRS * speed, d, q);
    const real rhs_q = uq - steady_q(POLE_PAIRS * speed, d, q);
    const real turn = half * POLE_PAIRS * speed;
    const real dd = INDUCTANCE_D + half * RESISTANCE;
    const real qq = INDUCTANCE_Q + half * RESISTANCE;
    const real dq = turn * INDUCTANCE_Q;
    const real qd = turn * INDUCTANCE_D;
    const real scale = PERIOD / (dd * qq + dq * qd);

    *after_d = d + (scale * qq * rhs_d + scale * dq * rhs_q);
    *after_q = q + (-scale * qd * rhs_d + scale * dd * rhs_q);
}

static real motor_torque(real d, real q)
{
    const real saliency = INDUCTANCE_D - INDUCTANCE_Q;
    return R(1.5) * POLE_PAIRS * (FLUX_LINKAGE + saliency * d) * q;
}

/* At rest with a torque that it has held for ever. */
static void actuator_settle(@X@_plan *s, real torque)
{
    uint32_t i;

    s->torque = torque;
    for (i = 0; i < SAMPLED; i++) {
        s->past_d[i] = R(0.0);
        s->past_q[i] = torque / GEAR / (R(1.5) * POLE_PAIRS * FLUX_LINKAGE);
    }
    s->integral_d = steady_d(R(0.0), s->past_d[0], s->past_q[0]);
    s->integral_q = steady_q(R(0.0), s->past_d[0], s->past_q[0]);
}

static real actuator_now(const @X@_plan *s)
{
    return s->past_q[0];
}

/* A current as its controller sampled it, before the voltage made of it acts. */
static real sampled(const real *past)
{
#if SAMPLED_BETWEEN
    return past[SAMPLED - 2u] * (R(1.0) - SAMPLED_PART) + past[SAMPLED - 1u] * SAMPLED_PART;
#else
    return past[SAMPLED - 1u];
#endif
}

/* The command of the cycle, at whose end the torque is to be `torque`, the motor turning
 * at the mean `speed`. */
static real actuator_towards(@X@_plan *s, real torque, real speed)
{
    const real at = GEAR * speed;
    const real per_error = Q_GAIN + Q_INTEGRAL * PERIOD;
    const real current_d = s->past_d[0];
    const real current_q = s->past_q[0];
    const real sampled_q = sampled(s->past_q);
    uint32_t i;
    real ud, free_d, free_q, one_d, one_q, rise_d, rise_q, wanted, left, error, effort, uq;

    error = -sampled(s->past_d);
    s->integral_d += D_INTEGRAL * PERIOD * error;
    ud = limited(D_GAIN * error + s->integral_d, VOLTAGE);
    motor_step(current_d, current_q, ud, R(0.0), at, &free_d, &free_q);
    motor_step(current_d, current_q, ud, R(1.0), at, &one_d, &one_q);
    rise_d = one_d - free_d;
    rise_q = one_q - free_q;
    wanted = (torque / (GEAR * motor_torque(free_d, R(1.0))) - free_q) / rise_q;
    /* As the drive limits it: d first, then what the vector leaves for q, and the command. */
    left = root(greatest((VOLTAGE - ud) * (VOLTAGE + ud), R(0.0)));
    error = (limited(wanted, left) - s->integral_q) / per_error;
    effort = limited(sampled_q + error, ACTUATOR_LIMIT);
    error = effort - sampled_q;
    s->integral_q += Q_INTEGRAL * PERIOD * error;
    uq = limited(Q_GAIN * error + s->integral_q, left);
    for (i = SAMPLED - 1u; i > 0; i--) {
        s->past_d[i] = s->past_d[i - 1u];
        s->past_q[i] = s->past_q[i - 1u];
    }
    s->past_d[0] = free_d + rise_d * uq;
    s->past_q[0] = free_q + rise_q * uq;
    s->torque = GEAR * motor_torque(s->past_d[0], s->past_q[0]);
    return effort;
}
