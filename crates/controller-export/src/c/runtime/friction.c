/* The command that friction asks for, @E@. */
static real friction_effort(@X@_friction *s, const @X@_input *in)
{
    const real speed = in->reference_velocity * PER_TRAVEL;

    s->bristle = friction_step(s->bristle, s->speed, speed, FRICTION_PERIOD);
    s->speed = speed;
    return friction_torque(s->bristle, speed) * PER_TORQUE;
}
