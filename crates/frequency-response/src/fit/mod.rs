//! Poles, residues and a delay of a measured response.
//!
//! ```text
//! G = e^{−jωτ} Σ c_i/(jω − p_i)                                  input not held
//! G = e^{−jωτ} Σ c_i (e^{p_i T} − 1)/p_i/(z − e^{p_i T})         input held over a sample T, z = e^{jωT}
//! ```
//!
//! The second is exact for samples of a machine behind a zero-order hold (K. J. Åström, B. Wittenmark,
//! Computer-Controlled Systems, chapter 2: each mode by itself). It is computed in δ = (z − 1)/T, which tends to
//! jω for short samples. A delay that is not of whole samples counts by its phase.
//!
//! Poles are found by vector fitting (B. Gustavsen, A. Semlyen, IEEE Transactions on Power Delivery 14
//! (1999) 1052–1061, doi:10.1109/61.772353) for several delays and orders, then refined together with the delay
//! by weighted least squares, each line by its own deviation. The order has the least of Schwarz' criterion.

mod refine;
mod vector;

use std::f64::consts::TAU;

use axis_fourier::Complex;

use self::refine::Described;
pub(crate) use self::refine::Parameters;
use crate::error::{ResponseError, check};
use crate::estimate::FrequencyResponse;

/// A number and the standard deviation of its error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Uncertain {
    /// The number.
    pub value: f64,
    /// Standard deviation of its error.
    pub deviation: f64,
}

/// What is fitted, and to which lines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FitSettings {
    /// Lines from here to there, Hz.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored::band"))]
    pub band_hz: [f64; 2],
    /// Minimum coherence of a line that is used.
    pub coherence: f64,
    /// Most poles, 1 to 16; a mode has two.
    pub most_poles: usize,
    /// Greatest delay, s.
    pub most_delay_s: f64,
    /// Whether the input is held over a sample, as commands of digital controllers are. The poles are
    /// those of the machine behind the hold then, and the delay does not contain the hold's half sample.
    pub held: bool,
    /// Error of the response that its deviation does not know of, as a share of the magnitude: no line
    /// counts as more exact than that.
    pub floor: f64,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self {
            band_hz: [0.0, f64::INFINITY],
            coherence: 0.9,
            most_poles: 8,
            most_delay_s: 2e-3,
            held: true,
            floor: 2e-3,
        }
    }
}

impl FitSettings {
    fn check(&self) -> Result<(), ResponseError> {
        let poles = self.most_poles as f64;
        check("the coherence", self.coherence, [0.0, 1.0], "from 0 to 1")?;
        check("the number of poles", poles, [1.0, 16.0], "from 1 to 16")?;
        let delay = self.most_delay_s;
        check("the greatest delay", delay, [0.0, 1e6], "from 0 to 1e6 s")?;
        let floor = self.floor;
        check(
            "the floor of the error",
            floor,
            [1e-9, 1.0],
            "from 1e-9 to 1",
        )?;
        Ok(())
    }
}

/// A pair of complex poles.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FittedMode {
    /// Undamped natural frequency |p|/2π, Hz.
    pub frequency_hz: Uncertain,
    /// Damping ratio −Re p/|p|; negative of a pole that is not stable.
    pub damping: Uncertain,
    /// Residue of the pole with the positive imaginary part, output per input and s.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored::complex"))]
    pub residue: Complex<f64>,
    /// Standard deviation of the residue's error in each direction, the greater one.
    pub residue_deviation: f64,
}

/// A real pole.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FittedPole {
    /// −p, 1/s: the bandwidth of a lag, rad/s.
    pub rate: Uncertain,
    /// Residue, output per input and s.
    pub residue: Uncertain,
}

/// A rational function with a delay, fitted to a response.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::stored::StoredFit"))]
pub struct ModalFit {
    /// Pairs of complex poles, from low to high frequency; those of high damping among them, such as
    /// a current loop's.
    pub modes: Vec<FittedMode>,
    /// Real poles, the slowest first.
    pub poles: Vec<FittedPole>,
    /// Delay behind the hold, s.
    pub delay_s: Uncertain,
    /// Root mean square of the residual, in deviations of the lines: 1 for a fit as good as the lines
    /// are; above that the deviations of the parameters are widened by it.
    pub misfit: f64,
    /// Root mean square of the relative error over the lines.
    pub relative_error: f64,
    /// Lines that were fitted.
    pub lines: usize,
    /// Lowest and highest of them, Hz.
    pub band_hz: [f64; 2],
    pub(crate) plane: Plane,
    pub(crate) parameters: Parameters,
}

