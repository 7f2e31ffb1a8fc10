/* Friction along the reference. */
typedef struct {
    @real@ bristle; /* rad or m: deflection of the bristles, in the friction's coordinate */
    @real@ speed;   /* rad/s or m/s: of the reference in the cycle before, likewise */
} @X@_friction;
