//! The page of one simulated motion: position and error, speed, what drives it.

use axis_report::{
    Block, Cell, Figure, KeyValues, Notice, Page, Section, Series, Table, engineering,
};
use axis_sim::{Axis, Cycle, RunStopped, channels};

use super::envelope::{Envelope, Sizes};

/// What was run.
pub struct Ran<'a> {
    pub axis: &'a Axis,
    pub compensation: &'a str,
    pub noise: f64,
    pub seed: u64,
    /// What was seen of it.
    pub shown: &'a Shown,
    /// Why the run did not come to its end, where it did not.
    pub stopped: Option<&'a RunStopped>,
    /// The compensation or the command that would show more.
    pub next: Vec<String>,
}

/// What the page shows of a run, collected while it goes on: its size does not grow with the run.
pub struct Shown {
    cycles: u64,
    /// Cycles in which a limit was active.
    saturated: u64,
    signals: Vec<Signal>,
}

/// A signal with its unit.
struct Signal {
    name: &'static str,
    unit: &'static str,
    read: fn(&Cycle) -> f64,
    seen: Envelope,
}

/// Signals that are read of a cycle itself: every axis has them.
const ERROR: &str = "error";
const POSITION: &str = "position";
const REFERENCE: &str = "reference";
const SPEED: &str = "speed";
const SPEED_REFERENCE: &str = "speed reference";
const TORQUE: &str = "torque";

impl Shown {
    /// Of a run of this axis, before its first cycle.
    pub fn of(axis: &Axis) -> Self {
        let freedom = axis.freedom();
        let (unit, per_second) = (freedom.unit(), freedom.speed_unit());
        let signal = |name, unit, read| Signal {
            name,
            unit,
            read,
            seen: Envelope::default(),
        };
        let own = [
            signal(ERROR, unit, Cycle::error),
            signal(POSITION, unit, |c| c.position),
            signal(REFERENCE, unit, |c| c.reference.position),
            signal(SPEED, per_second, |c| c.load_speed),
            signal(SPEED_REFERENCE, per_second, |c| c.reference.velocity),
            signal(TORQUE, axis.mechanism.motor_freedom().force()[1], |c| {
                c.torque
            }),
        ];
        let names = || DRIVE.iter().flat_map(|(_, names)| *names);
        let of_log = channels(axis).into_iter().filter_map(|channel| {
            let [name, unit] = channel.of_freedom(freedom);
            names()
                .any(|(shown, _)| *shown == name)
                .then(|| signal(name, unit, channel.read))
        });
        Self {
            cycles: 0,
            saturated: 0,
            signals: own.into_iter().chain(of_log).collect(),
        }
    }

    /// Adds a cycle.
    pub fn push(&mut self, cycle: &Cycle) {
        self.cycles += 1;
        self.saturated += u64::from(cycle.command.saturated);
        for signal in &mut self.signals {
            signal.seen.push(cycle.time, (signal.read)(cycle));
        }
    }

    /// The signal of a name, where this axis has it.
    fn signal(&self, name: &str) -> Option<&Signal> {
        self.signals.iter().find(|signal| signal.name == name)
    }

    fn sizes(&self, name: &str) -> Sizes {
        self.signal(name)
            .map_or_else(Sizes::default, |signal| *signal.seen.sizes())
    }

    /// A line of a figure.
    fn line(&self, name: &str, legend: &str) -> Series {
        let (t, y) = self
            .signal(name)
            .map(|signal| signal.seen.points())
            .unwrap_or_default();
        Series::line(legend, t, y)
    }

    /// Cycles of which each pair of points holds the extremes.
    fn stride(&self) -> usize {
        self.signals.first().map_or(1, |s| s.seen.stride())
    }
}

/// Figures share the time.
const TIME: &str = "time";

/// The page.
pub fn page(ran: &Ran<'_>) -> Page {
    let motion = Section::new("Motion");
    let motion = match ran.stopped {
        Some(why) => motion.notice(Notice::Warn, stopped(why)),
        None => motion,
    };
    Page::new(format!("Motion of {}", ran.axis.name))
        .lead(ran.axis.description.clone())
        .first(Block::Answers(answers(ran)))
        .section(
            motion
                .figure(position(ran))
                .figure(error(ran))
                .figure(speed(ran)),
        )
        .section(drive(ran))
        .section(Section::new("Values").table(table(ran)))
        .section(settings(ran))
}

fn stopped(why: &RunStopped) -> String {
    format!("The run did not come to its end, and all figures are those until then: {why}.")
}

