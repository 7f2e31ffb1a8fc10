//! The structures that are tried, and what of each is free.

use axis_log::Log;
use axis_sim::Axis;
use axis_sim::control::{CONTROLS, Control};
use axis_sim::part::{Key, PartKind, Values, named};

use super::law::{Free, Law};
use super::start::Form;

/// A control kind, where it takes the position from, what it filters, and from which of two
/// ends it is approached.
#[derive(Clone, Debug)]
pub struct Structure {
    pub kind: &'static PartKind<dyn Control>,
    pub form: Form,
    /// Words of the axis file that go with it.
    pub words: Vec<(&'static str, &'static str)>,
    /// A low pass that is tried besides, as a key of the kind.
    filter: Option<&'static str>,
    /// Whether the estimate begins with Kv and K_i/K_p exchanged.
    pub exchanged: bool,
}

impl Structure {
    /// For people.
    pub fn name(&self) -> String {
        let mut name = self.kind.name.to_owned();
        for (key, word) in &self.words {
            name += &format!(", {key} {word}");
        }
        if let Some(filter) = self.filter {
            name += &format!(", {filter}");
        }
        name
    }

    /// Whether it has a low pass of that key that is tried besides.
    pub fn filters(&self, key: &str) -> bool {
        self.filter == Some(key)
    }

    /// Whether another is it with a low pass more.
    pub fn is_part_of(&self, other: &Self) -> bool {
        let is_same = self.kind.name == other.kind.name && self.words == other.words;
        is_same && self.filter.is_none() && other.filter.is_some()
    }

    /// Whether it reads the position from the motor.
    pub fn reads_motor(&self) -> bool {
        self.words.contains(&("feedback", "motor"))
    }

    /// The law where it begins with these gains.
    pub fn law(&self, machine: &Axis, gains: [f64; 4]) -> Law {
        let mut values = match machine.control.kind().name == self.kind.name {
            true => machine.control.values().clone(),
            false => Values::default(),
        };
        for (key, word) in &self.words {
            values.set_word(key, word);
        }
        let rate = 1.0 / machine.period;
        let mut free = self.gains(&values, gains, machine);
        free.extend(
            self.filter
                .map(|key| filter(key, values.or(key, 0.05 * rate), rate)),
        );
        for free in &mut free {
            let own = self.kind.keys.iter().find(|key| key.name() == free.key);
            if let Some(limits) = own.and_then(Key::limits) {
                *free = free.within(limits);
            }
            values.set(free.key, free.start);
        }
        free.push(Free::delay(machine.period));
        Law {
            kind: self.kind,
            values,
            free,
            has_constant: self.form != Form::Proportional,
            washout: 0.0,
        }
    }

    /// K_i/K_p of a control of this form, 1/s: the corner of a high pass behind which noise
    /// of the log is white.
    pub fn corner(law: &Law, at: &[f64]) -> f64 {
        let value = |key: &str| {
            let place = law.free.iter().position(|free| free.key == key);
            place.map(|place| at[place])
        };
        let share = |integral: f64, proportional: f64| match proportional > 0.0 {
            true => integral / proportional,
            false => 0.0,
        };
        match (value("speed_integral_time"), value("speed_integral")) {
            (Some(time), _) => time.recip(),
            (None, Some(integral)) => share(integral, value("speed_proportional").unwrap_or(0.0)),
            _ => share(
                value("integral").unwrap_or(0.0),
                value("proportional").unwrap_or(0.0),
            ),
        }
    }

    fn gains(&self, values: &Values, [a, b, c, d]: [f64; 4], machine: &Axis) -> Vec<Free> {
        let travel = machine.travel_per_radian();
        match self.form {
            Form::Proportional => vec![
                positive("position_gain", a),
                positive("speed_gain", c / travel),
            ],
            Form::Pid => vec![
                positive("proportional", a),
                from_zero("integral", b, b.max(a)),
                from_zero("derivative", c, c.max(0.01 * a)),
                filter(
                    "derivative_lowpass",
                    0.1 / machine.period,
                    1.0 / machine.period,
                ),
            ],
            Form::ProportionalIntegral => {
                let (a, d) = match self.exchanged && d > 0.0 {
                    true => (d / c, a * c),
                    false => (a, d),
                };
                let position = match values.optional("position_gain") {
                    Some(_) => positive("position_gain", a / travel),
                    None => positive("kv", a),
                };
                let integral = match values.optional("speed_integral_time") {
                    Some(_) => positive("speed_integral_time", c / d.max(1e-3 * c)),
                    None => from_zero("speed_integral", d, d.max(c)),
                };
                let fed = from_zero("velocity_feedforward", b, 1.0);
                vec![position, fed, positive("speed_proportional", c), integral]
            }
        }
    }
}

/// What lies above zero, within a factor of a million of its start.
fn positive(key: &'static str, start: f64) -> Free {
    Free {
        key,
        start,
        scale: start,
        room: [1e-3 * start, 1e3 * start],
    }
}

/// What may be zero.
fn from_zero(key: &'static str, start: f64, scale: f64) -> Free {
    Free {
        key,
        start,
        scale,
        room: [0.0, 1e3 * scale],
    }
}

/// A low pass on a loop of this rate, Hz: below it, and not so low that it takes all.
fn filter(key: &'static str, start: f64, rate: f64) -> Free {
    Free {
        key,
        start,
        scale: start,
        room: [1e-3 * rate, 0.44 * rate],
    }
}

/// Those that fit the machine and its logs.
pub fn structures(machine: &Axis, logs: &[(String, Log, f64)]) -> Vec<Structure> {
    let angle = logs.iter().all(|(_, log, _)| log.has("motor_angle_rad"));
    let has_motor = machine.mechanism.has_motor_encoder() && angle;
    let own = machine.control.values().word("feedback");
    let places: &[&[(&'static str, &'static str)]] = match (own, has_motor) {
        (Some("blend"), _) | (_, false) => &[&[]],
        _ => &[&[("feedback", "load")], &[("feedback", "motor")]],
    };
    let mut all = Vec::new();
    let mut add = |name: &str, form, words: &[_], filter, exchanged| {
        all.extend(named(CONTROLS, name).map(|kind| Structure {
            kind,
            form,
            words: words.to_vec(),
            filter,
            exchanged,
        }));
    };
    add("p-p", Form::Proportional, &[], None, false);
    add("pid", Form::Pid, &[], None, false);
    for filter in [None, Some("speed_lowpass"), Some("command_lowpass")] {
        for words in places {
            for exchanged in [false, true] {
                add("p-pi", Form::ProportionalIntegral, words, filter, exchanged);
            }
        }
    }
    all
}
