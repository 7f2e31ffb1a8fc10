/* x between -most and most. */
static real limited(real x, real most)
{
    return least(greatest(x, -most), most);
}
