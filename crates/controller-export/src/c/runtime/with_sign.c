/* The magnitude of x with the sign of another. */
static real with_sign(real x, real sign)
{
    number n, s;
    n.value = x;
    s.value = sign;
    n.pattern = (n.pattern & ~SIGN) | (s.pattern & SIGN);
    return n.value;
}
