void @X@_reset(@X@ *x)
{
@RESET@}

void @X@_init(@X@ *x)
{
    const @X@_guard off = {0};
    @X@_reset(x);
    x->guard = off;
@INIT@}

void @X@_switch(@X@ *x, int on)
{
    unsigned i;

    x->guard.status = on ? @U@_ON : @U@_OFF;
    for (i = 0; i < 3; i++) {
        x->guard.beyond[i] = 0;
    }
}

@STEP@