fn answers(ran: &Ran<'_>) -> Vec<(String, Vec<String>)> {
    let unit = ran.axis.freedom().unit();
    let size = ran.shown.sizes(ERROR);
    let said = |value| engineering(value, unit, 3);
    let cycles = ran.shown.cycles;
    let limit = match ran.shown.saturated {
        0 => "No limit of the controller or the drive was reached.".to_owned(),
        n => {
            format!("A limit of the controller or the drive was active in {n} of {cycles} cycles.")
        }
    };
    let noise = match ran.noise {
        0.0 => "Simulated, not measured; sensors without noise.".to_owned(),
        factor => format!(
            "Simulated, not measured; noise of the sensors {factor} times that of good ones (seed {}).",
            ran.seed
        ),
    };
    let mut run = vec![format!(
        "{} of motion, {cycles} control cycles of {}, compensation: {}.",
        engineering(ran.axis.period * cycles as f64, "s", 4),
        engineering(ran.axis.period, "s", 3),
        ran.compensation
    )];
    run.extend(ran.stopped.map(stopped));
    let answer = |question: &str, lines: Vec<String>| (question.to_owned(), lines);
    vec![
        answer("What was run", run),
        answer(
            "How far it is off",
            vec![
                format!(
                    "Tracking error: {} peak (at {}), {} RMS, {} mean; {} at the end.",
                    said(size.peak),
                    engineering(size.peak_at, "s", 4),
                    said(size.rms()),
                    said(size.mean()),
                    said(size.last)
                ),
                limit,
            ],
        ),
        answer("How sure that is", vec![noise]),
        answer("What to do next", ran.next.clone()),
    ]
}

/// A figure over the time of this run.
fn over_time(title: &str, label: &str, unit: &str) -> Figure {
    Figure::new(title, "time", label)
        .units("s", unit)
        .linked(TIME)
}

fn position(ran: &Ran<'_>) -> Figure {
    over_time(
        "Position of the load",
        "position",
        ran.axis.freedom().unit(),
    )
    .series(ran.shown.line(POSITION, "load"))
    .series(ran.shown.line(REFERENCE, "reference").dashed())
}

fn error(ran: &Ran<'_>) -> Figure {
    let unit = ran.axis.freedom().unit();
    over_time("Tracking error", "reference − position", unit)
        .series(ran.shown.line(ERROR, "tracking error"))
}

fn speed(ran: &Ran<'_>) -> Figure {
    over_time(
        "Speed of the load",
        "speed",
        ran.axis.freedom().speed_unit(),
    )
    .series(ran.shown.line(SPEED, "load"))
    .series(ran.shown.line(SPEED_REFERENCE, "reference").dashed())
}

/// Channels of the log that are one figure: its title, and the legend's name of each.
type OneFigure = (&'static str, &'static [(&'static str, &'static str)]);

/// What drives the axis: those that its log has are shown.
const DRIVE: [OneFigure; 6] = [
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
    let moves = |name: &str| ran.shown.sizes(name).peak != 0.0;
    let shown = DRIVE.iter().filter_map(|(title, names)| {
        let there: Vec<_> = names.iter().filter(|(name, _)| moves(name)).collect();
        let (first, _) = there.first()?;
        let label = title.split(' ').next().unwrap_or(title).to_lowercase();
        let unit = ran.shown.signal(first).map_or("", |signal| signal.unit);
        let figure = over_time(title, &label, unit);
        let add = |figure: Figure, (name, legend): &&(&str, &str)| {
            figure.series(ran.shown.line(name, legend))
        };
        Some(there.iter().fold(figure, add))
    });
    let [name, unit] = effort(ran);
    let torque = moves(TORQUE).then(|| {
        over_time(&format!("Motor {name}"), name, unit).series(ran.shown.line(TORQUE, name))
    });
    shown
        .chain(torque)
        .fold(Section::new("Drive"), Section::figure)
}

fn table(ran: &Ran<'_>) -> Table {
    let unit = ran.axis.freedom().unit();
    let row = |table: Table, name: &str, unit: &str, size: Sizes| {
        let cell = |value| Cell::quantity(value, unit, 4);
        table.row([
            Cell::text(name),
            cell(size.peak),
            cell(size.rms()),
            cell(size.mean()),
        ])
    };
    let whole = match ran.stopped {
        Some(_) => "Until the run stopped",
        None => "Over the whole motion",
    };
    let table = Table::new(whole, ["Signal", "peak", "RMS", "mean of absolute values"]);
    let table = row(table, "tracking error", unit, ran.shown.sizes(ERROR));
    let table = row(
        table,
        "speed of the load",
        ran.axis.freedom().speed_unit(),
        ran.shown.sizes(SPEED),
    );
    let [name, unit] = effort(ran);
    let torque = ran.shown.sizes(TORQUE);
    let table = row(table, &format!("motor {name}"), unit, torque);
    match ran.shown.signal("iq_a") {
        Some(current) => row(table, "q current", "A", *current.seen.sizes()),
        None => table,
    }
}

fn settings(ran: &Ran<'_>) -> Section {
    let points = match ran.shown.stride() {
        // Of two cycles both are an extreme.
        1 | 2 => "every control cycle".to_owned(),
        n => format!("the least and the greatest value of every {n} control cycles"),
    };
    let list = KeyValues::new("What made this page")
        .entry("Axis", &ran.axis.name)
        .entry("Fingerprint of the axis", &ran.axis.fingerprint)
        .entry("Compensation", ran.compensation)
        .entry(
            "Noise of the sensors, as a multiple of that of good ones",
            ran.noise,
        )
        .entry("Seed", ran.seed)
        .entry("Points of the figures", points)
        .entry("Version", env!("CARGO_PKG_VERSION"));
    Section::new("Settings").key_values(list)
}
