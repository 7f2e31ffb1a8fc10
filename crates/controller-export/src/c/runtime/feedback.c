/* The two nodes around a share of sticking bristles, and the share of the upper one. */
static const feedback_node *nodes_around(real sticking, real *share)
{
    unsigned i = 0;

    while (i + 2 < NODES && sticking > STICKING[i + 1]) {
        i++;
    }
    *share = least(greatest((sticking - STICKING[i]) / (STICKING[i + 1] - STICKING[i]), R(0.0)), R(1.0));
    return &FEEDBACK[i];
}

/* to += (low + share (high - low)) x */
static void add_column(real *to, const real *low, const real *high, real share, real x)
{
    const real upper = share * x;
    const real lower = x - upper;
    unsigned i;

    for (i = 0; i < STATES; i++) {
        to[i] += low[i] * lower + high[i] * upper;
    }
}

static real product(const real *a, const real *b)
{
    real sums[4] = {R(0.0)};
    unsigned i;

    for (i = 0; i < STATES; i++) {
        sums[i % 4] += a[i] * b[i];
    }
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

/* From the last estimate to what is expected now, by the command that the drive tells. */
static void feedback_predict(@X@_feedback *s, real commanded)
{
    const feedback_node *low;
    real next[STATES] = {R(0.0)};
    real share, effort, other;
    unsigned i;

    if (!s->has_before) {
        return;
    }
    effort = s->before_effort;
    other = commanded - s->before_effort;
    if (absolute(other) <= R(2.0) * FEEDBACK_LIMIT) {
        effort = commanded;
        s->own_rate = limited(s->own_rate + R(9.765625e-4) * other, FEEDBACK_LIMIT);
        s->own = limited(s->own + s->own_rate + R(0.0625) * other, FEEDBACK_LIMIT);
    }
    low = nodes_around(s->before_sticking, &share);
    for (i = 0; i < STATES; i++) {
        add_column(next, low->a[i], low[1].a[i], share, s->estimated[i]);
    }
    add_column(next, low->b, low[1].b, share, limited((effort - s->before_planned) / FEEDBACK_LIMIT, R(2.0)));
    for (i = 0; i < STATES; i++) {
        s->expected[i] = next[i];
    }
}

/* A cycle without a sample: the plan's own correction and what the feedback added last. */
static void feedback_without(@X@_feedback *s, planned_cycle *p)
{
    const real force = s->estimated[STATES - 1];
    unsigned i;

    for (i = 0; i < STATES; i++) {
        s->estimated[i] = s->expected[i] = (i + 1 == STATES) ? force : R(0.0);
    }
    s->has_before = 0;
    s->surprise = (real)INFINITY;
    p->effort_offset = p->effort_offset + s->effort - s->own;
    p->position_offset = is_finite(p->position_offset) ? p->position_offset : R(0.0);
    p->effort_offset = is_finite(p->effort_offset) ? p->effort_offset : R(0.0);
}

/* Whether everything that a sample brings is a number. */
static int feedback_known(const real *deviations, const planned_cycle *p)
{
    int known = is_finite(p->sticking) && is_finite(p->effort) && is_finite(p->effort_offset);
    unsigned i;

    for (i = 0; i < MEASURED; i++) {
        known = known && is_finite(deviations[i]);
    }
    return known;
}

/* Puts the feedback's offsets in the place of the plan's own. */
static void feedback_correct(@X@_feedback *s, const @X@_input *in, planned_cycle *p)
{
    const feedback_node *low;
    real x[STATES], deviations[3];
    real share, at_low, effort, fed, position_offset, effort_offset, surprise = R(0.0);
    real speed = p->motor_speed;
    unsigned i;
    int sound = 1;

    feedback_predict(s, in->effort_command);
    deviations[0] = in->position - (FROM_MOTOR ? p->position + TRAVEL * (p->wind_up - p->home) : p->position);
    if (SPEED_BY_DIFFERENCES) {
        speed = R(0.5) * (speed + s->speed);
    }
    s->speed = p->motor_speed;
    deviations[1] = in->motor_speed - speed;
    deviations[2] = in->current - p->current;
    if (!feedback_known(deviations, p)) {
        feedback_without(s, p);
        return;
    }
    low = nodes_around(p->sticking, &share);
    for (i = 0; i < STATES; i++) {
        x[i] = s->expected[i];
    }
    for (i = 0; i < MEASURED; i++) {
        const real innovation = deviations[i] - product(OUTPUTS[i], s->expected);
        const real ratio = innovation / (low->expected[i] + share * (low[1].expected[i] - low->expected[i]));
        surprise += ratio * ratio;
        add_column(x, low->l[i], low[1].l[i], share, innovation);
    }
    at_low = product(low->k, x);
    effort = limited(p->effort - FEEDBACK_LIMIT * (at_low + share * (product(low[1].k, x) - at_low)), FEEDBACK_LIMIT);
    fed = VELOCITY_FEEDFORWARD * p->velocity / TRAVEL;
    position_offset = (in->motor_speed - fed) / POSITION_GAIN - (p->position - in->position);
    effort_offset = p->effort_offset + (effort - p->effort) - s->own;
    for (i = 0; i < STATES; i++) {
        sound = sound && absolute(x[i]) <= R(1e6);
    }
    if (!sound || !is_finite(position_offset) || !is_finite(effort_offset)) {
        feedback_without(s, p);
        return;
    }
    for (i = 0; i < STATES; i++) {
        s->estimated[i] = x[i];
    }
    s->surprise = root(surprise / (real)MEASURED);
    s->effort = effort - p->effort;
    s->before_sticking = p->sticking;
    s->before_planned = p->effort;
    s->before_effort = effort;
    s->has_before = 1;
    p->position_offset = position_offset;
    p->effort_offset = effort_offset;
}
