//! The page of one simulated motion: position and error, speed, what drives it.

use axis_log::Log;
use axis_report::{Block, Cell, Figure, KeyValues, Page, Section, Series, Table, engineering};
use axis_sim::{Axis, Cycle};

/// What was run.
pub struct Ran<'a> {
    pub axis: &'a Axis,
    pub compensation: &'a str,
    pub noise: f64,
    pub seed: u64,
    /// Every control cycle.
    pub cycles: &'a [Cycle],
    /// The same as its log.
    pub log: &'a Log,
    /// The compensation or the command that would show more.
    pub next: Vec<String>,
}

/// Least, greatest, RMS of a signal.
struct Size {
    peak: f64,
    rms: f64,
    mean: f64,
}

impl Size {
    fn of(values: &[f64]) -> Self {
        let count = values.len().max(1) as f64;
        Self {
            peak: values.iter().fold(0.0, |most, v| most.max(v.abs())),
            rms: (values.iter().map(|v| v * v).sum::<f64>() / count).sqrt(),
            mean: values.iter().map(|v| v.abs()).sum::<f64>() / count,
        }
    }
}

/// Figures share the time.
const TIME: &str = "time";

/// The page.
pub fn page(ran: &Ran<'_>) -> Page {
    let errors: Vec<f64> = ran.cycles.iter().map(Cycle::error).collect();
    Page::new(format!("Motion of {}", ran.axis.name))
        .lead(ran.axis.description.clone())
        .first(Block::Answers(answers(ran, &errors)))
        .section(
            Section::new("Motion")
                .figure(position(ran))
                .figure(error(ran, &errors))
                .figure(speed(ran)),
        )
        .section(drive(ran))
        .section(Section::new("Figures").table(table(ran, &errors)))
        .section(settings(ran))
}

fn answers(ran: &Ran<'_>, errors: &[f64]) -> Vec<(String, Vec<String>)> {
    let unit = ran.axis.freedom().unit();
    let size = Size::of(errors);
    let said = |value| engineering(value, unit, 3);
    let at = (0..errors.len()).find(|&k| errors[k].abs() >= size.peak);
    let at = at.map_or(0.0, |k| ran.cycles[k].time);
    let left = errors.last().copied().unwrap_or(0.0);
    let saturated = ran.cycles.iter().filter(|c| c.command.saturated).count();
    let limit = match saturated {
        0 => "No limit of the controller or the drive was reached.".to_owned(),
        n => format!(
            "A limit of the controller or the drive was active in {n} of {} cycles.",
            errors.len()
        ),
    };
    let noise = match ran.noise {
        0.0 => "Simulated, not measured; sensors without noise.".to_owned(),
        factor => format!(
            "Simulated, not measured; sensors with noise, {factor} times that of good ones (seed {}).",
            ran.seed
        ),
    };
    let answer = |question: &str, lines: Vec<String>| (question.to_owned(), lines);
    vec![
        answer(
            "What was run",
            vec![format!(
                "{} of motion, {} control cycles of {}, compensation: {}.",
                engineering(ran.axis.period * errors.len() as f64, "s", 4),
                errors.len(),
                engineering(ran.axis.period, "s", 3),
                ran.compensation
            )],
        ),
        answer(
            "How far it is off",
            vec![
                format!(
                    "Tracking error: {} peak (at {}), {} RMS, {} mean; {} at the end.",
                    said(size.peak),
                    engineering(at, "s", 4),
                    said(size.rms),
                    said(size.mean),
                    said(left)
                ),
                limit,
            ],
        ),
        answer("How sure that is", vec![noise]),
        answer("What to do next", ran.next.clone()),
    ]
}

fn times(ran: &Ran<'_>) -> Vec<f64> {
    ran.cycles.iter().map(|c| c.time).collect()
}

/// A figure over the time of this run.
fn over_time(title: &str, label: &str, unit: &str) -> Figure {
    Figure::new(title, "time", label)
        .units("s", unit)
        .linked(TIME)
}

fn position(ran: &Ran<'_>) -> Figure {
    let of = |read: fn(&Cycle) -> f64| ran.cycles.iter().map(read).collect();
    over_time(
        "Position of the load",
        "position",
        ran.axis.freedom().unit(),
    )
    .series(Series::line("load", times(ran), of(|c| c.position)))
    .series(Series::line("reference", times(ran), of(|c| c.reference.position)).dashed())
}

fn error(ran: &Ran<'_>, errors: &[f64]) -> Figure {
    let unit = ran.axis.freedom().unit();
    over_time("Tracking error", "reference − position", unit).series(Series::line(
        "tracking error",
        times(ran),
        errors.to_vec(),
    ))
}

