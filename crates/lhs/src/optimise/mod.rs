//! Better combinations by exchanges within a column.
//!
//! An exchange of two values of one column keeps every column's set of
//! values, and so the Latin property. A step picks two points, finds in one
//! O(n m) pass what an exchange in each of the m columns would change (Jin,
//! Chen and Sudjianto 2005, doi 10.1016/j.jspi.2004.02.014, update the
//! criterion in the same spirit), and takes the best column if that worsens
//! the criterion by less than a threshold, which falls to zero (threshold
//! accepting, used for discrepancies by Winker and Fang 1997, doi
//! 10.1137/S0036142995286076).

mod discrepancy;
mod distance;

use crate::criteria::{centred_discrepancy, minimum_distance, phi_p};
use crate::permutation::{Purpose, below, stream};
use crate::{Design, LatinHypercube, LhsError};
use discrepancy::Discrepancy;
use distance::Repulsion;
use rand_chacha::ChaCha8Rng;

/// What an optimised design is to be good at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Criterion {
    /// Low [`centred_discrepancy`]: even in every projection.
    CentredDiscrepancy,
    /// High [`minimum_distance`], sought through a low [`phi_p`] with p =
    /// [`MAXIMIN_P`].
    Maximin,
}

/// The exponent of φ_p behind [`Criterion::Maximin`].
pub const MAXIMIN_P: f64 = 20.0;

/// How much work an optimisation may do. Its result depends on this number,
/// never on the time that the work takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Budget {
    /// Pairs of points tried, each in all columns; O(n m) time for each.
    pub iterations: usize,
}

/// What an optimisation did.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OptimisationHistory {
    /// The criterion used.
    pub criterion: Criterion,
    /// Its value at the start by the full formula: CD², or φ_p.
    pub initial: f64,
    /// Its value for the design returned by the full formula, not above
    /// `initial`.
    pub best: f64,
    /// Pairs of points tried.
    pub tried: usize,
    /// Exchanges made, those taken back at the end included.
    pub exchanged: usize,
    /// (pairs tried, best value so far) at up to about a hundred moments, by
    /// the running update.
    pub trace: Vec<(usize, f64)>,
}

/// A criterion that can tell cheaply what exchanges change.
trait Objective {
    /// For an exchange of points `i` and `j` in each column: the change.
    fn changes(&mut self, i: usize, j: usize, out: &mut [f64]);
    /// Makes the exchange in column `dim`; `change` is what `changes` found for it.
    fn exchange(&mut self, i: usize, j: usize, dim: usize, change: f64);
    /// The sum that `changes` refers to, as it is now.
    fn sum(&self) -> f64;
    /// The criterion that belongs to a sum.
    fn criterion(&self, sum: f64) -> f64;
    /// A point worth moving.
    fn pick(&self, rng: &mut ChaCha8Rng) -> usize;
}

/// Improves `design` by exchanges within its columns, `budget.iterations`
/// steps long. The search itself runs on one thread, sums over all pairs on
/// the current rayon pool; the bits depend on the arguments alone.
///
/// The design returned is the best one met by the full formula, at worst the
/// one given; with [`Criterion::Maximin`] its minimum distance is not less
/// than the one given either. Every column keeps its values, so a Latin
/// hypercube stays one.
pub fn optimise(
    design: Design,
    criterion: Criterion,
    budget: Budget,
    seed: u64,
) -> (Design, OptimisationHistory) {
    let initial = evaluate(&design, criterion);
    improve(design, initial, criterion, budget, seed)
}

/// [`optimise`] for a design whose criterion is known to be `initial`.
fn improve(
    design: Design,
    initial: f64,
    criterion: Criterion,
    budget: Budget,
    seed: u64,
) -> (Design, OptimisationHistory) {
    let mut search = Search {
        rng: stream(seed, Purpose::Optimiser, 0),
        n: design.len(),
        dims: design.dims(),
        exchanges: Vec::new(),
        best: (0, initial),
        trace: vec![(0, initial)],
    };
    // One point, or one column, has a single arrangement.
    let worthwhile = search.n > 1 && search.dims > 1;
    let iterations = if worthwhile { budget.iterations } else { 0 };
    if iterations > 0 {
        match criterion {
            Criterion::CentredDiscrepancy => {
                search.run(Discrepancy::new(&design, initial), iterations);
            }
            Criterion::Maximin => search.run(Repulsion::new(&design), iterations),
        }
    }
    let found = search.best_of(&design);
    let value = evaluate(&found, criterion);
    let kept = value < initial && !lost_distance(&design, &found, criterion);
    let history = OptimisationHistory {
        criterion,
        initial,
        best: if kept { value } else { initial },
        tried: iterations,
        exchanged: search.exchanges.len(),
        trace: search.trace,
    };
    (if kept { found } else { design }, history)
}

