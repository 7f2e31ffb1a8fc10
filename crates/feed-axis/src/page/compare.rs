//! Two runs side by side: settings, tracking errors with their differences, the same figures overlaid.

use pipeline::Figures;
use pipeline::compensation::{CompensatedRun, find};
use pipeline::strategies::STRATEGIES;
use pipeline::summary::Summary;
use pipeline::validation::Validation;
use report::{Block, Cell, Figure, Mark, Page, Section, Series, Table, engineering};

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

/// A tracking error of both runs.
struct Compared {
    trajectory: usize,
    what: &'static str,
    a: Figures,
    b: Figures,
}

impl Compared {
    /// How much greater the peak of B is, as a share of that of A.
    fn change(&self) -> f64 {
        self.b.max / self.a.max - 1.0
    }
}

/// Changes below this share of the peak are called none.
const SAME: f64 = 1e-3;

/// The page.
pub fn page(a: &RunFolder, b: &RunFolder) -> Page {
    let all = compared(a, b);
    Page::new("Two runs compared")
        .lead(format!("A: {}. B: {}.", a.name, b.name))
        .first(Block::Answers(answers(a, b, &all)))
        .section(Section::new("Tracking errors").table(errors(&all)))
        .section(figures(a, b))
        .section(Section::new("Settings").table(settings(a, b)))
}

/// What both have: the machine alone, and under each strategy.
fn compared(a: &RunFolder, b: &RunFolder) -> Vec<Compared> {
    let mut all = Vec::new();
    for t in &a.summary.trajectories {
        let Some(other) = b.summary.trajectories.iter().find(|o| o.id == t.id) else {
            continue;
        };
        let (of_a, of_b) = (&t.errors_um, &other.errors_um);
        all.push(Compared {
            trajectory: t.id,
            what: "none",
            a: of_a.machine,
            b: of_b.machine,
        });
        for kind in STRATEGIES {
            let both = (
                of_a.compensated.under(kind.name),
                of_b.compensated.under(kind.name),
            );
            if let (Some(a), Some(b)) = both {
                let (trajectory, what) = (t.id, kind.label);
                all.push(Compared {
                    trajectory,
                    what,
                    a,
                    b,
                });
            }
        }
    }
    all
}

fn answers(a: &RunFolder, b: &RunFolder, all: &[Compared]) -> Vec<(String, Vec<String>)> {
    let answer = |question: &str, lines: Vec<String>| (question.to_owned(), lines);
    let count = |kept: fn(f64) -> bool| all.iter().filter(|c| kept(c.change())).count();
    let (less, more) = (count(|c| c < -SAME), count(|c| c > SAME));
    let told = |c: &Compared| {
        format!(
            "Trajectory {}, {}: peak {} in A, {} in B ({:+.1} %).",
            c.trajectory,
            c.what,
            engineering(c.a.max, "µm", 3),
            engineering(c.b.max, "µm", 3),
            100.0 * c.change()
        )
    };
    let by_change = |x: &&Compared, y: &&Compared| x.change().total_cmp(&y.change());
    let ends = [all.iter().min_by(by_change), all.iter().max_by(by_change)];
    let mut lines: Vec<String> = match all.is_empty() {
        true => vec!["The runs have no trajectory in common.".to_owned()],
        false => vec![format!(
            "Of {} peaks of the tracking error B has {less} smaller and {more} greater; the others agree to {} %.",
            all.len(),
            100.0 * SAME
        )],
    };
    let (least, most) = (
        ends[0].filter(|c| c.change() < -SAME),
        ends[1].filter(|c| c.change() > SAME),
    );
    lines.extend(least.into_iter().chain(most).map(told));
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

fn sure(a: &RunFolder, b: &RunFolder) -> String {
    let most = [a, b].map(|run| run.validation.checks.half_step.max);
    let seeds = match a.summary.seed == b.summary.seed {
        true => "the same seed",
        false => "different seeds, so that samples and networks differ by chance too",
    };
    format!(
        "Both are simulated, with {seeds}. Halving the internal step moves peaks by at most {} in A and {} in B.",
        engineering(most[0], "µm", 2),
        engineering(most[1], "µm", 2)
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

fn errors(all: &[Compared]) -> Table {
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
    .note("Marked: the smaller peak, where they differ by more than a thousandth.");
    for c in all {
        let um = |value| Cell::quantity(value, "µm", 4);
        let mark = |better: bool| if better { Mark::Best } else { Mark::Plain };
        table = table.row([
            Cell::text(c.trajectory.to_string()),
            Cell::text(c.what),
            um(c.a.max).marked(mark(c.change() > SAME)),
            um(c.b.max).marked(mark(c.change() < -SAME)),
            um(c.b.max - c.a.max),
            Cell::text(format!("{:+.1} %", 100.0 * c.change())),
            um(c.a.mean),
            um(c.b.mean),
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
                .units("s", "µm")
                .linked(&link)
                .series(line("A", a.period, of_a))
                .series(line("B", b.period, of_b).dashed())
        };
        let title = format!("Trajectory {}, no compensation", t.id);
        grid.push(figure(title, &t.machine.error_um, &other.machine.error_um));
        let both = STRATEGIES.iter().filter_map(|kind| {
            let of_a = find(&a.compensation, t.id, kind.name)?;
            Some((kind, of_a, find(&b.compensation, t.id, kind.name)?))
        });
        let best = both.min_by(|x, y| x.1.figures.max.total_cmp(&y.1.figures.max));
        if let Some((kind, of_a, of_b)) = best {
            let title = format!("Trajectory {}, {}", t.id, kind.label);
            grid.push(figure(title, &of_a.error_um, &of_b.error_um));
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
