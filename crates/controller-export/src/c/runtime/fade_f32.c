/* sin^2(pi/2 share), share from 0 to 1. Polynomials: S. L. Moshier, Cephes, sinf.c. */
static real fade(real share)
{
    const real x = R(1.5707964) * share;
    real sine;

    if (x < R(0.8)) {
        const real z = x * x;
        sine = (R(-1.9515296e-4) * z + R(8.332161e-3)) * z;
        sine = (sine - R(1.6666655e-1)) * z * x + x;
    } else { /* the cosine of what is left to a quarter turn */
        const real rest = ((x - R(1.5703125)) - R(4.837513e-4)) - R(7.54979e-8);
        const real z = rest * rest;
        sine = (R(2.4433157e-5) * z - R(1.3887316e-3)) * z;
        sine = (sine + R(4.1666646e-2)) * z * z - R(0.5) * z + R(1.0);
    }
    return sine * sine;
}
