void @X@_step(@X@ *x, const @X@_input *in, @X@_output *out)
{
    real position, effort;

    ready(x);
    position = @POSITION@;
    effort = @EFFORT@;
    guard_pass(&x->guard, position, effort, R(0.0), out);
    if (!is_finite(position) || !is_finite(effort)) {
        @X@_reset(x); /* what is no number would stay in its state */
    }
}
