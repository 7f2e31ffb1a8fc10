component @X@ "@AXIS@: offsets of position and command by the strategy @STRATEGY@.";
description """
@TOP@
Stands between motion and PID, as offset.comp does. The command is held back by @HELD@ servo period(s), so
that the motion that far ahead is known: connect everything behind it to the outputs, and let FERROR allow
for it. Functions in the servo
thread: update-feedback before motion-controller, update after it and before the PID.""";
pin in float pos-cmd-in "Commanded position, machine units: joint.N.motor-pos-cmd.";
pin out float pos-cmd-out "The same held back, with the offset: to the PID's command.";
pin in float vel-cmd-in "Commanded velocity, machine units/s: joint.N.vel-cmd.";
pin out float vel-cmd-out "The same held back: to the PID's command-deriv.";
@ACCELERATION@pin in float pos-fb-in "Measured position of the load, machine units.";
pin out float pos-fb-out "The same without the offset: to joint.N.motor-pos-fb.";
pin in bit raw-feedback "TRUE: pos-fb-out is pos-fb-in, so that motion's following error is that of the load.";
@MOTOR@@CURRENT@@COMMAND@pin out float effort-out "Offset of the command, @E@: to be added to the PID's output.";
pin out float offset-out "Offset of the position, machine units.";
pin in bit enable-in "Fades the offsets in and out. Rising takes back a trip.";
pin out bit fault "The guard has tripped, or the thread has another period than the strategy.";
pin out s32 status-out "0 off, 1 on; tripped: 2 not a number, 3 position, 4 effort, 5 surprise; 6 period.";
param rw float units-per-si = @UNITS@ "Machine units per @L@.";
param rw float limit-position = @POSITION_LIMIT@ "The guard's: greatest offset of the position, machine units. One that is not above 0 changes nothing.";
param rw float limit-effort = @EFFORT_LIMIT@ "Greatest offset of the command, @E@; likewise.";
param rw float limit-surprise = @SURPRISE_LIMIT@ "Greatest deviation of the observer, in standard deviations; likewise.";
variable double held_cycle[@ROOM@];
function update_feedback;
function update;
license "Dual MIT/GPL";
author "generated";
;;

#include <rtapi_math.h>

@CODE@
/* Beside the law the command of the cycle before, in SI. */
typedef struct {
    @X@ law;
    double at[3]; /* @L@, @L@/s, @L@/s^2 */
    double offset;
    double limits[3]; /* as the parameters were */
    int started, on;
} kept_cycle;
typedef char kept_cycle_has_room[sizeof(kept_cycle) <= @ROOM@ * sizeof(double) ? 1 : -1];

FUNCTION(update_feedback)
{
    const kept_cycle *const kept = (const kept_cycle *)(const void *)held_cycle;
    pos_fb_out = pos_fb_in - (raw_feedback ? 0.0 : kept->offset * units_per_si);
}

FUNCTION(update)
{
    kept_cycle *const kept = (kept_cycle *)(void *)held_cycle;
    const double si = 1.0 / units_per_si;
    const double next[3] = {pos_cmd_in * si, vel_cmd_in * si, @NEXT_ACCELERATION@};
    const int in_time = fabs(period * 1e-9 - @PERIOD@) <= 0.01 * @PERIOD@;
    const int on = enable_in && in_time;
    @X@_input in;
    @X@_output out;
    const double asked[3] = {limit_position * si, limit_effort, limit_surprise};
    int i, changed = 0;

    if (!kept->started) {
        @X@_init(&kept->law);
        for (i = 0; i < 3; i++) {
            kept->at[i] = next[i];
        }
        kept->started = 1;
    }
    for (i = 0; i < 3; i++) {
        if (asked[i] < kept->limits[i] || asked[i] > kept->limits[i]) {
            changed = 1;
        }
        kept->limits[i] = asked[i];
    }
    if (changed) {
        @X@_limits limits = @U@_LIMITS;
        limits.position = asked[0];
        limits.effort = asked[1];
        limits.surprise = asked[2];
        (void)@X@_limit(&kept->law, &limits);
    }
    if (on != kept->on) {
        if (on) {
            @X@_reset(&kept->law);
        }
        @X@_switch(&kept->law, on);
        kept->on = on;
    }
@ASSIGN@    @X@_step(&kept->law, &in, &out);
    kept->offset = out.position;
    pos_cmd_out = (@REFERENCE@ + out.position) * units_per_si;
    vel_cmd_out = @VELOCITY@ * units_per_si;
    offset_out = out.position * units_per_si;
    effort_out = out.effort;
    status_out = in_time ? out.status : 6;
    fault = !in_time || out.status > @U@_ON;
    for (i = 0; i < 3; i++) {
        kept->at[i] = next[i];
    }
}
