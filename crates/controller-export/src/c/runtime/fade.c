/* s^2 (3 - 2 s), s from 0 to 1: without slope at either end. */
static real fade(real share)
{
    return share * share * (R(3.0) - R(2.0) * share);
}
