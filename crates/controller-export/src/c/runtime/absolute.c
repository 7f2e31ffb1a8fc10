static real absolute(real x)
{
    number n;
    n.value = x;
    n.pattern &= ~SIGN;
    return n.value;
}
