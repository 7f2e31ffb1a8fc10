/* exp(-u) for u >= 0: a table of 64 fractions and a polynomial. */
static real exp_minus(real u)
{
    number rounded, round, scale;
    bits k;
    real whole, r, tail, fraction;

    if (u > R(87.0)) {
        return R(0.0);
    }
    round.value = R(12582912.0);
    rounded.value = u * R(92.33248) + round.value;
    whole = rounded.value - round.value;
    r = (u - whole * R(0.01083374)) - whole * R(-3.3155382e-6);
    tail = (R(0.5) - R(0.16666667) * r) * (r * r) - r;
    k = rounded.pattern - round.pattern;
    fraction = FRACTIONS[k & 63u];
    scale.pattern = (127u - (k >> 6)) << 23;
    return (fraction + fraction * tail) * scale.value;
}

/* 1 - exp(-a) for a >= 0. */
static real one_minus_exp(real a)
{
    const real a2 = a * a;

    if (a < R(0.125)) {
        const real *q = SHORT_DECAY;
        return a + a2 * ((q[0] + q[1] * a) + (q[2] + q[3] * a) * a2);
    }
    if (a < R(0.7)) {
        const real *q = LONG_DECAY;
        return a + a2 * ((q[0] + q[1] * a) + ((q[2] + q[3] * a) + (q[4] + q[5] * a) * a2) * a2);
    }
    if (a < R(18.0)) {
        return R(1.0) - exp_minus(a);
    }
    return is_nan(a) ? a : R(1.0);
}
