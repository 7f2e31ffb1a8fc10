void @X@_step(@X@ *x, const @X@_input *in, @X@_output *out)
{
    const real position = @POSITION@;
    const real effort = @EFFORT@;

    guard_pass(&x->guard, position, effort, R(0.0), out);
}
