/* tanh x, within 8 units in the last place: with |x| = (k + f) ln 2 / 2 and a rational
 * approximation fP/Q of tanh(f ln 2 / 2). */
static real tansig(real x)
{
    const real magnitude = absolute(x);
    const real t = ((R(9.25) < magnitude) ? R(9.25) : magnitude) * (R(2.0) * R(1.4426950408889634));
    number shifted, power;
    real f, s, fp, q, less, more, value;

    shifted.value = t + R(12582912.0); /* rounded, in the last bits */
    f = t - (shifted.value - R(12582912.0));
    power.pattern = (shifted.pattern + 127u) << 23;
    s = f * f;
    fp = f * (s + R(125.04273));
    q = R(17.33088) * s + R(360.79706);
    less = power.value - R(1.0);
    more = power.value + R(1.0);
    value = (less * q + more * fp) / (more * q + less * fp);
    return with_sign((R(1.0) < value) ? R(1.0) : value, x);
}
