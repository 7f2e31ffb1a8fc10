void @X@_step(@X@ *x, const @X@_input *in, @X@_output *out)
{
    @X@_ahead to;
    planned_cycle p;
    int known, first;

    ready(x);
    known = plan_set_point(&x->plan, in, &to);
    if (!x->plan.started && known && is_finite(in->effort_command)) {
        plan_begin(&x->plan, to.position, in->effort_command, x->plan.own);
    }
    first = x->plan.started && (x->plan.pushed == LOOK_AHEAD);
    if (x->plan.started) {
        out->planned = plan_push(&x->plan, &to, &p);
    } else {
        known = 0;
        out->planned = 0;
        p.position = to.position;
        p.velocity = to.velocity;
        p.acceleration = to.acceleration;
    }
    if (out->planned) {
        const int sound = is_finite(p.position_offset) && is_finite(p.effort_offset);
        if (sound) {
@FEEDBACK@        }
        if (first) {
            guard_restart(&x->guard); /* from what it held, or fades out, to the plan */
        }
        if (!known) {
            p.effort_offset = not_a_number();
        }
        guard_pass(&x->guard, p.position_offset, p.effort_offset, @SURPRISE@, out);
        if (!sound) {
            @X@_reset(x); /* what is no number would stay in its state */
        }
    } else {
        guard_pass(&x->guard, R(0.0), known ? R(0.0) : not_a_number(), R(0.0), out);
        if (x->guard.status == @U@_ON) {
            guard_restart(&x->guard); /* holds what it let through until there is a plan */
        }
    }
    out->reference_position = p.position;
    out->reference_velocity = p.velocity;
    out->reference_acceleration = p.acceleration;
    x->plan.own = out->effort;
}
