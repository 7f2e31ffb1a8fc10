//! Any law of the family from records of motion and force.

use nalgebra::SMatrix;

use super::error::{FrictionIdentifyError, check_finite, check_positive};
use super::estimate::ParameterEstimate;
use super::least_squares::{FitOutcome, Minimum, Problem, dot, square};
use super::numbers::{Identifiable, Number, UnknownNumbers};
use super::presliding::{MeasuredMotion, central_speeds};
use super::series::correlation_time;

/// The most numbers that a law may have, its offset with them.
const MOST: usize = 32;

/// State of the contact at the first sample of a record, by what it did before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BeforeRecord {
    /// Nothing: its springs are unloaded.
    #[default]
    Unloaded,
    /// It slid forward and came to rest.
    Forward,
    /// It slid backward and came to rest.
    Backward,
}

/// Motion and force, sampled at equal steps: constant speeds, small motions about a
/// standstill, reversals, or all of these.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionRecord<'a> {
    /// Time between samples, s.
    pub time_step: f64,
    /// The motion, one value a sample, m/s or m (rad/s or rad).
    pub motion: MeasuredMotion<'a>,
    /// The friction, N or N·m, one value a sample.
    pub force: &'a [f64],
    /// Standard deviation of the force's noise, N or N·m, or any number in the same
    /// proportion to the other records'; 1 of a single record.
    pub noise: f64,
    /// What the contact did before.
    pub before: BeforeRecord,
    /// So many samples at the beginning are simulated, but not compared: a motion that slides
    /// in them makes what was before it forgotten.
    pub skip: usize,
}

/// A number of the law and how well the records know it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LawEstimate {
    /// As the law's parameters call it.
    pub name: &'static str,
    /// Which of several of that name; 0 of one.
    pub element: usize,
    /// Value and standard error, in the unit of the number.
    pub estimate: ParameterEstimate,
    /// The 95 % interval, by Student's distribution.
    pub interval: [f64; 2],
}

/// Result of [`identify_law`].
#[derive(Debug, Clone, PartialEq)]
pub struct LawFit<L> {
    /// The law that fits best.
    pub law: L,
    /// What was unknown of it, in the order of its parameters.
    pub estimates: Vec<LawEstimate>,
    /// The constant force, N or N·m; 0 with a standard error of 0 where it was known.
    pub offset: ParameterEstimate,
    /// RMS of the residuals, each over its record's `noise`.
    pub residual_rms: f64,
    /// How many samples as one independent one tell as much: 1 of white residuals. More says
    /// that the noise is slow or the law is not the contact's.
    pub correlation_time: f64,
    /// Samples compared.
    pub samples: usize,
    /// How the fit ended.
    pub outcome: FitOutcome,
}

impl<L> LawFit<L> {
    /// The estimate of a number that was unknown.
    #[must_use]
    pub fn estimate(&self, name: &str, element: usize) -> Option<&LawEstimate> {
        self.estimates
            .iter()
            .find(|e| e.name == name && e.element == element)
    }
}

