/* Whether it is no number: it compares with nothing. */
static int is_nan(real x)
{
    return !(x < R(0.0)) && !(x >= R(0.0));
}