fn speed(ran: &Ran<'_>) -> Figure {
    let of = |read: fn(&Cycle) -> f64| ran.cycles.iter().map(read).collect();
    over_time(
        "Speed of the load",
        "speed",
        ran.axis.freedom().speed_unit(),
    )
    .series(Series::line("load", times(ran), of(|c| c.load_speed)))
    .series(Series::line("reference", times(ran), of(|c| c.reference.velocity)).dashed())
}

/// Channels of the log that are one figure: its title, and the legend's name of each.
type Shown = (&'static str, &'static [(&'static str, &'static str)]);

/// What drives the axis: those that its log has are shown.
const DRIVE: [Shown; 6] = [
    (
        "Current",
        &[("iq_a", "q"), ("iq_ref_a", "q reference"), ("id_a", "d")],
    ),
    ("Torque command", &[("torque_ref_n_m", "command")]),
    ("Force command", &[("force_ref_n", "command")]),
    (
        "Voltage",
        &[("uq_v", "q"), ("ud_v", "d"), ("drive_command_v", "command")],
    ),
    (
        "Position added by the compensation",
        &[
            ("correction_m", "correction"),
            ("correction_rad", "correction"),
        ],
    ),
    (
        "Current added by the compensation",
        &[("iq_feedforward_a", "feed-forward")],
    ),
];

/// What the motor gives, and its unit.
fn effort(ran: &Ran<'_>) -> [&'static str; 2] {
    ran.axis.mechanism.motor_freedom().force()
}

fn drive(ran: &Ran<'_>) -> Section {
    let [name, unit_of_it] = effort(ran);
    let torque = over_time(&format!("Motor {name}"), name, unit_of_it);
    let torque = torque.series(Series::line(
        name,
        times(ran),
        ran.cycles.iter().map(|c| c.torque).collect(),
    ));
    let shown = DRIVE.iter().filter_map(|(title, names)| {
        let has = |(name, _): &&(&str, &'static str)| {
            ran.log
                .channel(name)
                .is_ok_and(|all| all.iter().any(|v| *v != 0.0))
        };
        let there: Vec<_> = names.iter().filter(has).collect();
        let (first, _) = there.first()?;
        let label = title.split(' ').next().unwrap_or(title).to_lowercase();
        let figure = over_time(title, &label, unit(ran.log, first));
        let add = |figure: Figure, (name, legend): &&(&str, &str)| match ran.log.channel(name) {
            Ok(samples) => figure.series(Series::line(*legend, times(ran), samples.to_vec())),
            Err(_) => figure,
        };
        Some(there.iter().fold(figure, add))
    });
    let torque = ran.cycles.iter().any(|c| c.torque != 0.0).then_some(torque);
    shown
        .chain(torque)
        .fold(Section::new("Drive"), Section::figure)
}

fn unit<'a>(log: &'a Log, name: &str) -> &'a str {
    let found = log.channels().iter().find(|c| c.name == name);
    found.map_or("", |c| c.unit.as_str())
}

fn table(ran: &Ran<'_>, errors: &[f64]) -> Table {
    let unit = ran.axis.freedom().unit();
    let speeds: Vec<f64> = ran.cycles.iter().map(|c| c.load_speed).collect();
    let torques: Vec<f64> = ran.cycles.iter().map(|c| c.torque).collect();
    let row = |table: Table, name: &str, unit: &str, values: &[f64]| {
        let size = Size::of(values);
        let cell = |value| Cell::quantity(value, unit, 4);
        table.row([
            Cell::text(name),
            cell(size.peak),
            cell(size.rms),
            cell(size.mean),
        ])
    };
    let table = Table::new(
        "Over the whole motion",
        ["Signal", "peak", "RMS", "mean of absolute values"],
    );
    let table = row(table, "tracking error", unit, errors);
    let table = row(
        table,
        "speed of the load",
        ran.axis.freedom().speed_unit(),
        &speeds,
    );
    let [name, unit] = effort(ran);
    let table = row(table, &format!("motor {name}"), unit, &torques);
    match ran.log.channel("iq_a") {
        Ok(current) => row(table, "q current", "A", current),
        Err(_) => table,
    }
}

fn settings(ran: &Ran<'_>) -> Section {
    let list = KeyValues::new("What made this page")
        .entry("Axis", &ran.axis.name)
        .entry("Fingerprint of the axis", &ran.axis.fingerprint)
        .entry("Compensation", ran.compensation)
        .entry("Noise of the sensors, times that of good ones", ran.noise)
        .entry("Seed", ran.seed)
        .entry("Version", env!("CARGO_PKG_VERSION"));
    Section::new("Settings").key_values(list)
}
