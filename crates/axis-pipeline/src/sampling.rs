//! One-cycle samples over a Latin hypercube: Section 4.2.

use axis_sim::{Axis, CycleInput, OneCycle, SampleRanges, ValueRange};
use lhs::{LatinHypercube, Marginal, Uniform};
use rayon::prelude::*;

use crate::PipelineError;

/// How the speed is spread over its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpeedDensity {
    /// Evenly, as in the paper.
    Uniform,
    /// The denser, the nearer to zero: `v = s sinh(c u)` with u even over
    /// [−1, 1] and c such that the ends of the range are met.
    ///
    /// All that one cycle has beyond its linear map is friction near zero
    /// speed (some Stribeck speeds wide, in a range that is a hundred times
    /// wider), so that is where samples teach something.
    ///
    /// Cycles in which the table would reverse (|v| below |a|T, at most
    /// 0.1 mm/s over Table 5, one even sample in 13 000) begin one cycle's
    /// change of speed earlier instead: friction jumps there, up to twenty
    /// times what it does elsewhere, and a handful of such samples would draw
    /// the whole fit to themselves.
    NearZero {
        /// Speed s below which the density is even, m/s.
        scale: f64,
    },
}

impl SpeedDensity {
    /// Dense below 3 mm/s: where the friction of the paper's axis falls, whose Stribeck speed is
    /// 4.3 mm/s.
    pub const NEAR_ZERO: Self = Self::NearZero { scale: 3e-3 };
}

/// Which samples to draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplePlan {
    /// How many.
    pub count: usize,
    /// Seed of the design.
    pub seed: u64,
    /// Spread of the speed.
    pub density: SpeedDensity,
}

/// Samples: inputs and what one cycle made of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SampleSet {
    /// State and command at `t_k`.
    pub inputs: Vec<CycleInput>,
    /// S(k+1) − S(k), m.
    pub increments: Vec<f64>,
}

/// Draws and simulates samples; every row can be had alone.
pub struct Sampler {
    cycle: OneCycle,
    design: LatinHypercube,
    marginals: [Box<dyn Marginal>; 4],
    keep_direction: bool,
}

impl Sampler {
    /// Prepares a plan over the axis' sample ranges.
    ///
    /// # Errors
    /// [`PipelineError`] if the plan has no sample or the axis cannot be
    /// set up.
    pub fn new(axis: &Axis, plan: &SamplePlan) -> Result<Self, PipelineError> {
        let uniform = |range: ValueRange| -> Result<Box<dyn Marginal>, PipelineError> {
            Ok(Box::new(Uniform::new(range.least, range.most)?))
        };
        let ranges = ranges(axis)?;
        let speed: Box<dyn Marginal> = match plan.density {
            SpeedDensity::Uniform => uniform(ranges.speed)?,
            SpeedDensity::NearZero { scale } => Box::new(near_zero(ranges.speed, scale)),
        };
        Ok(Self {
            keep_direction: plan.density != SpeedDensity::Uniform,
            cycle: OneCycle::new(axis)?,
            design: LatinHypercube::new(plan.count, 4, plan.seed)?,
            marginals: [
                uniform(ranges.position)?,
                speed,
                uniform(ranges.acceleration)?,
                uniform(ranges.effort)?,
            ],
        })
    }

    /// Number of samples.
    pub fn count(&self) -> usize {
        self.design.len()
    }

    /// Sample `row`, from 0.
    ///
    /// # Errors
    /// [`PipelineError::Design`] if there are not as many rows,
    /// [`PipelineError::Setup`] if the cycle cannot be simulated.
    pub fn sample(&self, row: usize) -> Result<(CycleInput, f64), PipelineError> {
        let mut cell = [0.0; 4];
        self.design.row(row, &mut cell)?;
        let value = |i: usize| self.marginals[i].inverse_cdf(cell[i]);
        let mut input = CycleInput {
            position: value(0),
            speed: value(1),
            acceleration: value(2),
            command: value(3),
        };
        let change = input.acceleration * self.cycle.period();
        if self.keep_direction && input.speed * (input.speed + change) < 0.0 {
            input.speed -= change;
        }
        Ok((input, self.cycle.increment(&input)?))
    }

    /// A range of rows, in order, on all threads.
    ///
    /// # Errors
    /// That of the first row that cannot be simulated.
    pub fn rows(&self, rows: std::ops::Range<usize>) -> Result<SampleSet, PipelineError> {
        let simulated: Vec<_> = rows
            .into_par_iter()
            .with_min_len(64)
            .map(|row| self.sample(row))
            .collect();
        let samples = simulated.into_iter().collect::<Result<Vec<_>, _>>()?;
        let (inputs, increments) = samples.into_iter().unzip();
        Ok(SampleSet { inputs, increments })
    }

    /// All samples.
    ///
    /// # Errors
    /// As [`Sampler::rows`].
    pub fn all(&self) -> Result<SampleSet, PipelineError> {
        self.rows(0..self.count())
    }
}

/// The ranges of an axis' samples.
///
/// # Errors
/// [`PipelineError::NoSampleRanges`].
pub fn ranges(axis: &Axis) -> Result<SampleRanges, PipelineError> {
    axis.samples.ok_or(PipelineError::NoSampleRanges)
}

/// The inverse CDF of [`SpeedDensity::NearZero`].
fn near_zero(range: ValueRange, scale: f64) -> impl Fn(f64) -> f64 + Send + Sync {
    let (low, high) = ((range.least / scale).asinh(), (range.most / scale).asinh());
    move |p: f64| {
        let speed = scale * (low + p * (high - low)).sinh();
        speed.clamp(range.least, range.most)
    }
}
