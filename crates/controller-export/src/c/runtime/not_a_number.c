/* What trips a guard. */
static real not_a_number(void)
{
    number n;

    n.pattern = (bits)~(bits)0u;
    return n.value;
}
