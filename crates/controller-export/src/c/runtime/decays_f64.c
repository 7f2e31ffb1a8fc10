/* exp(-u) for u >= 0: a table of 64 fractions and a polynomial. */
static real exp_minus(real u)
{
    number rounded, round, scale;
    bits k;
    real whole, r, r2, tail, fraction;

    if (u > R(708.0)) {
        return R(0.0);
    }
    round.value = R(6755399441055744.0);
    rounded.value = u * R(92.33248261689366) + round.value;
    whole = rounded.value - round.value;
    r = (u - whole * R(0.010830424667801708)) - whole * R(2.8447437476627285e-11);
    r2 = r * r;
    tail = ((R(0.49999999999985073) - R(0.16666666666664534) * r)
            + (R(0.04166670739519204) - R(0.008333339151693509) * r) * r2) * r2 - r;
    k = rounded.pattern - round.pattern;
    fraction = FRACTIONS[k & 63u];
    scale.pattern = (1023u - (k >> 6)) << 52;
    return (fraction + fraction * tail) * scale.value;
}

/* 1 - exp(-a) for a >= 0. */
static real one_minus_exp(real a)
{
    const real a2 = a * a;

    if (a < R(0.125)) {
        const real *q = SHORT_DECAY;
        const real low = (q[0] + q[1] * a) + (q[2] + q[3] * a) * a2;
        return a + a2 * (low + ((q[4] + q[5] * a) + q[6] * a2) * (a2 * a2));
    }
    if (a < R(0.7)) {
        const real *q = LONG_DECAY;
        const real a4 = a2 * a2;
        const real low = (q[0] + q[1] * a) + (q[2] + q[3] * a) * a2;
        const real middle = (q[4] + q[5] * a) + (q[6] + q[7] * a) * a2;
        const real high = (q[8] + q[9] * a) + q[10] * a2;
        return a + a2 * (low + (middle + high * a4) * a4);
    }
    if (a < R(38.0)) {
        return R(1.0) - exp_minus(a);
    }
    return is_nan(a) ? a : R(1.0);
}
