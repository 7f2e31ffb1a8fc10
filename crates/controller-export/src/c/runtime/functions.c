void @X@_init(@X@ *x)
{
    const @X@ nothing = {0};
    *x = nothing;
}

void @X@_reset(@X@ *x)
{
    const @X@_guard guard = x->guard;
@KEEP@    @X@_init(x);
    x->guard = guard;
@RESTORE@}

void @X@_switch(@X@ *x, int on)
{
    unsigned i;

    x->guard.status = on ? @U@_ON : @U@_OFF;
    for (i = 0; i < 3; i++) {
        x->guard.beyond[i] = 0;
    }
}

@STEP@