//! The first screen of the pipeline's report: how far off, how much less, how sure, what next.

use axis_pipeline::Figures;
use axis_pipeline::strategies::{NETWORK_LUGRE, STRATEGIES, StrategyKind};
use axis_pipeline::summary::TrajectorySummary;
use axis_report::{engineering, fixed};

use crate::context::Context;
use crate::program;
use crate::results::Results;

/// A strategy and what it leaves.
type Left = (&'static StrategyKind, Figures);

/// Questions and answers, on the trajectory where the machine alone is furthest off.
pub fn answers(context: &Context, results: &Results) -> Vec<(String, Vec<String>)> {
    let alone = |t: &&TrajectorySummary| t.errors.machine.max;
    let all = results.summary.trajectories.iter();
    let Some(worst) = all.max_by(|a, b| alone(a).total_cmp(&alone(b))) else {
        return Vec::new();
    };
    let unit = context.unit().symbol();
    let none = worst.errors.machine;
    let off = format!(
        "Without compensation the tracking error is {} peak, {} mean, on trajectory {}, where its peak is greatest of {}.",
        engineering(none.max, unit, 3),
        engineering(none.mean, unit, 3),
        worst.id,
        results.summary.trajectories.len()
    );
    let best = best(worst);
    // That of the paper first, which the overview is about.
    let mut left: Vec<Left> = ran(worst, &NETWORK_LUGRE).into_iter().chain(best).collect();
    left.dedup_by_key(|(kind, _)| kind.name);
    let left = left.into_iter().map(|left| what_is_left(left, none, unit));
    [
        ("How far the axis is off", vec![off]),
        ("How much compensation takes away", left.collect()),
        ("How sure that is", sure(context, results, unit)),
        ("What to do next", next(context, worst.id, best)),
    ]
    .map(|(question, lines)| (question.to_owned(), lines))
    .into()
}

fn ran(on: &TrajectorySummary, kind: &'static StrategyKind) -> Option<Left> {
    let figures = on.errors.compensated.under(kind.name)?;
    Some((kind, figures))
}

/// The strategy with the smallest peak.
fn best(on: &TrajectorySummary) -> Option<Left> {
    let all = STRATEGIES.iter().filter_map(|kind| ran(on, kind));
    all.min_by(|a, b| a.1.max.total_cmp(&b.1.max))
}

fn what_is_left((kind, left): Left, none: Figures, unit: &str) -> String {
    let less = |share: f64| match share {
        // Rounded it would say that nothing is left.
        share if (0.0..0.001).contains(&share) => "over 99.9 %".to_owned(),
        share => format!("{} %", fixed(100.0 * (1.0 - share), 1)),
    };
    format!(
        "{} leaves {} peak, {} mean: {} and {} less.",
        kind.heading,
        engineering(left.max, unit, 3),
        engineering(left.mean, unit, 3),
        less(left.max / none.max),
        less(left.mean / none.mean)
    )
}

fn sure(context: &Context, results: &Results, unit: &str) -> Vec<String> {
    let machine = match context.has_machine {
        true => format!(
            "{}, which differs from the model as its file says",
            context.machine.name
        ),
        false => "the model itself, as if it were right".to_owned(),
    };
    let step = results.validation.checks.half_step.max;
    vec![
        format!("Simulated, not measured: on {machine}, with perfect sensors."),
        format!(
            "Halving the internal step moves peaks by at most {}.",
            engineering(step, unit, 2)
        ),
    ]
}

fn next(context: &Context, trajectory: usize, best: Option<Left>) -> Vec<String> {
    let program = program::name();
    let first = match (context.quick, best) {
        (true, _) => "Run it without --quick, for figures to quote.".to_owned(),
        (false, Some((kind, _))) => format!(
            "Look at one motion: {program} simulate --trajectory {trajectory} --compensation {} --report motion.html, with the axis file of this run.",
            kind.name.replace('_', "-")
        ),
        (false, None) => format!("Run {program} compensate: no strategy has results here."),
    };
    let then = format!(
        "{program} robustness shows the error that remains when the model is wrong; with logs of the real axis, {program} discover names what the model lacks."
    );
    vec![first, then]
}
