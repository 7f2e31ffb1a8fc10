//! The cases, drawn.
//!
//! The design is a split plot. Machine, motion, start, tolerance and channels are drawn a
//! plot, by a Latin hypercube over plots, as what the library does on a motion is the same
//! for all cases of it; everything else is drawn a case, by a Latin hypercube over all cases
//! of a kind.

use axis_sim::Axis;
use axis_sim::effects::{Effect, EffectChannel, Scales};
use discrepancy::applicable;
use lhs::{LatinHypercube, LhsError};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::case::{Case, CaseSetting, Channels, TOLERANCES, VERSION, VISIBLE};
use crate::hidden::{
    Entry, Exercise, Form, LAW_NAME, Law, NoiseColour, Ranges, Rough, exercise, most_off,
};
use crate::matrix::{CaseKind, HiddenEffect, values};

/// How many plots, and how many cases of each kind in one.
#[derive(Clone, Debug)]
pub struct MatrixPlan {
    /// Plots.
    pub plots: usize,
    /// Cases of a plot.
    pub each: Vec<(CaseKind, usize)>,
}

impl MatrixPlan {
    /// The whole matrix: 1080 cases, 360 of them clean.
    pub fn full() -> Self {
        Self {
            plots: 90,
            each: vec![
                (CaseKind::Clean, 4),
                (CaseKind::Single, 4),
                (CaseKind::Outside, 2),
                (CaseKind::Pair, 1),
                (CaseKind::LeftOut, 1),
            ],
        }
    }

    /// A look: a plot a machine, four cases in each.
    pub fn quick(machines: usize) -> Self {
        let kinds = [
            CaseKind::Clean,
            CaseKind::Single,
            CaseKind::Outside,
            CaseKind::LeftOut,
        ];
        Self {
            plots: machines,
            each: kinds.map(|kind| (kind, 1)).to_vec(),
        }
    }

    /// As the whole, with at least so many cases.
    pub fn of(cases: usize) -> Self {
        let full = Self::full();
        Self {
            plots: cases.div_ceil(full.cases() / full.plots),
            ..full
        }
    }

    /// Cases in all.
    pub fn cases(&self) -> usize {
        self.plots * self.each.iter().map(|(_, n)| n).sum::<usize>()
    }
}

/// Lays out the cases plot by plot; the same seed gives the same ones. Plots take the
/// machines in turn.
///
/// # Errors
/// [`LhsError`] never for sizes above zero.
pub fn cases(machines: &[Axis], plan: &MatrixPlan, seed: u64) -> Result<Vec<Case>, LhsError> {
    let mut all: Vec<(f64, Case)> = Vec::new();
    if machines.is_empty() || plan.plots == 0 {
        return Ok(Vec::new());
    }
    let hypercube = LatinHypercube::new(plan.plots, PLOT, seed.wrapping_mul(11))?;
    let mut row = [0.0; PLOT];
    let mut plots = Vec::with_capacity(plan.plots);
    for plot in 0..plan.plots {
        hypercube.row(plot, &mut row)?;
        let axis = &machines[plot % machines.len()];
        let setting = setting(axis, &row);
        plots.push(Plot::new(axis, setting));
    }
    for (k, &(kind, n)) in plan.each.iter().enumerate() {
        let count = n * plan.plots;
        if count == 0 {
            continue;
        }
        let stream = seed.wrapping_mul(11) + 1 + k as u64;
        let hypercube = LatinHypercube::new(count, CASE, stream)?;
        let mut row = [0.0; CASE];
        for i in 0..count {
            hypercube.row(i, &mut row)?;
            let plot = i % plan.plots;
            let number = i / plan.plots;
            let drawn = Drawn {
                id: format!("p{plot:02}-{}-{number}", kind.name()),
                seed: (seed.wrapping_mul(1_000_003)).wrapping_add((k * 100_000 + i) as u64),
                plot,
            };
            let place = (number as f64 + 0.5) / n as f64;
            all.push((place, case(&plots[plot], kind, drawn, &row)));
        }
    }
    // Within a plot every kind comes up early.
    all.sort_by(|(a, one), (b, other)| one.plot.cmp(&other.plot).then(a.total_cmp(b)));
    Ok(all.into_iter().map(|(_, case)| case).collect())
}