/// Fits a law by the output error: it is simulated along the measured motion with its own
/// steps, and its force compared with the measured one.
///
/// `start` has the numbers that are known, and the others roughly: the stiffness within a
/// factor of 30 and the levels within 2, where a grid finds the best, Stribeck speed and shape
/// nearer. Levenberg–Marquardt on logarithms follows. Levels and stiffnesses are always
/// unknown, the rest as `unknown` says.
///
/// The standard errors are those of the linearised fit, with the residuals' own variance and
/// correlation time. They assume that the law is the contact's and the motion exact.
///
/// # Errors
/// [`FrictionIdentifyError`]: no record, channels of unequal length, fewer than 32 samples to
/// compare, a number that is not finite, no motion, a law of more than 31 numbers, or a number
/// that the records leave open.
///
/// ```
/// use lugre::identify::{BeforeRecord, FrictionRecord, MeasuredMotion, UnknownNumbers, identify_law};
/// use lugre::{BristleParameters, Dahl, DahlOnset, FrictionLaw, SteadyState};
///
/// let dahl = |level, stiffness, exponent| Dahl::new(BristleParameters {
///     steady: SteadyState::coulomb(level),
///     stiffness,
///     damping: 0.0,
///     onset: DahlOnset { exponent },
/// });
/// let (truth, h) = (dahl(60.0, 4e6, 1.5)?, 1e-3);
/// let speed: Vec<f64> = (0..500).map(|k| 2e-3 * (0.05 * k as f64).sin()).collect();
/// let (mut z, mut force) = (0.0, vec![0.0]);
/// for v in speed.windows(2) {
///     z = truth.step(z, v[0], v[1], h);
///     force.push(truth.force(&z, v[1]));
/// }
/// let record = FrictionRecord {
///     time_step: h,
///     motion: MeasuredMotion::Speed(&speed),
///     force: &force,
///     noise: 1.0,
///     before: BeforeRecord::Unloaded,
///     skip: 0,
/// };
/// let unknown = UnknownNumbers { stribeck: false, viscous_terms: 0, ..UnknownNumbers::default() };
/// let fit = identify_law(&dahl(40.0, 1e6, 1.0)?, &[record], &unknown)?;
/// assert!((fit.law.parameters().onset.exponent - 1.5).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn identify_law<L: Identifiable>(
    start: &L,
    records: &[FrictionRecord<'_>],
    unknown: &UnknownNumbers,
) -> Result<LawFit<L>, FrictionIdentifyError> {
    let trial = Trial::new(start, records, unknown)?;
    let x = trial.search();
    let residuals = |x: &[f64; MOST], out: &mut [f64]| trial.residuals(x, out);
    let mut lower = [f64::NEG_INFINITY; MOST];
    let mut free = [false; MOST];
    for (i, number) in trial.numbers.iter().enumerate() {
        lower[i] = number.lower();
        free[i] = number.free;
    }
    free[trial.numbers.len()] = unknown.offset;
    let problem = Problem {
        residuals: &residuals,
        count: trial.samples,
        scale: [1.0; MOST],
        lower,
        free,
    };
    let minimum = problem.minimise(x);
    trial.report(&minimum, &free)
}

/// A record with its speeds.
struct Run<'a> {
    record: FrictionRecord<'a>,
    speeds: Vec<f64>,
}

struct Trial<'a, L> {
    start: &'a L,
    unknown: &'a UnknownNumbers,
    runs: Vec<Run<'a>>,
    numbers: Vec<Number>,
    /// Size of the offset, N or N·m.
    level: f64,
    samples: usize,
}

