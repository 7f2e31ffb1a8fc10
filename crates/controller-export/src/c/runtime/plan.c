/* What the plan says of a cycle. */
typedef struct {
    real position, velocity, acceleration; /* the set point */
    real motor_speed, wind_up, home, sticking, current;
    real effort;                           /* the command of the cycle */
    real position_offset, effort_offset;
} planned_cycle;

/* Sum of weights times deviations from the middle of the window. */
static real weighed(const real *weights, const real *window, real middle)
{
    real sums[8] = {R(0.0)};
    real tail = R(0.0), sum = R(0.0);
    unsigned i = 0, c;

    for (; i + 8 <= WINDOW; i += 8) {
        for (c = 0; c < 8; c++) {
            sums[c] += weights[i + c] * (window[i + c] - middle);
        }
    }
    for (; i < WINDOW; i++) {
        tail += weights[i] * (window[i] - middle);
    }
    for (c = 0; c < 8; c++) {
        sum += sums[c];
    }
    return sum + tail;
}

/* Share of bristles that move with the load. */
static real plan_sticking(const @X@_plan *s)
{
    real bristle, decay, steady;

    if (is_zero(s->speed)) {
        return R(1.0);
    }
    friction_curve(absolute(s->speed), &bristle, &decay);
    steady = with_sign(bristle, s->speed);
    if (is_zero(steady)) {
        return R(1.0);
    }
    return least(greatest(R(1.0) - s->bristle / steady, R(0.0)), R(1.0));
}

/* At rest at a position, the drive holding a command of which `own` was this compensator's. */
static void plan_begin(@X@_plan *s, real position, real effort, real own)
{
    const section at = section_at(position);
    const real holding = TORQUE_CONSTANT * effort / TRAVEL - at.load;
    const real most = FRICTION.stiction * FRICTION.compliance;
    @X@_wound still;
    unsigned i;

    s->bristle = (FRICTION.stiffness > R(0.0)) ? limited(holding * LEVER / FRICTION.stiffness, most) : R(0.0);
    s->speed = R(0.0);
    still.at.position = position;
    still.at.velocity = R(0.0);
    still.at.acceleration = R(0.0);
    still.at.sticking = R(1.0);
    still.at.rigid = TRAVEL * (friction_torque(s->bristle, R(0.0)) / LEVER + at.load);
    still.at.inertia = at.rotating - at.lagging;
    still.wind_up = at.compliance * still.at.rigid;
    still.motor_speed = R(0.0);
    still.torque = still.at.rigid;
    for (i = 0; i < HALF + 2; i++) {
        s->ahead[i] = still.at;
    }
    for (i = 0; i < LATE + 2; i++) {
        s->wound[i] = still;
    }
    for (i = 0; i < 2 * WINDOW; i++) {
        s->samples[i] = still.wind_up;
    }
    actuator_settle(s, still.at.rigid);
    s->home = still.wind_up;
    s->held = effort - own;
    s->ahead_at = s->wound_at = s->sample_at = s->pushed = 0;
    s->started = 1;
}

/* Forces and raw wind-up at a set point. */
static real plan_forces(@X@_plan *s, @X@_ahead *to)
{
    const section at = section_at(to->position);
    const real speed = to->velocity / LEVER;
    const real at_motor = to->acceleration / TRAVEL;
    real friction, rigid;

    s->bristle = friction_step(s->bristle, s->speed, speed, PERIOD);
    s->speed = speed;
    friction = friction_torque(s->bristle, speed) / LEVER;
    rigid = TRAVEL * (LOAD_INERTIA * to->acceleration + friction + at.load);
    to->sticking = plan_sticking(s);
    to->rigid = at.rotating * at_motor + rigid;
    to->inertia = at.rotating - at.lagging;
    return at.compliance * (rigid + at.lagging * at_motor);
}

/* The plan of the cycle that begins at `start`; its command acts on the torque between two. */
static void plan_cycle(@X@_plan *s, const @X@_wound *start, const @X@_wound *before, const @X@_wound *after,
                       planned_cycle *p)
{
    const real torque = before->torque + LATE_SHARE * (after->torque - before->torque);
    const real fed = VELOCITY_FEEDFORWARD * start->at.velocity / TRAVEL;

    p->motor_speed = start->motor_speed;
    p->wind_up = start->wind_up;
    p->home = s->home;
    p->sticking = start->at.sticking;
    p->current = (LATE == 0) ? actuator_now(s) : start->torque / TORQUE_CONSTANT;
    p->effort = actuator_towards(s, torque, R(0.5) * (before->motor_speed + after->motor_speed));
    p->position_offset = R(0.0);
    if (POSITION_GAIN > R(0.0)) {
        p->position_offset += (start->motor_speed - fed) / POSITION_GAIN;
    }
    if (FROM_MOTOR) {
        p->position_offset += TRAVEL * (start->wind_up - s->home);
    }
    p->effort_offset = p->effort - s->held - ACCELERATION_FEEDFORWARD * start->at.acceleration;
}

/* The newest set point; the one before where it is not a number, which would stay in the plan. Says
 * whether it is one. */
static int plan_set_point(const @X@_plan *s, const @X@_input *in, @X@_ahead *to)
{
    const int known = is_finite(in->ahead_position) && is_finite(in->ahead_velocity) && is_finite(in->ahead_acceleration);

    if (!known && s->started) {
        *to = s->ahead[(s->ahead_at + HALF + 1u) % (HALF + 2u)];
    } else {
        to->position = in->ahead_position;
        to->velocity = in->ahead_velocity;
        to->acceleration = in->ahead_acceleration;
    }
    return known;
}

/* Takes the newest set point; says whether there is a plan yet, of LOOK_AHEAD cycles before. */
static int plan_push(@X@_plan *s, const @X@_ahead *newest_set_point, planned_cycle *p)
{
    const @X@_ahead *middle;
    const @X@_wound *start, *before;
    @X@_wound *newest;
    const real *window;
    @X@_ahead to = *newest_set_point;

    s->samples[s->sample_at] = s->samples[s->sample_at + WINDOW] = plan_forces(s, &to);
    s->sample_at = (s->sample_at + 1) % WINDOW;
    window = &s->samples[s->sample_at];
    s->ahead[s->ahead_at] = to;
    middle = &s->ahead[(s->ahead_at + 2) % (HALF + 2)];
    s->ahead_at = (s->ahead_at + 1) % (HALF + 2);

    newest = &s->wound[s->wound_at];
    newest->at = *middle;
    newest->wind_up = window[HALF] + weighed(VALUE_WEIGHTS, window, window[HALF]);
    newest->motor_speed = middle->velocity / TRAVEL + weighed(RATE_WEIGHTS, window, window[HALF]);
    newest->torque = middle->rigid + middle->inertia * weighed(SECOND_WEIGHTS, window, window[HALF]);
    start = &s->wound[(s->wound_at + 1) % (LATE + 2)];
    before = &s->wound[(s->wound_at + LATE + 1) % (LATE + 2)];
    s->wound_at = (s->wound_at + 1) % (LATE + 2);
    p->position = start->at.position;
    p->velocity = start->at.velocity;
    p->acceleration = start->at.acceleration;
    if (s->pushed < LOOK_AHEAD) {
        s->pushed++;
        return 0;
    }
    s->pushed = LOOK_AHEAD + 1u;
    plan_cycle(s, start, before, newest, p);
    return 1;
}
