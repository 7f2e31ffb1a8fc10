//! The cases.

use axis_sim::Axis;
use axis_sim::effects::{EFFECTS, Effect};
use lhs::{LatinHypercube, LhsError};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::case::{Case, HiddenEffect, Kind};
use crate::hidden::{Exercise, OUTSIDE};

/// How many cases of each kind.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    /// One effect; best a multiple of the library's size.
    pub singles: usize,
    /// Nothing hidden.
    pub clean: usize,
    /// Two effects.
    pub pairs: usize,
    /// Three effects.
    pub triples: usize,
    /// Effects of no library.
    pub outside: usize,
    /// Effects taken out of the library, once each.
    pub left_out: usize,
    /// One effect on poor motion.
    pub poor: usize,
}

impl Sizes {
    /// The whole matrix.
    pub const FULL: Self = Self {
        singles: 12 * EFFECTS.len(),
        clean: 120,
        pairs: 60,
        triples: 20,
        outside: 5 * OUTSIDE.len(),
        left_out: EFFECTS.len(),
        poor: EFFECTS.len(),
    };

    /// A look at every kind.
    pub const SMALL: Self = Self {
        singles: 8,
        clean: 3,
        pairs: 3,
        triples: 1,
        outside: 3,
        left_out: 2,
        poor: 2,
    };
}

/// Lays out the cases; the same seed gives the same ones. They are in an order
/// in which every kind comes up early, so that a part of them says something.
///
/// # Errors
/// [`LhsError`] never for sizes above zero; none of a kind is allowed.
pub fn cases(axis: &Axis, sizes: &Sizes, seed: u64) -> Result<Vec<Case>, LhsError> {
    let kinds = [
        (Kind::Single, sizes.singles),
        (Kind::Clean, sizes.clean),
        (Kind::Pair, sizes.pairs),
        (Kind::Triple, sizes.triples),
        (Kind::Outside, sizes.outside),
        (Kind::LeftOut, sizes.left_out),
        (Kind::Poor, sizes.poor),
    ];
    let mut placed: Vec<(f64, Case)> = Vec::new();
    for (k, (kind, n)) in kinds.into_iter().enumerate() {
        if n == 0 {
            continue;
        }
        let hypercube = LatinHypercube::new(n, DIMENSIONS, seed.wrapping_mul(7) + k as u64)?;
        let mut row = [0.0; DIMENSIONS];
        for i in 0..n {
            hypercube.row(i, &mut row)?;
            let case_seed = seed
                .wrapping_mul(1_000_003)
                .wrapping_add((k * 10_000 + i) as u64);
            placed.push((
                (i as f64 + 0.5) / n as f64,
                case(axis, kind, i, &row, case_seed),
            ));
        }
    }
    placed.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(placed.into_iter().map(|(_, case)| case).collect())
}

/// Effect, motion, noise, and the size of up to three effects.
const DIMENSIONS: usize = 6;

fn case(axis: &Axis, kind: Kind, index: usize, row: &[f64; DIMENSIONS], seed: u64) -> Case {
    let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x6361_7365);
    let pick = |share: f64, n: usize| ((share * n as f64) as usize).min(n - 1);
    let exercise = match kind {
        Kind::Poor => Exercise::OneWay,
        _ => Exercise::RICH[pick(row[1], Exercise::RICH.len())],
    };
    let effects: Vec<&'static Effect> = match kind {
        Kind::Clean => Vec::new(),
        Kind::Single => vec![EFFECTS[pick(row[0], EFFECTS.len())]],
        Kind::LeftOut | Kind::Poor => vec![EFFECTS[index % EFFECTS.len()]],
        Kind::Outside => vec![OUTSIDE[pick(row[0], OUTSIDE.len())]],
        Kind::Pair | Kind::Triple => {
            let mut chosen = vec![EFFECTS[pick(row[0], EFFECTS.len())]];
            let wanted = if kind == Kind::Pair { 2 } else { 3 };
            while chosen.len() < wanted {
                let next = EFFECTS[pick(random.random(), EFFECTS.len())];
                if chosen.iter().all(|e| e.name != next.name) {
                    chosen.push(next);
                }
            }
            chosen
        }
    };
    let hidden = effects
        .iter()
        .enumerate()
        .map(|(i, effect)| {
            let size = match kind {
                // An effect that is taken out should be one that would be seen;
                // what is hard to tell is scaled to where it is.
                Kind::LeftOut | Kind::Poor => 1.0,
                _ => 0.25 * 8f64.powf(row[3 + i]),
            };
            HiddenEffect {
                name: effect.name.to_owned(),
                values: values(axis, effect, size, &mut random),
            }
        })
        .collect();
    let rejected = match kind {
        Kind::LeftOut => effects.iter().map(|e| e.name.to_owned()).collect(),
        _ => Vec::new(),
    };
    Case {
        id: format!("{}-{index:03}", kind.name()),
        kind,
        hidden,
        exercise,
        noise: 0.5 * 6f64.powf(row[2]),
        known_off: 0.01,
        rejected,
        seed,
        visible: (kind == Kind::Poor).then(|| 4.0 * 10f64.powf(row[3])),
    }
}

/// Effects whose size may as well be negative.
const EITHER_SIGN: [&str; 12] = [
    "constant-load",
    "process-force",
    "torque-constant",
    "current-sensor-offset",
    "lead-error",
    "thermal-expansion",
    "stator-resistance",
    "controller-gain",
    "speed-controller-gain",
    "velocity-feedforward",
    "clock-offset",
    "transmission-stiffness",
];

/// Values of an effect, `size` times typical; shapes at random.
fn values(axis: &Axis, effect: &Effect, size: f64, random: &mut ChaCha8Rng) -> Vec<f64> {
    let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    let sign = if EITHER_SIGN.contains(&effect.name) && between(0.0, 1.0) < 0.5 {
        -1.0
    } else {
        1.0
    };
    let start = axis.stroke.start;
    let process = between(0.4, 3.0);
    let one = |p: &axis_sim::effects::EffectParameter| match (effect.name, p.name) {
        ("stribeck-friction", "velocity") => 0.005 * 10f64.powf(between(0.0, 1.0)),
        ("position-dependent-friction", "centre") => start + between(0.03, 0.15),
        ("position-dependent-friction", "width") => between(0.01, 0.04),
        ("process-force", "start") => process,
        ("process-force", "end") => process + between(0.3, 1.5),
        ("cogging-torque", "order") => between(1.0, 25.0).floor(),
        ("thermal-expansion", "time_constant") => between(1.0, 10.0),
        ("position-damping" | "spring-load", "zero") => start + between(0.0, 0.2),
        ("fading-friction", "time") => between(1.0, 8.0),
        ("wave-load", "pitch") => between(0.03, 0.08),
        ("local-resonance", "frequency") => between(20.0, 120.0),
        (_, "phase") => between(-3.0, 3.0),
        _ => sign * size * p.typical,
    };
    effect.parameters.iter().map(one).collect()
}
