/* One cycle of the filter. */
static real filter_output(@X@_filter *s, real acceleration)
{
    real error = DIRECT * acceleration;
    real chain = acceleration;
    unsigned i;

    for (i = 0; i < ORDER; i++) {
        const real last = s->section[i];
        const real now = POLES[i] * last + chain; /* 1/(1 - p/z) */
        s->section[i] = now;
        error += SECTION_WEIGHTS[i] * now;
        chain = last - POLES[i] * now; /* (1/z - p)/(1 - p/z) */
    }
    return error;
}

/* The error that the linear model expects for the end of the cycle, and its lead, @L@. */
static real filter_error(@X@_filter *s, const @X@_input *in)
{
    const real present = s->started ? s->last : filter_output(s, in->reference_acceleration);
    const real next = filter_output(s, in->next_reference_acceleration);

    s->last = next;
    s->started = 1;
    return next + LEAD_PER_PERIOD * (next - present);
}
