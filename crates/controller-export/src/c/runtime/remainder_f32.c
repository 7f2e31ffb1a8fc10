/* to - (from + way), of positions a few micrometres apart: their difference comes first, as
 * it is exact, where a position has no digits left for a cycle's way. */
static real remainder_of(real to, real from, real way)
{
    return (to - from) - way;
}
