/* Whether it is a number, and not infinite: the difference is 0, or none. */
static int is_finite(real x)
{
    return (x - x) <= R(0.0);
}