/// Motion, start, tolerance, channels.
const PLOT: usize = 4;

/// Numbers that a case is drawn from.
const CASE: usize = 17;

fn pick(share: f64, n: usize) -> usize {
    ((share * n as f64) as usize).min(n - 1)
}

/// From `low` to `high`, evenly in the logarithm.
fn between(low: f64, high: f64, share: f64) -> f64 {
    low * (high / low).powf(share)
}

fn setting(axis: &Axis, row: &[f64; PLOT]) -> CaseSetting {
    let (stroke, motion) = (&axis.stroke, Scales::of(axis).motion);
    // A twentieth of the motion off either end.
    let room = stroke.maximum - stroke.minimum - 1.1 * motion;
    let channels = Channels::ALL[pick(row[3], Channels::ALL.len())];
    // Of a robot joint a move there and back has too few samples below its resonance.
    let exercises = match channels {
        Channels::Balance => &Exercise::RICH[1..],
        _ => &Exercise::RICH[..],
    };
    CaseSetting {
        machine: axis.name.clone(),
        exercise: exercises[pick(row[0], exercises.len())],
        start: stroke.minimum + 0.05 * motion + row[1] * room.max(0.0),
        tolerance: TOLERANCES[pick(row[2], TOLERANCES.len())],
        channels,
    }
}

/// What the cases of a plot share.
struct Plot {
    /// As the setting has it.
    axis: Axis,
    setting: CaseSetting,
    ranges: Ranges,
}

impl Plot {
    fn new(axis: &Axis, setting: CaseSetting) -> Self {
        let axis = started(axis, &setting);
        Self {
            ranges: ranges(&axis, &setting),
            axis,
            setting,
        }
    }
}

struct Drawn {
    id: String,
    seed: u64,
    plot: usize,
}

fn case(on: &Plot, kind: CaseKind, drawn: Drawn, row: &[f64; CASE]) -> Case {
    let mut random = ChaCha8Rng::seed_from_u64(drawn.seed ^ 0x6361_7365);
    let Plot { axis, setting, .. } = on;
    let library = shown(axis, setting.channels);
    let mut hide = |effect: &Effect| HiddenEffect {
        name: effect.name.to_owned(),
        values: values(axis, effect, 1.0, &mut random),
    };
    let (mut hidden, mut law) = (Vec::new(), None);
    match kind {
        CaseKind::Clean => {}
        CaseKind::Outside => {
            let drawn = Law::draw(axis, &on.ranges, [row[0], row[1], row[2]]);
            hidden.push(HiddenEffect {
                name: LAW_NAME.to_owned(),
                values: drawn.active(drawn.typical(axis)).values,
            });
            law = Some(drawn);
        }
        _ => hidden.push(hide(library[pick(row[0], library.len())])),
    }
    if matches!(kind, CaseKind::Pair | CaseKind::Triple) {
        let others: Vec<&Effect> = (library.iter().copied())
            .filter(|e| e.name != hidden[0].name)
            .collect();
        hidden.push(hide(others[pick(row[1], others.len())]));
    }
    let visible = |share: f64| between(VISIBLE[0], VISIBLE[1], share);
    Case {
        version: VERSION,
        id: drawn.id,
        plot: drawn.plot,
        setting: setting.clone(),
        kind,
        rejected: match kind {
            CaseKind::LeftOut => vec![hidden[0].name.clone()],
            _ => Vec::new(),
        },
        visible: [row[3], row[4]][..hidden.len()]
            .iter()
            .map(|s| visible(*s))
            .collect(),
        hidden,
        law,
        form: form(axis, row[5]),
        form_at: [row[6], row[7], row[8]],
        noise: noise([row[9], row[10], row[11], row[12], row[13], row[14], row[15]]),
        // Half of them relaxed.
        wound: if row[16] > 0.5 {
            4.0 * row[16] - 3.0
        } else {
            0.0
        },
        seed: drawn.seed,
    }
}