/// The plane in which poles are fitted, scaled to the highest line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(crate) struct Plane {
    /// The greatest ω, rad/s.
    pub scale: f64,
    /// Time for which the input is held, over 1/scale; 0 for none.
    pub held: f64,
}

/// One frequency: scaled jω, and its place in the plane of the poles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub s: Complex<f64>,
    pub x: Complex<f64>,
}

impl Plane {
    pub fn place(&self, frequency_hz: f64) -> Place {
        let s = Complex::new(0.0, TAU * frequency_hz / self.scale);
        Place { s, x: self.of(s) }
    }

    /// From a scaled s: (e^{sT} − 1)/T.
    pub fn of(&self, s: Complex<f64>) -> Complex<f64> {
        match self.held > 0.0 {
            true => ((s * self.held).exp() - 1.0) / self.held,
            false => s,
        }
    }

    /// Back from the plane, and the derivative there.
    pub fn back(&self, x: Complex<f64>) -> (Complex<f64>, Complex<f64>) {
        match self.held > 0.0 {
            true => {
                let w = x * self.held;
                let z = w + 1.0;
                // ln(1 + w)/w by its series where 1 + w has lost the digits of w.
                let s = match w.norm() < SMALL {
                    true => x * (ONE - w * (ONE / 2.0 - w / 3.0)),
                    false => z.ln() / self.held,
                };
                (s, z.inv())
            }
            false => (x, ONE),
        }
    }

    /// A pole that is not stable, mirrored: z to 1/z*.
    pub fn stable(&self, x: Complex<f64>) -> Complex<f64> {
        match self.held > 0.0 {
            true => {
                let z = x * self.held + 1.0;
                match z.norm() > 1.0 {
                    true => (z.conj().inv() - 1.0) / self.held,
                    false => x,
                }
            }
            false => Complex::new(-x.re.abs(), x.im),
        }
    }
}

/// The lines to fit, scaled.
pub(crate) struct Target {
    pub plane: Plane,
    pub places: Vec<Place>,
    pub value: Vec<Complex<f64>>,
    /// 1/deviation.
    pub weight: Vec<f64>,
}

impl ModalFit {
    /// Fits a response.
    ///
    /// # Errors
    /// [`ResponseError`] for settings that are not valid, too few lines, or no fit.
    pub fn of(response: &FrequencyResponse, settings: &FitSettings) -> Result<Self, ResponseError> {
        settings.check()?;
        let (target, frequencies) = target(response, settings);
        let (found, wanted) = (frequencies.len(), 2 * settings.most_poles + 4);
        if found < wanted {
            return Err(ResponseError::TooFewLines { found, wanted });
        }
        let best = best_order(&target, settings).ok_or(ResponseError::NoFit)?;
        let (parameters, squares) = best;
        let correlation = response.correlation;
        let fitted = refine::described(&target, &parameters, squares, correlation);
        let Described {
            modes,
            poles,
            delay,
        } = fitted.ok_or(ResponseError::NoFit)?;
        let errors = target.places.iter().zip(&target.value).map(|(at, value)| {
            let error = (parameters.at(at) - value).norm() / value.norm();
            error * error
        });
        Ok(Self {
            relative_error: (errors.sum::<f64>() / found as f64).sqrt(),
            modes,
            poles,
            delay_s: delay,
            misfit: (squares / (2.0 * found as f64)).sqrt(),
            lines: found,
            band_hz: [frequencies[0], frequencies[found - 1]],
            plane: target.plane,
            parameters,
        })
    }

    /// The first number of modes, poles and delay that is not that of the parameters, but for rounding.
    #[cfg(feature = "serde")]
    pub(crate) fn contradiction(&self) -> Option<f64> {
        const ROUNDING: f64 = 1e-9;
        let n = self.parameters.count();
        let none = nalgebra::DMatrix::zeros(n, n);
        let own = refine::described_with(&self.plane, &self.parameters, &none);
        let stated = Described::numbers(&self.modes, &self.poles, &self.delay_s);
        let own = Described::numbers(&own.modes, &own.poles, &own.delay);
        let is_same = |a: f64, b: f64| (a - b).abs() <= ROUNDING * a.abs().max(b.abs());
        let mut both = stated.into_iter().zip(own);
        both.find(|(a, b)| !is_same(*a, *b)).map(|(a, _)| a)
    }

