/* Motor speed, set right by the scale: an alpha-beta observer. */
static void estimator_step(@X@_estimator *s, real measured, real motor_speed)
{
    const real motor_side_speed = TRAVEL_PER_RADIAN * motor_speed;

    if (!s->started) {
        s->position = measured;
        s->wind_up_rate = R(0.0);
        s->velocity = motor_side_speed;
        s->acceleration = R(0.0);
        s->started = 1;
    } else {
        const real mean = R(0.5) * (s->motor_side_speed + motor_side_speed);
        const real way = PERIOD * (mean + s->wind_up_rate);
        const real innovation = remainder_of(measured, s->position, way);
        const real wind_up_rate = s->wind_up_rate + DRIFT_PER_PERIOD * innovation;
        const real velocity = motor_side_speed + wind_up_rate;
        const real difference = (velocity - s->velocity) / PERIOD;
        s->position = measured - ONE_LESS_POSITION_GAIN * innovation;
        s->wind_up_rate = wind_up_rate;
        s->velocity = velocity;
        s->acceleration = s->acceleration + ACCELERATION_GAIN * (difference - s->acceleration);
    }
    s->motor_side_speed = motor_side_speed;
}

/* The error that the network predicts for the end of the cycle, @L@. */
static real network_error(@X@_estimator *s, const @X@_input *in)
{
    real input[4];

    estimator_step(s, in->position, in->motor_speed);
    input[0] = s->position;
    input[1] = s->velocity;
    input[2] = s->acceleration;
    input[3] = in->effort_command;
    return remainder_of(in->next_reference_position, s->position, network_increment(input));
}
