//! Two runs side by side: settings, tracking errors with their differences, the same figures overlaid.

use axis_pipeline::compensation::{CompensatedRun, find};
use axis_pipeline::strategies::STRATEGIES;
use axis_pipeline::summary::Summary;
use axis_pipeline::validation::Validation;
use axis_pipeline::{ErrorUnit, Figures};
use axis_report::{Block, Cell, Figure, Mark, Page, Section, Series, Table, engineering};

use super::times;

/// One run's folder.
pub struct RunFolder {
    /// The folder as it was given.
    pub name: String,
    pub summary: Summary,
    pub validation: Validation,
    pub compensation: Vec<CompensatedRun>,
    /// Time between control cycles, s.
    pub period: f64,
}

/// A tracking error of both runs, in their unit.
struct Compared {
    trajectory: usize,
    what: &'static str,
    a: Figures,
    b: Figures,
    /// What the peaks are uncertain by, of the internal step.
    uncertain: f64,
}

/// How the peak of B stands to that of A.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Change {
    Smaller,
    Same,
    Greater,
}

impl Compared {
    /// How much greater the peak of B is, as a share of that of A.
    fn share(&self) -> f64 {
        self.b.max / self.a.max - 1.0
    }

    /// Beyond a thousandth and beyond what the internal step leaves open.
    fn change(&self) -> Change {
        let by = self.b.max - self.a.max;
        let least = (SAME * self.a.max).max(self.uncertain);
        match by {
            by if by > least => Change::Greater,
            by if by < -least => Change::Smaller,
            _ => Change::Same,
        }
    }

    /// The same in words.
    fn said(&self) -> String {
        match self.change() {
            Change::Same => "same".to_owned(),
            _ => format!("{:+.1} %", 100.0 * self.share()).replace('-', "\u{2212}"),
        }
    }
}

/// Differences below this share of the peak are none.
const SAME: f64 = 1e-3;

/// The page.
pub fn page(a: &RunFolder, b: &RunFolder) -> Page {
    let all = compared(a, b);
    Page::new("Two runs compared")
        .lead(format!("A: {}. B: {}.", a.name, b.name))
        .first(Block::Answers(answers(a, b, &all)))
        .section(Section::new("Tracking errors").table(errors(&all, a.validation.unit)))
        .section(figures(a, b))
        .section(Section::new("Settings").table(settings(a, b)))
}

/// What both have: the machine alone, and under each strategy.
fn compared(a: &RunFolder, b: &RunFolder) -> Vec<Compared> {
    let mut all = Vec::new();
    let uncertain = 2.0 * step_error(a).max(step_error(b));
    for t in &a.summary.trajectories {
        let Some(other) = b.summary.trajectories.iter().find(|o| o.id == t.id) else {
            continue;
        };
        let (of_a, of_b) = (&t.errors, &other.errors);
        all.push(Compared {
            trajectory: t.id,
            what: "none",
            a: of_a.machine,
            b: of_b.machine,
            uncertain,
        });
        for kind in STRATEGIES {
            let both = (
                of_a.compensated.under(kind.name),
                of_b.compensated.under(kind.name),
            );
            if let (Some(a), Some(b)) = both {
                all.push(Compared {
                    trajectory: t.id,
                    what: kind.label,
                    a,
                    b,
                    uncertain,
                });
            }
        }
    }
    all
}

fn answers(a: &RunFolder, b: &RunFolder, all: &[Compared]) -> Vec<(String, Vec<String>)> {
    let answer = |question: &str, lines: Vec<String>| (question.to_owned(), lines);
    let count = |change| all.iter().filter(|c| c.change() == change).count();
    let (less, more) = (count(Change::Smaller), count(Change::Greater));
    let unit = a.validation.unit.symbol();
    let told = |c: &Compared| {
        format!(
            "Trajectory {}, {}: peak {} in A, {} in B ({}).",
            c.trajectory,
            c.what,
            engineering(c.a.max, unit, 3),
            engineering(c.b.max, unit, 3),
            c.said()
        )
    };
    let by_share = |x: &&Compared, y: &&Compared| x.share().total_cmp(&y.share());
    let of = |change| all.iter().filter(move |c| c.change() == change);
    let ends = [
        of(Change::Smaller).min_by(by_share),
        of(Change::Greater).max_by(by_share),
    ];
    let mut lines: Vec<String> = match all.is_empty() {
        true => vec!["The runs have no trajectory in common.".to_owned()],
        false => vec![format!(
            "Of {} peaks of the tracking error, B has {less} smaller and {more} greater; the others are the same.",
            all.len()
        )],
    };
    lines.extend(ends.into_iter().flatten().map(told));
    vec![
        answer("What differs", differing(a, b)),
        answer("How much", lines),
        answer("How sure that is", vec![sure(a, b)]),
        answer("What to do next", vec![next(a, b)]),
    ]
}

/// Settings with their values in both runs.
fn pairs(a: &RunFolder, b: &RunFolder) -> Vec<(&'static str, String, String)> {
    let of = |name, read: fn(&Summary) -> String| (name, read(&a.summary), read(&b.summary));
    vec![
        of("axis", |s| s.axis.clone()),
        of("fingerprint of the axis", |s| s.axis_fingerprint.clone()),
        of("machine", |s| s.machine.clone()),
        of("seed", |s| s.seed.to_string()),
        of("--quick", |s| s.quick.to_string()),
        of("version", |s| s.version.clone()),
        of("training samples", |s| s.network.train_samples.to_string()),
        of("epochs", |s| s.network.epochs.to_string()),
    ]
}

