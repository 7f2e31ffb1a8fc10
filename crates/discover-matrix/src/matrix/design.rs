//! The cases.

use axis_sim::Axis;
use axis_sim::effects::{EFFECTS, Effect, EffectParameter, Nature, Scales};
use discrepancy::applicable;
use lhs::{LatinHypercube, LhsError};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::case::{Case, CaseKind, HiddenEffect};
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
    /// Effects outside the library.
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
        (CaseKind::Single, sizes.singles),
        (CaseKind::Clean, sizes.clean),
        (CaseKind::Pair, sizes.pairs),
        (CaseKind::Triple, sizes.triples),
        (CaseKind::Outside, sizes.outside),
        (CaseKind::LeftOut, sizes.left_out),
        (CaseKind::Poor, sizes.poor),
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

fn case(axis: &Axis, kind: CaseKind, index: usize, row: &[f64; DIMENSIONS], seed: u64) -> Case {
    let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x6361_7365);
    let pick = |share: f64, n: usize| ((share * n as f64) as usize).min(n - 1);
    let exercise = match kind {
        CaseKind::Poor => Exercise::OneWay,
        _ => Exercise::RICH[pick(row[1], Exercise::RICH.len())],
    };
    let library: Vec<&'static Effect> = applicable(axis).collect();
    let effects: Vec<&'static Effect> = match kind {
        CaseKind::Clean => Vec::new(),
        CaseKind::Single => vec![library[pick(row[0], library.len())]],
        CaseKind::LeftOut | CaseKind::Poor => vec![library[index % library.len()]],
        CaseKind::Outside => vec![OUTSIDE[pick(row[0], OUTSIDE.len())]],
        CaseKind::Pair | CaseKind::Triple => {
            let mut chosen = vec![library[pick(row[0], library.len())]];
            let wanted = if kind == CaseKind::Pair { 2 } else { 3 };
            while chosen.len() < wanted {
                let next = library[pick(random.random(), library.len())];
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
                CaseKind::LeftOut | CaseKind::Poor => 1.0,
                _ => 0.25 * 8f64.powf(row[3 + i]),
            };
            HiddenEffect {
                name: effect.name.to_owned(),
                values: values(axis, effect, size, &mut random),
            }
        })
        .collect();
    let rejected = match kind {
        CaseKind::LeftOut => effects.iter().map(|e| e.name.to_owned()).collect(),
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
        visible: (kind == CaseKind::Poor).then(|| 4.0 * 10f64.powf(row[3])),
    }
}

/// Values of an effect, `size` times typical; shapes as their nature has them drawn.
pub(crate) fn values(axis: &Axis, effect: &Effect, size: f64, random: &mut ChaCha8Rng) -> Vec<f64> {
    let scales = Scales::of(axis);
    let mut between = |[low, high]: [f64; 2]| low + (high - low) * random.random::<f64>();
    let either = |p: &EffectParameter| p.nature == Nature::Size { either_sign: true };
    let signed = effect.parameters.iter().any(either);
    let sign = if signed && between([0.0, 1.0]) < 0.5 {
        -1.0
    } else {
        1.0
    };
    let begin = between([0.4, 3.0]);
    let one = |p: &EffectParameter| match p.nature {
        Nature::Size { .. } => sign * size * p.typical(&scales),
        Nature::Phase => between([-3.0, 3.0]),
        Nature::Held => p.typical(&scales),
        Nature::Order([least, most]) | Nature::TurnOrder([least, most]) => {
            between([f64::from(least), f64::from(most) + 1.0]).floor()
        }
        Nature::Place(shares) => scales.start + scales.motion * between(shares),
        Nature::Width(shares) => scales.motion * between(shares),
        Nature::Speed(_, [low, high])
        | Nature::Extent(_, [low, high])
        | Nature::Frequency(_, [low, high]) => {
            low * (high / low).powf(between([0.0, 1.0])) * scales.ratio(p.measure)
        }
        Nature::Time(_, range) => between(range),
        Nature::Begin(_) => begin,
        Nature::End(after) => begin + between(after),
    };
    effect.parameters.iter().map(one).collect()
}
