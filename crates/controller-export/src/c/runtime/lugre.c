/* The bristles' steady deflection and their relaxation per unit of sliding, at a speed |w|. */
static void friction_curve(real speed, real *bristle, real *decay)
{
    if (speed >= FRICTION.flat_above) {
        *bristle = FRICTION.coulomb_bristle;
        *decay = FRICTION.coulomb_decay;
    } else {
        const real x = speed * FRICTION.per_stribeck_speed;
        real level = FRICTION.coulomb + FRICTION.rise * exp_minus(x * x);
        if (level > FRICTION.stiction) {
            level = FRICTION.stiction;
        }
        *bristle = level * FRICTION.compliance;
        *decay = FRICTION.stiffness / level;
    }
}

/* The bristles after a time h at a constant speed: exact. */
static real friction_relax(real z0, real speed, real h)
{
    real bristle, decay, z1, limit;

    friction_curve(absolute(speed), &bristle, &decay);
    z1 = z0 + (with_sign(bristle, speed) - z0) * one_minus_exp(decay * absolute(speed) * h);
    limit = (bristle > absolute(z0)) ? bristle : absolute(z0);
    return (absolute(z1) > limit) ? with_sign(limit, z1) : z1;
}

/* The bristles after a step of h in which the speed goes linearly from w0 to w1. */
static real friction_step(real z0, real w0, real w1, real h)
{
    if (w0 * w1 >= R(0.0)) {
        return friction_relax(z0, R(0.5) * (w0 + w1), h);
    } else {
        const real before = h * (w0 / (w0 - w1));
        const real z = friction_relax(z0, R(0.5) * w0, before);
        return friction_relax(z, R(0.5) * w1, h - before);
    }
}

/* Friction at a deflection and a speed. */
static real friction_torque(real z, real speed)
{
    real bristle, decay, rate;

    friction_curve(absolute(speed), &bristle, &decay);
    rate = decay * absolute(speed) * (with_sign(bristle, speed) - z);
    return FRICTION.stiffness * z + FRICTION.damping * rate + FRICTION.viscous * speed;
}