fn differing(a: &RunFolder, b: &RunFolder) -> Vec<String> {
    let differ = pairs(a, b).into_iter().filter(|(_, a, b)| a != b);
    let lines: Vec<String> = differ
        .map(|(name, a, b)| match name {
            // Long, and of use only to a program.
            "fingerprint of the axis" => "The axis files differ in their parameters.".to_owned(),
            _ => format!("{name}: {a} in A, {b} in B."),
        })
        .collect();
    match lines.is_empty() {
        true => vec!["No setting: axis, seed, size and version are the same.".to_owned()],
        false => lines,
    }
}

/// How far halving the internal step moves the peaks, µm or µrad.
fn step_error(run: &RunFolder) -> f64 {
    run.validation.checks.half_step.max
}

fn sure(a: &RunFolder, b: &RunFolder) -> String {
    let seeds = match a.summary.seed == b.summary.seed {
        true => "the same seed",
        false => "different seeds, so that samples and networks differ by chance too",
    };
    format!(
        "Both are simulated, with {seeds}. Halving the internal step moves peaks by at most {} in A and {} in B; peaks that differ by less than twice that, or by less than a thousandth, are called the same.",
        engineering(step_error(a), a.validation.unit.symbol(), 2),
        engineering(step_error(b), b.validation.unit.symbol(), 2)
    )
}

fn next(a: &RunFolder, b: &RunFolder) -> String {
    let quick = [a, b].iter().any(|run| run.summary.quick);
    let other = pairs(a, b).iter().filter(|(_, a, b)| a != b).count();
    match (quick, other) {
        (true, _) => "A run with --quick is rough: run both without it before you decide.".to_owned(),
        (_, 0 | 1) => "The difference comes from what is named above: keep the run with the smaller errors.".to_owned(),
        _ => "Change one thing at a time: with several settings different, none of them can be named as the cause.".to_owned(),
    }
}

fn errors(all: &[Compared], unit: ErrorUnit) -> Table {
    let heads = [
        "Trajectory",
        "compensation",
        "peak A",
        "peak B",
        "B − A",
        "change",
        "mean A",
        "mean B",
    ];
    let mut table = Table::new(
        "Tracking error of the machine (simulated) in both runs",
        heads,
    )
    .note("Marked: the smaller peak, where they differ.");
    for c in all {
        let cell = |value| Cell::quantity(value, unit.symbol(), 4);
        let mark = |better: bool| if better { Mark::Best } else { Mark::Plain };
        table = table.row([
            Cell::text(c.trajectory.to_string()),
            Cell::text(c.what),
            cell(c.a.max).marked(mark(c.change() == Change::Greater)),
            cell(c.b.max).marked(mark(c.change() == Change::Smaller)),
            cell(c.b.max - c.a.max),
            Cell::text(c.said()),
            cell(c.a.mean),
            cell(c.b.mean),
        ]);
    }
    table
}

/// Of each trajectory that both have: the error without compensation, and with the best of A.
fn figures(a: &RunFolder, b: &RunFolder) -> Section {
    let mut grid = Vec::new();
    for t in &a.validation.trajectories {
        let Some(other) = b.validation.trajectories.iter().find(|o| o.id == t.id) else {
            continue;
        };
        let link = format!("trajectory {}", t.id);
        let figure = |title: String, of_a: &[f64], of_b: &[f64]| {
            let line = |name: &str, period, error: &[f64]| {
                Series::line(name, times(error.len(), period), error.to_vec())
            };
            Figure::new(title, "time", "tracking error")
                .units("s", a.validation.unit.symbol())
                .linked(&link)
                .series(line("A", a.period, of_a))
                .series(line("B", b.period, of_b).dashed())
        };
        let title = format!("Trajectory {}, no compensation", t.id);
        grid.push(figure(title, &t.machine.error, &other.machine.error));
        let both = STRATEGIES.iter().filter_map(|kind| {
            let of_a = find(&a.compensation, t.id, kind.name)?;
            Some((kind, of_a, find(&b.compensation, t.id, kind.name)?))
        });
        let best = both.min_by(|x, y| x.1.figures.max.total_cmp(&y.1.figures.max));
        if let Some((kind, of_a, of_b)) = best {
            let title = format!("Trajectory {}, {}", t.id, kind.label);
            grid.push(figure(title, &of_a.error, &of_b.error));
        }
    }
    Section::new("The same figures of both")
        .paragraph("Left: the machine alone. Right: under the compensation with the smallest peak in A. The two figures of a trajectory zoom together.")
        .figure_grid(grid, 2)
}

fn settings(a: &RunFolder, b: &RunFolder) -> Table {
    let rows = pairs(a, b).into_iter();
    rows.fold(
        Table::new("Settings of both", ["Setting", "A", "B"]),
        |table, (name, a, b)| table.row([Cell::text(name), Cell::text(a), Cell::text(b)]),
    )
}