    /// The fitted response at a frequency, Hz.
    #[must_use]
    pub fn at(&self, frequency_hz: f64) -> Complex<f64> {
        self.parameters.at(&self.plane.place(frequency_hz))
    }
}

const ONE: Complex<f64> = Complex::new(1.0, 0.0);
/// Size below which two terms of a logarithm's series are exact to 1e-11.
const SMALL: f64 = 1e-5;

fn target(response: &FrequencyResponse, settings: &FitSettings) -> (Target, Vec<f64>) {
    let mut lines = Vec::new();
    for line in response.trusted(settings.band_hz, settings.coherence) {
        let size = line.value.norm();
        let deviation = line.deviation.max(settings.floor * size);
        if line.frequency_hz > 0.0 && deviation > 0.0 && size.is_finite() {
            lines.push((line.frequency_hz, line.value, 1.0 / deviation));
        }
    }
    let scale = TAU * lines.last().map_or(1.0, |line| line.0);
    let plane = Plane {
        scale,
        held: match settings.held {
            true => response.period_s * scale,
            false => 0.0,
        },
    };
    let target = Target {
        plane,
        places: lines.iter().map(|line| plane.place(line.0)).collect(),
        value: lines.iter().map(|line| line.1).collect(),
        weight: lines.iter().map(|line| line.2).collect(),
    };
    (target, lines.into_iter().map(|line| line.0).collect())
}

/// The unknowns of the order with the least of Schwarz' criterion (G. Schwarz, Annals of Statistics 6
/// (1978) 461–464, doi:10.1214/aos/1176344136), for errors of unknown size, and their weighted squares.
///
/// An order whose delay the lines do not determine ([`VAGUE`]) is taken only if there is no other:
/// one of its poles lies so far above the lines that it does what a delay does, and residues with one and the other grow
/// against each other without end.
fn best_order(target: &Target, settings: &FitSettings) -> Option<(Parameters, f64)> {
    let delays = delays(settings.most_delay_s * target.plane.scale);
    let mut best: Option<(Standing, Parameters, f64)> = None;
    for order in 1..=settings.most_poles {
        // Once a fit is near, it knows the delay: another order changes it by little.
        let near = best.as_ref().map(|(_, parameters, _)| parameters.delay());
        let tried: Vec<f64> = match near.filter(|_| order > SEARCHED) {
            Some(near) => vec![0.0, near.max(0.0)],
            None => delays.clone(),
        };
        let fits = tried.iter().filter_map(|delay| {
            let poles = vector::poles(target, order, *delay)?;
            let start = vector::start(target, &poles, *delay)?;
            Some(refine::refined(target, start))
        });
        let least = fits.min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((parameters, squares)) = least else {
            continue;
        };
        let numbers = 2.0 * target.places.len() as f64;
        let unknown = parameters.count() as f64;
        // Below what the floor allows no order is better than another.
        let mean = (squares / numbers).max(1e-6);
        let criterion = numbers * mean.ln() + unknown * numbers.ln();
        let standing = Standing {
            is_vague: refine::delay_deviation(target, &parameters).is_none_or(|d| d > VAGUE),
            criterion,
        };
        if best
            .as_ref()
            .is_none_or(|(least, ..)| standing.is_before(least))
        {
            best = Some((standing, parameters, squares));
        }
    }
    best.map(|(_, parameters, squares)| (parameters, squares))
}

/// Deviation of a delay, in radians at the highest line, above which the lines do not determine it: so many per cent of
/// a residue are its direction alone then.
const VAGUE: f64 = 0.1;

/// How good an order is.
#[derive(Clone, Copy, Debug)]
struct Standing {
    /// Whether the lines do not determine its delay.
    is_vague: bool,
    criterion: f64,
}

impl Standing {
    fn is_before(&self, other: &Self) -> bool {
        match self.is_vague == other.is_vague {
            true => self.criterion < other.criterion,
            false => other.is_vague,
        }
    }
}

/// Most poles for which all delays are tried.
const SEARCHED: usize = 4;

/// Delays from which a fit starts: a radian apart at the highest line, 8 at most.
fn delays(most: f64) -> Vec<f64> {
    let count = (most.ceil() as usize).clamp(1, 8);
    (0..=count)
        .map(|i| most * i as f64 / count as f64)
        .collect()
}
