static int is_zero(real x)
{
    return (x <= R(0.0)) && (x >= R(0.0));
}
