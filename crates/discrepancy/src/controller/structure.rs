//! The structures that are tried, and how one is fitted.

use axis_log::Log;
use axis_sim::control::{CONTROLS, Control};
use axis_sim::part::{PartKind, Values, named};
use axis_sim::{Axis, Replay};

use super::equation::{Equation, Solved};
use super::law::Law;
use super::seen::Seen;
use super::start::{Form, Start, start};

/// A control kind, where it takes the position from, and whether it filters the speed.
pub struct Structure {
    kind: &'static PartKind<dyn Control>,
    form: Form,
    pub words: Vec<(&'static str, &'static str)>,
    /// A low pass that is tried besides, as a key of the kind.
    filter: Option<&'static str>,
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

    fn from_motor(&self) -> bool {
        self.words.contains(&("feedback", "motor"))
    }
}

/// Those that fit the machine and its logs, that with the fewest gains first.
pub fn structures(machine: &Axis, logs: &[(String, Log, f64)]) -> Vec<Structure> {
    let angle = logs.iter().all(|(_, log, _)| log.has("motor_angle_rad"));
    let has_motor = machine.mechanism.has_motor_encoder() && angle;
    let own = machine.control.kind().name == "p-pi";
    let blends = own && machine.control.values().word("feedback") == Some("blend");
    let mut all = Vec::new();
    let mut add = |name: &str, form, words: &[_], filter| {
        if let Some(kind) = named(CONTROLS, name) {
            all.push(Structure {
                kind,
                form,
                words: words.to_vec(),
                filter,
            });
        }
    };
    add("p-p", Form::Proportional, &[], None);
    add("pid", Form::Pid, &[], None);
    let places: &[&[(&'static str, &'static str)]] = match (blends, has_motor) {
        (true, _) => &[&[]],
        (false, true) => &[&[("feedback", "load")], &[("feedback", "motor")]],
        (false, false) => &[&[("feedback", "load")]],
    };
    for filter in [None, Some("speed_lowpass")] {
        for words in places {
            add("p-pi", Form::ProportionalIntegral, words, filter);
        }
    }
    all
}

/// The structure fitted to logs; none where it cannot be.
pub fn fit(
    machine: &Axis,
    structure: &Structure,
    equation: &Equation<'_>,
    logs: &[(String, Log, f64)],
) -> Option<(Law, Solved)> {
    let begin = start(
        machine,
        &equation.logs,
        equation.cutoff(),
        structure.form,
        structure.from_motor(),
    )?;
    let (law, at, scales) = begun(machine, structure, &begin);
    let squares = equation.solve(&law, &at, &scales, None)?;
    // Simulated signals as instruments, where the closed loop holds with these gains.
    let mut axis = machine.clone();
    axis.control = law.control(&squares.at).ok()?;
    let simulate = |log: &(String, Log, f64)| {
        let trace = Replay::new(&log.1, log.2)
            .ok()?
            .run(&axis, &[], None)
            .ok()?;
        Seen::simulated(machine, log, &trace)
    };
    let instruments: Option<Vec<Seen>> = logs.iter().map(simulate).collect();
    let solved = instruments.and_then(|z| equation.solve(&law, &squares.at, &scales, Some(&z)));
    let left = |solved: &Solved| equation.left(&law, &solved.at).unwrap_or(f64::INFINITY);
    // Weak instruments lead anywhere: then least squares stay.
    let good = |solved: &Solved| left(solved) <= 1.5 * left(&squares) + 1e-12;
    let chosen = solved.filter(good).unwrap_or(squares);
    Some((law, chosen))
}

/// The law at its start, what is free there with the delay, and the scales of these.
fn begun(machine: &Axis, structure: &Structure, begin: &Start) -> (Law, Vec<f64>, Vec<f64>) {
    let own = machine.control.kind().name == structure.kind.name;
    let mut values = match own {
        true => machine.control.values().clone(),
        false => Values::default(),
    };
    for (key, word) in &structure.words {
        values.set_word(key, word);
    }
    let (travel, [a, b, c, d]) = (machine.travel_per_radian(), begin.gains);
    let rate = 1.0 / machine.period;
    // Key, start, scale.
    let mut free: Vec<(&'static str, f64, f64)> = match structure.form {
        Form::Proportional => vec![
            ("position_gain", a, a),
            ("speed_gain", c / travel, c / travel),
        ],
        Form::Pid => vec![
            ("proportional", a, a),
            ("integral", b, b.max(a)),
            ("derivative", c, c.max(0.01 * a)),
            ("derivative_lowpass", 0.1 * rate, 0.1 * rate),
        ],
        Form::ProportionalIntegral => {
            let position = match values.optional("position_gain") {
                Some(_) => ("position_gain", a / travel, a / travel),
                None => ("kv", a, a),
            };
            let time = (c / d.max(1e-3 * c)).max(1e-6);
            let integral = match values.optional("speed_integral_time") {
                Some(_) => ("speed_integral_time", time, time),
                None => ("speed_integral", d, d.max(c)),
            };
            vec![
                position,
                ("velocity_feedforward", b, 1.0),
                ("speed_proportional", c, c),
                integral,
            ]
        }
    };
    if let Some(filter) = structure.filter {
        let at = values.or(filter, 0.05 * rate);
        free.push((filter, at, at));
    }
    for (key, value, _) in &free {
        values.set(key, *value);
    }
    let law = Law {
        kind: structure.kind,
        values,
        free: free.iter().map(|(key, ..)| *key).collect(),
        has_constant: structure.form != Form::Proportional,
    };
    let at = free.iter().map(|(_, value, _)| *value).chain([begin.delay]);
    let scales = free.iter().map(|(_, _, scale)| *scale).chain([1.0]);
    (law, at.collect(), scales.collect())
}