impl LatinHypercube {
    /// A Latin hypercube of this n, m, seed and placement that is good at
    /// `criterion`: the better of [`design`](Self::design) and
    /// [`lattice`](Self::lattice), then [`optimise`]d.
    ///
    /// # Errors
    /// As for [`design`](Self::design).
    pub fn optimised(
        &self,
        criterion: Criterion,
        budget: Budget,
    ) -> Result<(Design, OptimisationHistory), LhsError> {
        let valued = |design| {
            let value = evaluate(&design, criterion);
            (design, value)
        };
        let random = valued(self.design()?);
        let lattice = valued(self.lattice(criterion)?);
        let (start, initial) = if lattice.1 < random.1 {
            lattice
        } else {
            random
        };
        Ok(improve(start, initial, criterion, budget, self.seed()))
    }
}

fn evaluate(design: &Design, criterion: Criterion) -> f64 {
    match criterion {
        Criterion::CentredDiscrepancy => centred_discrepancy(design),
        Criterion::Maximin => phi_p(design, MAXIMIN_P),
    }
}

fn lost_distance(before: &Design, after: &Design, criterion: Criterion) -> bool {
    criterion == Criterion::Maximin && minimum_distance(after) < minimum_distance(before)
}

/// The state of one optimisation, apart from the objective's.
struct Search {
    rng: ChaCha8Rng,
    n: usize,
    dims: usize,
    /// (i, j, column), in order.
    exchanges: Vec<(usize, usize, usize)>,
    /// Exchanges made and criterion at the best design so far.
    best: (usize, f64),
    trace: Vec<(usize, f64)>,
}

impl Search {
    fn run(&mut self, mut objective: impl Objective, iterations: usize) {
        let schedule = Schedule::new(self.n, iterations);
        let mut size = 0.0;
        let mut changes = vec![0.0; self.dims];
        let mut least = objective.sum();
        for step in 0..iterations {
            if step == schedule.descent {
                size = self.typical_change(&mut objective);
            }
            let (i, j) = self.pair(&objective);
            objective.changes(i, j, &mut changes);
            let (dim, change) = smallest(&changes);
            if change < size * schedule.threshold(step) {
                objective.exchange(i, j, dim, change);
                self.exchanges.push((i, j, dim));
                if objective.sum() < least {
                    least = objective.sum();
                    // A gain within rounding must not show as a loss.
                    let value = objective.criterion(least).min(self.best.1);
                    self.best = (self.exchanges.len(), value);
                }
            }
            if (step + 1) % iterations.div_ceil(100) == 0 || step + 1 == iterations {
                self.trace.push((step + 1, self.best.1));
            }
        }
    }

    /// Two different points.
    fn pair(&mut self, objective: &impl Objective) -> (usize, usize) {
        let i = objective.pick(&mut self.rng);
        let j = below(&mut self.rng, self.n as u64 - 1) as usize;
        (i, if j < i { j } else { j + 1 })
    }

    /// The size of the change that a trial typically makes: the median of 33.
    fn typical_change(&mut self, objective: &mut impl Objective) -> f64 {
        let mut changes = vec![0.0; self.dims];
        let mut sizes = [0.0; 33];
        for size in &mut sizes {
            let (i, j) = self.pair(objective);
            objective.changes(i, j, &mut changes);
            *size = changes[0].abs();
        }
        sizes.sort_by(f64::total_cmp);
        sizes[16]
    }

    /// `start` with the exchanges up to the best state made.
    fn best_of(&self, start: &Design) -> Design {
        let mut values = start.values().to_vec();
        for &(i, j, dim) in &self.exchanges[..self.best.0] {
            values.swap(i * self.dims + dim, j * self.dims + dim);
        }
        Design::from_valid(self.dims, values)
    }
}

/// Thresholds in units of a typical change. After a first tenth that only
/// descends, they fall to zero in each of several equal rounds, and stay there
/// for the last fifth of it; a round but the first starts with n exchanges
/// whatever they cost. The numbers were chosen by trial on designs of 5 to 100
/// points: large thresholds and many rounds pay only when each pair of points
/// comes up often; when it does not come up at all, going straight down is
/// best.
struct Schedule {
    first: f64,
    descent: usize,
    round: usize,
    shake: usize,
}

impl Schedule {
    fn new(n: usize, iterations: usize) -> Self {
        let per_pair = iterations as f64 / (n as f64 * n as f64);
        let rounds = (per_pair / 20.0).clamp(1.0, 10.0) as usize;
        let first = if per_pair < 1.0 {
            0.0
        } else {
            per_pair / 250.0
        };
        let descent = iterations / 10;
        Self {
            first: first.min(0.5),
            descent,
            round: (iterations - descent).div_ceil(rounds),
            shake: n,
        }
    }

    fn threshold(&self, step: usize) -> f64 {
        let Some(step) = step.checked_sub(self.descent) else {
            return 0.0;
        };
        let (round, step) = (step / self.round, step % self.round);
        if round > 0 && step < self.shake {
            return f64::INFINITY;
        }
        let done = step as f64 / self.round as f64;
        self.first * (1.0 - 1.25 * done).max(0.0)
    }
}

fn smallest(changes: &[f64]) -> (usize, f64) {
    let first = (0, f64::INFINITY);
    let lower = |best: (usize, f64), (dim, &change)| {
        if change < best.1 { (dim, change) } else { best }
    };
    changes.iter().enumerate().fold(first, lower)
}
