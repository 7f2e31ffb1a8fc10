/* tanh x, within 8 units in the last place: with |x| = (k + f) ln 2 / 2 and a rational
 * approximation fP/Q of tanh(f ln 2 / 2). */
static real tansig(real x)
{
    const real magnitude = absolute(x);
    const real t = ((R(19.25) < magnitude) ? R(19.25) : magnitude) * (R(2.0) * R(1.4426950408889634));
    number shifted, power;
    real f, s, fp, q, less, more, value;

    shifted.value = t + R(6755399441055744.0); /* rounded, in the last bits */
    f = t - (shifted.value - R(6755399441055744.0));
    power.pattern = (shifted.pattern + 1023u) << 52;
    s = f * f;
    fp = f * ((s + R(874.7427901051661)) * s + R(65550.94758986183));
    q = (R(43.300524565223355) * s + R(10096.716588166924)) * s + R(189140.054026932);
    less = power.value - R(1.0);
    more = power.value + R(1.0);
    value = (less * q + more * fp) / (more * q + less * fp);
    return with_sign((R(1.0) < value) ? R(1.0) : value, x);
}
