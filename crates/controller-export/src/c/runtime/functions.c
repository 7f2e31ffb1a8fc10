/* What init leaves behind, and memory that was never written does not hold but by chance. */
#define INITIALISED 0x46415831u

/* Everything forgotten that a motion leaves. */
static void forget(@X@ *x)
{
@RESET@}

void @X@_init(@X@ *x)
{
    const @X@_guard off = {0};
    const @X@_limits limits = @U@_LIMITS;

    forget(x);
    x->guard = off;
    x->guard.limits = limits;
@INIT@    x->initialised = INITIALISED;
}

/* Inits what was not. */
static void ready(@X@ *x)
{
    if (x->initialised != INITIALISED) {
        @X@_init(x);
    }
}

void @X@_reset(@X@ *x)
{
    ready(x);
    forget(x);
    guard_restart(&x->guard);
}

void @X@_switch(@X@ *x, int on)
{
    unsigned i;

    ready(x);
    x->guard.status = on ? @U@_ON : @U@_OFF;
    for (i = 0; i < 3u; i++) {
        x->guard.beyond[i] = 0;
    }
}

int @X@_limit(@X@ *x, const @X@_limits *limits)
{
    const int valid = limits->position > R(0.0) && limits->effort > R(0.0) && limits->surprise > R(0.0);

    ready(x);
    if (valid) {
        x->guard.limits = *limits;
        x->guard.faded = (x->guard.faded < limits->fade) ? x->guard.faded : limits->fade;
        guard_restart(&x->guard);
    }
    return valid;
}

@STEP@