static int is_finite(real x)
{
    return x - x == R(0.0);
}
