/* sin^2(pi/2 share), share from 0 to 1. The sine: FreeBSD msun, k_sin.c, k_cos.c, e_rem_pio2.c,
 * Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved. Developed at SunSoft, a Sun
 * Microsystems, Inc. business. Permission to use, copy, modify, and distribute this software is
 * freely granted, provided that this notice is preserved. */
static real fade(real share)
{
    const real x = R(1.5707963267948966) * share;
    real sine;

    if (x < R(0.7853984832763672)) {
        const real z = x * x;
        const real r = R(8.33333333332248946124e-03)
            + z * (R(-1.98412698298579493134e-04) + z * R(2.75573137070700676789e-06))
            + z * (z * z) * (R(-2.50507602534068634195e-08) + z * R(1.58969099521155010221e-10));
        sine = x + z * x * (R(-1.66666666666666324348e-01) + z * r);
    } else { /* the cosine of what is left to a quarter turn, in two numbers */
        const real rest = x - R(1.57079632673412561417e+00);
        const real high = rest - R(6.07710050650619224932e-11);
        const real low = (rest - high) - R(6.07710050650619224932e-11);
        const real z = high * high;
        const real w = z * z;
        const real half = R(0.5) * z;
        const real most = R(1.0) - half;
        const real r = z * (R(4.16666666666666019037e-02)
                + z * (R(-1.38888888888741095749e-03) + z * R(2.48015872894767294178e-05)))
            + w * w * (R(-2.75573143513906633035e-07)
                + z * (R(2.08757232129817482790e-09) + z * R(-1.13596475577881948265e-11)));
        sine = most + (((R(1.0) - most) - half) + (z * r - high * low));
    }
    return sine * sine;
}
