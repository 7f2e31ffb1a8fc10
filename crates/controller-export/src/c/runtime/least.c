/* The lesser of two; the other one where one is not a number. */
static real least(real a, real b)
{
    return ((a < b) || is_nan(b)) ? a : b;
}
