void @X@_init(@X@ *x)
{
    const @X@ nothing = {0};
    *x = nothing;
}

void @X@_reset(@X@ *x)
{
    const @X@_guard guard = x->guard;
    @X@_init(x);
    x->guard = guard;
}

void @X@_switch(@X@ *x, int on)
{
    unsigned i;

    x->guard.status = on ? @U@_ON : @U@_OFF;
    for (i = 0; i < 3; i++) {
        x->guard.beyond[i] = 0;
    }
}

void @X@_step(@X@ *x, const @X@_input *in, @X@_output *out)
{
    const real position = @POSITION@;
    const real effort = @EFFORT@;

    guard_pass(&x->guard, position, effort, @SURPRISE@, out);
}