/// The axis with its motions where the setting has them, and its tolerances.
pub(super) fn started(axis: &Axis, setting: &CaseSetting) -> Axis {
    let mut axis = axis.clone();
    axis.stroke.start = setting.start;
    axis.tolerances = axis_sim::Tolerances::all(setting.tolerance);
    axis
}

/// Effects that can be hidden: in a torque balance those that act in it.
pub(super) fn shown(axis: &Axis, channels: Channels) -> Vec<&'static Effect> {
    let in_balance = |e: &&Effect| e.channel == EffectChannel::Torque;
    let acts = |e: &&'static Effect| channels != Channels::Balance || in_balance(e);
    applicable(axis).filter(acts).collect()
}

/// Half of the cases as the model, the others in one of the forms that the axis can have.
fn form(axis: &Axis, share: f64) -> Form {
    if share < 0.5 {
        return Form::Same;
    }
    let can = |form: &Form| form.on(axis, &[], [0.5; 3]).is_some();
    let forms: Vec<Form> = Form::ALL.into_iter().filter(can).collect();
    match forms.is_empty() {
        true => Form::Same,
        false => forms[pick(2.0 * share - 1.0, forms.len())],
    }
}

/// Kinds of noise, a line each.
const NOISES: [(NoiseColour, Entry); 7] = [
    (NoiseColour::White, Entry::Loop),
    (NoiseColour::White, Entry::Logger),
    (NoiseColour::Coloured, Entry::Loop),
    (NoiseColour::Coloured, Entry::Logger),
    (NoiseColour::Quantised, Entry::Loop),
    (NoiseColour::Quantised, Entry::Logger),
    (NoiseColour::Outliers, Entry::Logger),
];

fn noise(at: [f64; 7]) -> Rough {
    let (colour, entry) = NOISES[pick(at[0], NOISES.len())];
    let alone = (colour, entry) == NOISES[0];
    Rough {
        level: between(0.5, 3.0, at[1]),
        colour,
        entry,
        share: match colour {
            _ if alone => 0.0,
            NoiseColour::Quantised => between(1.0, 20.0, at[2]),
            _ => between(0.5, 3.0, at[2]),
        },
        corner: between(10.0, 200.0, at[3]),
        line: between(15.0, 300.0, at[4]),
        rare: between(1e-5, 3e-4, at[5]),
        far: between(30.0, 300.0, at[6]),
    }
}

/// What the motion of a setting spans.
fn ranges(axis: &Axis, setting: &CaseSetting) -> Ranges {
    use trajectories::Motion;
    let Ok(motion) = exercise(axis, setting.exercise, false) else {
        return Ranges {
            position: [setting.start, setting.start + Scales::of(axis).motion],
            speed: 1.0,
            acceleration: 1.0,
            duration: 1.0,
        };
    };
    let duration = motion.duration();
    let start = motion.at(0.0).position;
    let mut ranges = Ranges {
        position: [start, start],
        speed: 0.0,
        acceleration: 0.0,
        duration,
    };
    for k in 0..2000 {
        let at = motion.at(duration * f64::from(k) / 2000.0);
        let [low, high] = ranges.position;
        ranges.position = [low.min(at.position), high.max(at.position)];
        ranges.speed = ranges.speed.max(at.velocity.abs());
        ranges.acceleration = ranges.acceleration.max(at.acceleration.abs());
    }
    ranges
}

impl Case {
    /// Whether a case is this one, its sizes scaled or not yet.
    pub fn is_same(&self, other: &Self) -> bool {
        let unscaled = |case: &Self| {
            let mut case = case.clone();
            case.hidden.iter_mut().for_each(|h| h.values.clear());
            case
        };
        unscaled(self) == unscaled(other)
    }
}

/// A number from 0 to 1 that a seed gives for each known parameter, and what it is off by.
pub(super) fn shares(axis: &Axis, case: &Case) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(case.seed ^ 0x6b6e_6f77);
    let share = case.setting.tolerance;
    let off = |most| most * (2.0 * random.random::<f64>() - 1.0);
    most_off(axis, share).into_iter().map(off).collect()
}
