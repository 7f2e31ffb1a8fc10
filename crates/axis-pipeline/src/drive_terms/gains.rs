//! Gains and filters of the axis file's own drive, such as `tune` sets them, in units that drives use.

use axis_sim::Axis;
use axis_sim::control::{NOTCH_DAMPING, NOTCH_DEPTH};
use axis_sim::mechanism::Freedom;

use super::term::{Line, Term};
use super::units::Units;

/// (m/min)/mm of a Kv of 1/s: 60 s a minute over 1000 mm a metre. The same as 1000/min.
const PER_MINUTE: f64 = 0.06;

/// Gains of position, speed and current controller and filters, as far as the file has them.
pub(super) fn gains(axis: &Axis) -> Vec<Term> {
    let mut list = cascade(axis);
    list.extend(pid(axis));
    list.extend(filters(axis));
    list.extend(current(axis));
    list.into_iter().map(Term::from).collect()
}

fn cascade(axis: &Axis) -> Vec<Line> {
    let travel = axis.travel_per_radian();
    let Some(cascade) = axis.control.cascade(travel, axis.period) else {
        return Vec::new();
    };
    let u = Units::of(axis);
    let kv = match axis.freedom() {
        Freedom::Linear => "(m/min)/mm",
        _ => "1000/min",
    };
    let speed = format!("({}/s)", u.angle);
    let mut all: Vec<Line> = vec![
        (
            "position_gain",
            cascade.position * travel,
            "1/s".into(),
            (PER_MINUTE, kv.into()),
            "speed of the load per position error, Kv",
        ),
        (
            "speed_gain",
            cascade.speed,
            format!("{}/{speed}", u.effort),
            (axis.torque_constant(), format!("{}/{speed}", u.torque)),
            "command per speed error of the motor; in the drive's unit torque or force per speed error",
        ),
    ];
    if cascade.speed_integral > 0.0 {
        all.push((
            "speed_integral_time",
            cascade.speed / cascade.speed_integral,
            "s".into(),
            (1e3, "ms".into()),
            "integral action time of the speed controller",
        ));
    }
    all
}

/// Of a PID controller of the position: per mm, or per degree.
fn pid(axis: &Axis) -> Vec<Line> {
    let travel = axis.travel_per_radian();
    if axis.control.pid(travel, axis.period).is_none() {
        return Vec::new();
    }
    let u = Units::of(axis);
    let (factor, short) = match axis.freedom() {
        Freedom::Linear => (1e-3, "mm"),
        _ => (std::f64::consts::PI / 180.0, "°"),
    };
    let (effort, load) = (u.effort, u.load);
    let lines = [
        (
            "proportional_gain",
            "proportional",
            [format!("{effort}/{load}"), format!("{effort}/{short}")],
            "command per position error",
        ),
        (
            "integral_gain",
            "integral",
            [
                format!("{effort}/({load}·s)"),
                format!("{effort}/({short}·s)"),
            ],
            "command per integral of the position error over the time",
        ),
        (
            "derivative_gain",
            "derivative",
            [
                format!("{effort}/({load}/s)"),
                format!("{effort}/({short}/s)"),
            ],
            "command per rate of the position error",
        ),
    ];
    let values = axis.control.values();
    type Of = (&'static str, &'static str, [String; 2], &'static str);
    let line = |(name, key, [unit, drive_unit], meaning): Of| -> Option<Line> {
        let value = values.optional(key)?;
        Some((name, value, unit, (factor, drive_unit), meaning))
    };
    lines.into_iter().filter_map(line).collect()
}

fn filters(axis: &Axis) -> Vec<Line> {
    let values = axis.control.values();
    let lines = [
        (
            "speed_lowpass",
            "speed_lowpass",
            "Hz",
            "corner of the low pass of the measured speed",
        ),
        (
            "command_lowpass",
            "command_lowpass",
            "Hz",
            "corner of the low pass of the command",
        ),
        (
            "derivative_lowpass",
            "derivative_lowpass",
            "Hz",
            "corner of the low pass of the derivative",
        ),
        (
            "notch_frequency",
            "notch",
            "Hz",
            "middle of the notch of the command",
        ),
        (
            "notch_damping",
            "notch_damping",
            "1",
            "damping of the notch's denominator",
        ),
        (
            "notch_depth",
            "notch_depth",
            "1",
            "share of the command that is left at the notch's middle",
        ),
    ];
    let has_notch = values.optional("notch").is_some();
    let line = |(name, key, unit, meaning): (&'static str, &str, &str, &'static str)| {
        let is_of_notch = key.starts_with("notch");
        let value = match key {
            "notch_damping" => Some(values.or(key, NOTCH_DAMPING)),
            "notch_depth" => Some(values.or(key, NOTCH_DEPTH)),
            _ => values.optional(key),
        };
        let value = value.filter(|_| has_notch || !is_of_notch)?;
        Some((name, value, unit.into(), (1.0, unit.into()), meaning))
    };
    lines.into_iter().filter_map(line).collect()
}

/// Of current controllers, k_p and T_i = k_p/k_i.
fn current(axis: &Axis) -> Vec<Line> {
    let values = axis.actuator.values();
    let lines = [
        (
            ["current_q_gain", "current_q_integral_time"],
            ["current_q_proportional", "current_q_integral"],
            [
                "voltage per error of the current that makes torque or force",
                "integral action time of that controller",
            ],
        ),
        (
            ["current_d_gain", "current_d_integral_time"],
            ["current_d_proportional", "current_d_integral"],
            [
                "voltage per error of the current along the magnets",
                "integral action time of that controller",
            ],
        ),
    ];
    let mut all: Vec<Line> = Vec::new();
    for (names, keys, meanings) in lines {
        let [Some(gain), Some(integral)] = keys.map(|key| values.optional(key)) else {
            continue;
        };
        let (volt, second) = ("V/A".to_owned(), "s".to_owned());
        all.push((names[0], gain, volt.clone(), (1.0, volt), meanings[0]));
        if integral > 0.0 {
            let time = gain / integral;
            all.push((names[1], time, second, (1e3, "ms".into()), meanings[1]));
        }
    }
    all
}
