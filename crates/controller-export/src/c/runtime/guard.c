/* Goes over, from now on, from what was let through last. */
static void guard_restart(@X@_guard *s)
{
    s->from[0] = s->passed[0];
    s->from[1] = s->passed[1];
    s->blend = s->limits.fade;
}

/* Trips where something is not a number, or beyond its limit for longer than a while. */
static void guard_watch(@X@_guard *s, real position, real effort, real surprise)
{
    unsigned i;

    if (!is_finite(position) || !is_finite(effort)) {
        s->status = @U@_NOT_FINITE;
        return;
    }
    for (i = 0; i < 3; i++) {
        const real value = absolute((i == 0u) ? position : ((i == 1u) ? effort : surprise));
        const real limit = (i == 0u) ? s->limits.position : ((i == 1u) ? s->limits.effort : s->limits.surprise);
        s->beyond[i] = (value <= limit) ? 0 : s->beyond[i] + 1;
        if (s->beyond[i] > s->limits.patience) {
            s->status = @U@_POSITION_LIMIT + (int32_t)i;
            return;
        }
    }
}

/* What of a correction goes to the drive. */
static void guard_pass(@X@_guard *s, real position, real effort, real surprise, @X@_output *out)
{
    const uint32_t cycles = s->limits.fade;
    const real all = (real)((cycles > 0u) ? cycles : 1u);
    real gain;

    if (s->status == @U@_ON) {
        guard_watch(s, position, effort, surprise);
    }
    if (is_finite(position) && is_finite(effort)) {
        s->position = limited(position, s->limits.position);
        s->effort = limited(effort, s->limits.effort);
    }
    if (s->status == @U@_ON) {
        if (s->faded < cycles) {
            s->faded++;
        }
        gain = (s->faded == cycles) ? R(1.0) : fade((real)s->faded / all);
    } else {
        if (s->faded > 0u) {
            s->faded--;
        }
        gain = fade((real)s->faded / all);
    }
    s->passed[0] = gain * s->position;
    s->passed[1] = gain * s->effort;
    if (s->blend > 0u) {
        const real before = fade((real)s->blend / all);
        s->passed[0] = s->passed[0] + before * (s->from[0] - s->passed[0]);
        s->passed[1] = s->passed[1] + before * (s->from[1] - s->passed[1]);
        s->blend--;
    }
    out->position = s->passed[0];
    out->effort = s->passed[1];
    out->status = s->status;
}