impl<'a, L: Identifiable> Trial<'a, L> {
    fn new(
        start: &'a L,
        records: &[FrictionRecord<'a>],
        unknown: &'a UnknownNumbers,
    ) -> Result<Self, FrictionIdentifyError> {
        const NEEDED: usize = 32;
        let runs = records
            .iter()
            .map(|record| run(record))
            .collect::<Result<Vec<_>, _>>()?;
        let samples = runs
            .iter()
            .map(|run| run.speeds.len().saturating_sub(run.record.skip))
            .sum();
        let numbers = |fastest| start.numbers(unknown, fastest);
        let fitted = numbers(1.0).iter().filter(|number| number.free).count();
        let needed = NEEDED.max(2 * fitted);
        if samples < needed {
            return Err(FrictionIdentifyError::TooFewSamples {
                found: samples,
                needed,
            });
        }
        let speeds = runs.iter().flat_map(|run| &run.speeds);
        let fastest = speeds.fold(0.0, |a: f64, v| a.max(v.abs()));
        if fastest == 0.0 {
            return Err(FrictionIdentifyError::NoMotion);
        }
        let numbers = numbers(fastest);
        if numbers.len() >= MOST {
            return Err(FrictionIdentifyError::TooManyNumbers {
                found: numbers.len(),
                most: MOST - 1,
            });
        }
        let level = numbers.first().map_or(1.0, |number| number.value);
        Ok(Self {
            start,
            unknown,
            runs,
            numbers,
            level,
            samples,
        })
    }

    fn coordinates(&self) -> [f64; MOST] {
        let mut x = [0.0; MOST];
        let mut before = 1.0;
        for (x, number) in x.iter_mut().zip(&self.numbers) {
            *x = number.coordinate(before);
            before = number.value;
        }
        x
    }

    fn law(&self, x: &[f64; MOST]) -> Option<L> {
        let mut before = 1.0;
        let mut values = Vec::with_capacity(MOST);
        for (number, &x) in self.numbers.iter().zip(x) {
            // What is known keeps its bits, but for a break-away level above one that is not.
            let bound = number.kind == super::numbers::NumberKind::Above;
            before = if number.free || bound {
                number.at(x, before)
            } else {
                number.value
            };
            values.push(before);
        }
        self.start.with(self.unknown, &values)
    }

    fn residuals(&self, x: &[f64; MOST], out: &mut [f64]) {
        let Some(law) = self.law(x) else {
            out.fill(f64::MAX.sqrt());
            return;
        };
        let offset = self.level * x[self.numbers.len()];
        let mut places = out.iter_mut();
        for Run { record, speeds } in &self.runs {
            let slid = law_after(&law, record.before);
            let mut state = slid;
            for (k, &v) in speeds.iter().enumerate() {
                if k > 0 {
                    state = law.step(state, speeds[k - 1], v, record.time_step);
                }
                if k >= record.skip
                    && let Some(place) = places.next()
                {
                    *place = (law.force(&state, v) + offset - record.force[k]) / record.noise;
                }
            }
        }
    }

    /// The best of a grid of factors on levels and stiffnesses. Positive numbers enter by
    /// their logarithm, so that a factor is a sum.
    fn search(&self) -> [f64; MOST] {
        let begin = self.coordinates();
        let mut out = vec![0.0; self.samples];
        let (mut best, mut least) = (begin, f64::INFINITY);
        for level in [1.0, 0.5, 0.7, 1.4, 2.0_f64] {
            for stiffness in [1.0, 0.03, 0.1, 0.3, 0.6, 1.7, 3.0, 10.0, 30.0_f64] {
                let mut x = begin;
                for (x, number) in x.iter_mut().zip(&self.numbers) {
                    *x += match number.name {
                        "forward.coulomb" | "backward.coulomb" if number.free => level.ln(),
                        "stiffness" => stiffness.ln(),
                        _ => 0.0,
                    };
                }
                self.residuals(&x, &mut out);
                let cost = square(&out);
                if cost < least {
                    (best, least) = (x, cost);
                }
            }
        }
        best
    }

    fn values(&self, law: &L) -> Vec<f64> {
        let numbers = law.numbers(self.unknown, 1.0);
        numbers.iter().map(|number| number.value).collect()
    }

    fn report(
        &self,
        minimum: &Minimum<MOST>,
        free: &[bool; MOST],
    ) -> Result<LawFit<L>, FrictionIdentifyError> {
        let x = &minimum.x;
        let law = self.law(x).ok_or(FrictionIdentifyError::NoMotion)?;
        let fitted = free.iter().filter(|free| **free).count();
        let degrees = (self.samples - fitted) as f64;
        let squares = square(&minimum.residuals);
        let tau = self.correlation(&minimum.residuals);
        let inverse = minimum
            .inverse
            .filter(|m| m.diagonal().iter().all(|v| v.is_finite() && *v >= 0.0));
        let Some(inverse) = inverse else {
            return Err(self.open(&minimum.jacobian, free));
        };
        let covariance = inverse * (squares / degrees * tau);
        // From coordinates to the numbers themselves.
        let values = self.values(&law);
        let slopes = self.slopes(x, free);
        let student = student(degrees / tau);
        let mut estimates = Vec::new();
        for (i, number) in self.numbers.iter().enumerate() {
            let error = spread(&covariance, &slopes, i);
            let last = number.name == "shares" && self.unknown.shape;
            if !(number.free || last) {
                continue;
            }
            if !(error.is_finite() && (number.lower().is_finite() || error < values[i])) {
                return Err(FrictionIdentifyError::NotIdentifiable {
                    parameter: number.name,
                    value: values[i],
                    standard_error: error,
                });
            }
            estimates.push(LawEstimate {
                name: number.name,
                element: number.element,
                estimate: ParameterEstimate {
                    value: values[i],
                    standard_error: error,
                },
                interval: [values[i] - student * error, values[i] + student * error],
            });
        }
        let n = self.numbers.len();
        Ok(LawFit {
            law,
            estimates,
            offset: ParameterEstimate {
                value: self.level * x[n],
                standard_error: self.level * covariance[(n, n)].max(0.0).sqrt(),
            },
            residual_rms: (squares / self.samples as f64).sqrt(),
            correlation_time: tau,
            samples: self.samples,
            outcome: minimum.outcome,
        })
    }

    /// Change of each number with each coordinate.
    fn slopes(&self, x: &[f64; MOST], free: &[bool; MOST]) -> Vec<Vec<f64>> {
        const STEP: f64 = 1e-5;
        let n = self.numbers.len();
        (0..n)
            .map(|i| {
                let (mut up, mut down) = (*x, *x);
                up[i] += STEP;
                down[i] -= STEP;
                match (free[i], self.law(&up), self.law(&down)) {
                    (true, Some(up), Some(down)) => {
                        let ends = self.values(&up).into_iter().zip(self.values(&down));
                        ends.map(|(a, b)| (a - b) / (2.0 * STEP)).collect()
                    }
                    _ => vec![0.0; n],
                }
            })
            .collect()
    }

    /// Mean of the records' correlation times.
    fn correlation(&self, residuals: &[f64]) -> f64 {
        let (mut sum, mut from) = (0.0, 0);
        for Run { record, speeds } in &self.runs {
            let count = speeds.len().saturating_sub(record.skip);
            sum += count as f64 * correlation_time(&residuals[from..from + count]);
            from += count;
        }
        sum / self.samples as f64
    }

    /// What the records leave open: the number that changes the force least.
    fn open(&self, jacobian: &[Vec<f64>], free: &[bool; MOST]) -> FrictionIdentifyError {
        let size = |i: usize| dot(&jacobian[i], &jacobian[i]);
        let numbers = (0..self.numbers.len()).filter(|&i| free[i]);
        let least = numbers.min_by(|&a, &b| size(a).total_cmp(&size(b)));
        let number = least.and_then(|i| self.numbers.get(i));
        FrictionIdentifyError::NotIdentifiable {
            parameter: number.map_or("forward.coulomb", |number| number.name),
            value: number.map_or(f64::NAN, |number| number.value),
            standard_error: f64::INFINITY,
        }
    }
}

fn law_after<L: Identifiable>(law: &L, before: BeforeRecord) -> L::State {
    // As slow as a sliding contact can be: the bristles are at the break-away level.
    match before {
        BeforeRecord::Unloaded => L::State::default(),
        BeforeRecord::Forward => law.settled(f64::MIN_POSITIVE),
        BeforeRecord::Backward => law.settled(-f64::MIN_POSITIVE),
    }
}

/// Standard error of a number.
fn spread(covariance: &SMatrix<f64, MOST, MOST>, slopes: &[Vec<f64>], number: usize) -> f64 {
    let mut sum = 0.0;
    for (i, a) in slopes.iter().enumerate() {
        for (j, b) in slopes.iter().enumerate() {
            sum += a[number] * covariance[(i, j)] * b[number];
        }
    }
    sum.max(0.0).sqrt()
}

/// The 97.5 % quantile of Student's distribution (M. Abramowitz and I. Stegun, 26.7.5).
fn student(degrees: f64) -> f64 {
    const Z: f64 = 1.959_963_984_540_054;
    let n = degrees.max(1.0);
    let first = (Z.powi(3) + Z) / 4.0;
    let second = (5.0 * Z.powi(5) + 16.0 * Z.powi(3) + 3.0 * Z) / 96.0;
    Z + first / n + second / (n * n)
}

fn run<'a>(record: &FrictionRecord<'a>) -> Result<Run<'a>, FrictionIdentifyError> {
    check_positive("time_step", record.time_step)?;
    check_positive("noise", record.noise)?;
    let (name, motion) = match record.motion {
        MeasuredMotion::Speed(v) => ("speed", v),
        MeasuredMotion::Displacement(x) => ("displacement", x),
    };
    if motion.len() != record.force.len() {
        return Err(FrictionIdentifyError::LengthMismatch {
            motion: motion.len(),
            torque: record.force.len(),
        });
    }
    const NEEDED: usize = 3;
    if motion.len() < NEEDED {
        return Err(FrictionIdentifyError::TooFewSamples {
            found: motion.len(),
            needed: NEEDED,
        });
    }
    check_finite(name, motion)?;
    check_finite("force", record.force)?;
    let speeds = match record.motion {
        MeasuredMotion::Speed(v) => v.to_vec(),
        MeasuredMotion::Displacement(x) => central_speeds(x, record.time_step),
    };
    check_finite("speed", &speeds)?;
    Ok(Run {
        record: *record,
        speeds,
    })
}
