void @X@_step(@X@ *x, const @X@_input *in, @X@_output *out)
{
    planned_cycle p;

    if (!x->plan.started) {
        plan_begin(&x->plan, in->ahead_position, in->effort_command, x->plan.own);
    }
    out->planned = plan_push(&x->plan, in, &p);
    if (out->planned) {
@FEEDBACK@        guard_pass(&x->guard, p.position_offset, p.effort_offset, @SURPRISE@, out);
    } else {
        guard_pass(&x->guard, R(0.0), R(0.0), R(0.0), out);
    }
    out->reference_position = p.position;
    out->reference_velocity = p.velocity;
    out->reference_acceleration = p.acceleration;
    x->plan.own = out->effort;
}
