/* At rest with a torque that it has held for ever. */
static void actuator_settle(@X@_plan *s, real torque)
{
    s->torque = torque;
}

static real actuator_now(const @X@_plan *s)
{
    return s->torque / GAIN;
}

/* The command of the coming cycle, at whose end the torque is to be `torque`. */
static real actuator_towards(@X@_plan *s, real torque, real speed)
{
    /* Without a lag the torque acts over the whole cycle: its mean counts. */
    const int at_once = is_zero(KEPT);
    const real wanted = at_once ? R(0.5) * (s->torque + torque) : (torque - KEPT * s->torque) / (R(1.0) - KEPT);
    const real asked = wanted / GAIN;
    const real effort = limited(asked, ACTUATOR_LIMIT);

    (void)speed;
    if (!at_once) {
        s->torque = KEPT * s->torque + (R(1.0) - KEPT) * GAIN * effort;
    } else {
        s->torque = is_zero(effort - asked) ? torque : (GAIN * effort);
    }
    return effort;
}
