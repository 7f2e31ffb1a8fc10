/* Trips where something is not a number, or beyond its limit for longer than a while. */
static void guard_watch(@X@_guard *s, real position, real effort, real surprise)
{
    unsigned i;

    if (!is_finite(position) || !is_finite(effort)) {
        s->status = @U@_NOT_FINITE;
        return;
    }
    for (i = 0; i < 3; i++) {
        const real value = absolute((i == 0) ? position : (i == 1) ? effort : surprise);
        const real limit = (i == 0) ? POSITION_LIMIT : (i == 1) ? EFFORT_LIMIT : SURPRISE_LIMIT;
        s->beyond[i] = (value <= limit) ? 0 : s->beyond[i] + 1;
        if (s->beyond[i] > PATIENCE) {
            s->status = @U@_POSITION_LIMIT + (int32_t)i;
            return;
        }
    }
}

/* What of a correction goes to the drive. */
static void guard_pass(@X@_guard *s, real position, real effort, real surprise, @X@_output *out)
{
    real gain;

    if (s->status == @U@_ON) {
        guard_watch(s, position, effort, surprise);
    }
    if (is_finite(position) && is_finite(effort)) {
        s->position = limited(position, POSITION_LIMIT);
        s->effort = limited(effort, EFFORT_LIMIT);
    }
    if (s->status == @U@_ON) {
        if (s->faded < FADE) {
            s->faded++;
        }
        gain = (s->faded == FADE) ? R(1.0) : fade((real)s->faded / (real)FADE);
    } else {
        if (s->faded > 0) {
            s->faded--;
        }
        gain = fade((real)s->faded / (real)(FADE + (FADE == 0)));
    }
    out->position = gain * s->position;
    out->effort = gain * s->effort;
    out->status = s->status;
}
