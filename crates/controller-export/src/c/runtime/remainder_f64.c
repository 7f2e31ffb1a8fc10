/* to - (from + way), of positions a few micrometres apart. */
static real remainder_of(real to, real from, real way)
{
    return to - (from + way);
}
