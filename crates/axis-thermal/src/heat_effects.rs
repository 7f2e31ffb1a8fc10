//! Whether growth, and friction that falls with warmth, explain a log of hours as states of the thermal network.
//!
//! Readings are compared under four assumptions: each of the two effects there or not. With g the size of the growth,
//! c_v, c_d, p the falls of viscous and dry friction and the rise of the preload, f_d, f_v the levels of dry and
//! viscous friction at the reference temperature, and factors f_k on what nobody knows of the network
//!
//! ```text
//! D = Σ ((g δ(x, t) − δ_log)/σ)² + Σ (tᵢ/t̄) ((P/P_log − 1)/ρ)² + Σ ((T − T_log)/τ)² + Σ (θ_k/s_k)²
//! ```
//!
//! is least over all θ but those that the assumption sets to 0 (growth: g; warming: c_v, c_d, p). σ and ρ are those
//! that the residual shows with both effects there: its RMS, increased by √(n/(n − p)) for the p unknowns that its n readings
//! determine, and by √((1 + r)/(1 − r)) for its correlation r from reading to reading, as a machine whose laws are
//! others than the network's leaves a slow residual.
//!
//! An effect is named if without it D is greater by 25 or more on what is fitted and by 9 or more on what is not (five
//! and three standard deviations), if more than half of its gap there is gone with it, and if no drift, proportional to
//! time or to the distance travelled, does better (`rival_drift`).

use nalgebra::{DMatrix, DVector};

use crate::error::{ThermalError, check};
use crate::friction::TemperatureLaw;
use crate::growth_log::{FollowedLog, GrowthLog, GrowthStretch, usual_duration};
use crate::least_squares::{derivatives, least};
use crate::model::ThermalModel;
use crate::parameters::ThermalParameters;
use crate::residual_noise::{ResidualNoise, residual_noise};
use crate::unknown::ThermalUnknown;

/// A log, and how many of its first stretches are fitted; the others are held out.
#[derive(Clone, Debug)]
pub struct HeldLog {
    /// All of it.
    pub log: GrowthLog,
    /// Stretches that are fitted.
    pub fitted: usize,
}

/// The unknowns of the network, without the friction's falls.
const NETWORK: [ThermalUnknown; 14] = [
    ThermalUnknown::NutShare,
    ThermalUnknown::BearingsShare,
    ThermalUnknown::NutIntoScrew,
    ThermalUnknown::StillAir,
    ThermalUnknown::TurningAir,
    ThermalUnknown::FrontCapacity,
    ThermalUnknown::FrontToBed,
    ThermalUnknown::FrontToScrew,
    ThermalUnknown::RearToBed,
    ThermalUnknown::RearToScrew,
    ThermalUnknown::NutCapacity,
    ThermalUnknown::NutToScrew,
    ThermalUnknown::NutToTable,
    ThermalUnknown::TableCapacity,
];
pub(crate) const LEVELS: usize = NETWORK.len();
pub(crate) const GROWTH: usize = LEVELS + 2;
pub(crate) const FALLS: usize = GROWTH + 1;
/// Number of all unknowns.
const ALL: usize = FALLS + 3;

/// What falls of viscous and dry friction and the rise of the preload are counted in, 1/K.
pub(crate) const PER_KELVIN: [f64; 3] = [0.025, 0.005, 0.015];

/// Standard deviations of the unknowns before a log: about twofold for the network, 20 % for the friction's level,
/// 5 %/K, 1 %/K and 3 %/K for its falls; the growth's size is free.
fn prior(unknown: usize) -> f64 {
    match unknown {
        0..LEVELS => 0.7,
        LEVELS..GROWTH => 0.2,
        GROWTH => 1e3,
        _ => 2.0,
    }
}

/// Greatest logarithm of a factor on the network: twelvefold, so that a step cannot leave what numbers may be.
const FARTHEST: f64 = 2.5;
/// By which a temperature in the log and that of its body differ, K.
const TEMPERATURE: f64 = 0.5;
/// Most steps of a fit, and the part of D that a step is not worth taking for: evidence decides by 9 and more.
const STEPS: (u32, f64) = (30, 0.1);

/// Which of the two effects may act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Assumed {
    pub growth: bool,
    pub warming: bool,
}

/// Both.
pub(crate) const BOTH: Assumed = Assumed {
    growth: true,
    warming: true,
};

/// Standard deviations: growth in m, friction's power as a share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deviations {
    pub growth: f64,
    pub friction: f64,
}

/// A fit under one assumption, on all of the logs.
pub(crate) struct Fitted {
    /// All unknowns.
    pub at: DVector<f64>,
    /// D on what was fitted.
    pub deviance: f64,
    /// Readings beside the model with a growth of the size 1.
    pub followed: Vec<FollowedLog>,
}

impl Fitted {
    pub(crate) fn size(&self) -> f64 {
        self.at[GROWTH]
    }

    pub(crate) fn levels(&self) -> [f64; 2] {
        [0, 1].map(|i| self.at[LEVELS + i].exp())
    }

    /// Viscous and dry friction's fall, the preload's rise, 1/K.
    pub(crate) fn falls(&self) -> [f64; 3] {
        falls(&self.at)
    }
}

fn falls(at: &DVector<f64>) -> [f64; 3] {
    [0, 1, 2].map(|i| PER_KELVIN[i] * at[FALLS + i])
}

/// Readings that a model is compared with.
pub(crate) struct Problem<'a> {
    pub assumed: &'a ThermalParameters,
    pub logs: &'a [HeldLog],
    /// Whether logs show growth and the friction's power at all.
    pub shows: Assumed,
}

impl Problem<'_> {
    /// The unknowns that are free under an assumption.
    fn free(&self, assumed: Assumed) -> Vec<usize> {
        let is_free = |k: &usize| match *k {
            LEVELS..GROWTH => self.shows.warming,
            GROWTH => self.shows.growth && assumed.growth,
            FALLS.. => self.shows.warming && assumed.warming,
            _ => true,
        };
        (0..ALL).filter(is_free).collect()
    }

    /// The readings if friction fell as the file has it, the network as it was fitted.
    pub(crate) fn as_the_file_falls(
        &self,
        fitted: &Fitted,
    ) -> Result<Vec<FollowedLog>, ThermalError> {
        let mut at = fitted.at.clone();
        let file = self.begin(BOTH);
        at.rows_mut(FALLS, 3).copy_from(&file.rows(FALLS, 3));
        self.followed(&at, |held| held.log.stretches.len())
    }

    /// As the file has them, without the effects that are not assumed.
    fn begin(&self, assumed: Assumed) -> DVector<f64> {
        let mut at = DVector::zeros(ALL);
        at[GROWTH] = f64::from(u8::from(assumed.growth || !self.shows.growth));
        if assumed.warming || !self.shows.warming {
            let laws = &self.assumed.friction;
            let per_kelvin = [&laws.viscous, &laws.dry].map(|law| match law {
                TemperatureLaw::Constant => 0.0,
                TemperatureLaw::Exponential { per_kelvin }
                | TemperatureLaw::Linear { per_kelvin } => *per_kelvin,
            });
            let [viscous, dry] = per_kelvin;
            for (i, fall) in [viscous, dry, laws.preload_per_kelvin]
                .into_iter()
                .enumerate()
            {
                at[FALLS + i] = fall / PER_KELVIN[i];
            }
        }
        at
    }

    /// The thermal numbers of these unknowns.
    pub(crate) fn parameters(&self, at: &DVector<f64>) -> ThermalParameters {
        let mut parameters = self.assumed.clone();
        for (unknown, l) in NETWORK.iter().zip(at) {
            unknown.scale(&mut parameters, l.clamp(-FARTHEST, FARTHEST).exp());
        }
        let [viscous, dry, preload] = falls(at);
        let laws = &mut parameters.friction;
        laws.viscous = TemperatureLaw::Exponential {
            per_kelvin: viscous,
        };
        laws.dry = TemperatureLaw::Linear { per_kelvin: dry };
        laws.preload_per_kelvin = preload;
        parameters
    }

    fn followed(
        &self,
        at: &DVector<f64>,
        part: impl Fn(&HeldLog) -> usize,
    ) -> Result<Vec<FollowedLog>, ThermalError> {
        let model = ThermalModel::new(self.parameters(at))?;
        let levels = [0, 1].map(|i| at[LEVELS + i].exp());
        let one = |held: &HeldLog| {
            let stretches = held.log.stretches.iter().take(part(held));
            let levelled = stretches.map(|stretch| GrowthStretch {
                duty: stretch.duty.with_friction(levels),
                ..stretch.clone()
            });
            model.follow(&GrowthLog {
                stretches: levelled.collect(),
                ..held.log
            })
        };
        self.logs.iter().map(one).collect()
    }

    fn residuals(
        &self,
        at: &DVector<f64>,
        deviations: Deviations,
    ) -> Result<DVector<f64>, ThermalError> {
        let followed = self.followed(at, |held| held.fitted)?;
        let usual = usual_duration(&followed);
        let size = at[GROWTH];
        let growth = followed.iter().flat_map(|log| &log.growth);
        let growth = growth.map(|read| (size * read.predicted - read.found) / deviations.growth);
        let powers = followed.iter().flat_map(FollowedLog::powers);
        let powers = powers.map(|read| read.deviation(usual) / deviations.friction);
        let temperatures = followed.iter().flat_map(|log| &log.temperatures);
        let temperatures = temperatures.map(|(_, error)| error / TEMPERATURE);
        let priors = (0..ALL).map(|k| at[k] / prior(k));
        let all = growth.chain(powers).chain(temperatures).chain(priors);
        Ok(DVector::from_vec(all.collect()))
    }

    /// The same of the free unknowns, the others as they begin.
    fn of_free<'b>(
        &'b self,
        free: &'b [usize],
        begin: &'b DVector<f64>,
        deviations: Deviations,
    ) -> impl Fn(&DVector<f64>) -> Result<DVector<f64>, ThermalError> + 'b {
        move |at| self.residuals(&with(begin, free, at), deviations)
    }

    /// Fits under an assumption, from `from` on.
    pub(crate) fn fit(
        &self,
        assumed: Assumed,
        deviations: Deviations,
        from: Option<&Fitted>,
    ) -> Result<Fitted, ThermalError> {
        let free = self.free(assumed);
        let begin = self.begin(assumed);
        let from = from.map_or(&begin, |fitted| &fitted.at);
        let start = DVector::from_iterator(free.len(), free.iter().map(|k| from[*k]));
        let found = least(start, STEPS, self.of_free(&free, &begin, deviations))?;
        let at = with(&begin, &free, &found.at);
        Ok(Fitted {
            followed: self.followed(&at, |held| held.log.stretches.len())?,
            deviance: found.residuals.norm_squared(),
            at,
        })
    }

    /// Covariance of all unknowns (0 of those that are not free), and how many of them readings of growth and of the
    /// friction's power determine.
    pub(crate) fn covariance(
        &self,
        assumed: Assumed,
        fitted: &Fitted,
        deviations: Deviations,
    ) -> Result<(DMatrix<f64>, [f64; 2]), ThermalError> {
        let free = self.free(assumed);
        let begin = self.begin(assumed);
        let of = self.of_free(&free, &begin, deviations);
        let at = DVector::from_iterator(free.len(), free.iter().map(|k| fitted.at[*k]));
        let slopes = derivatives(&at, &of(&at)?, &of)?;
        // Priors make it regular.
        let small = slopes.tr_mul(&slopes).try_inverse();
        let small = small.unwrap_or_else(|| DMatrix::zeros(free.len(), free.len()));
        let mut whole = DMatrix::zeros(ALL, ALL);
        for (i, k) in free.iter().enumerate() {
            for (j, l) in free.iter().enumerate() {
                whole[(*k, *l)] = small[(i, j)];
            }
        }
        // The trace of what maps readings to fitted readings.
        let part = |from: usize, count: usize| {
            let rows = slopes.rows(from, count);
            (rows * &small).component_mul(&rows).sum()
        };
        let [growth, powers] = self.counts();
        Ok((whole, [part(0, growth), part(growth, powers)]))
    }

    /// Readings of growth and of the friction's power that are fitted.
    pub(crate) fn counts(&self) -> [usize; 2] {
        let mut counts = [0; 2];
        for held in self.logs {
            let part = held.log.first(held.fitted);
            counts[0] += part.comparisons();
            let powers = part.stretches.iter().filter_map(|s| s.friction);
            counts[1] += powers.filter(|power| *power > 0.0).count();
        }
        counts
    }

    /// Standard deviation of what `of` makes of the unknowns.
    pub(crate) fn spread(
        &self,
        fitted: &Fitted,
        covariance: &DMatrix<f64>,
        of: impl Fn(&DVector<f64>, &[FollowedLog]) -> f64,
    ) -> Result<f64, ThermalError> {
        let value = of(&fitted.at, &fitted.followed);
        let mut slopes = DVector::zeros(ALL);
        for k in 0..ALL {
            if covariance[(k, k)] > 0.0 {
                let step = crate::least_squares::DIFFERENCE;
                let mut moved = fitted.at.clone();
                moved[k] += step;
                let followed = self.followed(&moved, |held| held.log.stretches.len())?;
                slopes[k] = (of(&moved, &followed) - value) / step;
            }
        }
        Ok(slopes.dot(&(covariance * &slopes)).max(0.0).sqrt())
    }

    /// σ and ρ as the residual of a fit shows them.
    pub(crate) fn noise(&self, fitted: &Fitted, determined: [f64; 2]) -> [ResidualNoise; 2] {
        let size = fitted.size();
        let usual = usual_duration(&fitted.followed);
        let (mut growth, mut friction) = (Vec::new(), Vec::new());
        for (held, followed) in self.logs.iter().zip(&fitted.followed) {
            let read = followed.growth.iter().filter(|r| r.stretch < held.fitted);
            let read: Vec<_> = read.collect();
            let mut places: Vec<f64> = read.iter().map(|r| r.place).collect();
            places.sort_by(f64::total_cmp);
            places.dedup();
            growth.extend(places.iter().map(|place| {
                let here = read.iter().filter(|r| r.place == *place);
                here.map(|r| size * r.predicted - r.found)
                    .collect::<Vec<_>>()
            }));
            let powers = followed.powers().filter(|r| r.stretch < held.fitted);
            friction.push(powers.map(|r| r.deviation(usual)).collect());
        }
        let left = self.freedom(determined);
        let counts = self.counts().map(|count| count as f64);
        let increase = [0, 1].map(|i| (counts[i].max(1.0) / left[i]).sqrt());
        [
            residual_noise(&growth, increase[0], 0.02e-6),
            residual_noise(&friction, increase[1], 1e-4),
        ]
    }
}

impl Problem<'_> {
    /// Degrees of freedom of both kinds of residuals. Readings that are all determined leave none to judge by: a quarter
    /// is kept.
    pub(crate) fn freedom(&self, determined: [f64; 2]) -> [f64; 2] {
        let counts = self.counts().map(|count| (count as f64).max(1.0));
        [0, 1].map(|i| (counts[i] - determined[i]).max(0.25 * counts[i]))
    }
}

/// `begin` with the free unknowns in place.
fn with(begin: &DVector<f64>, free: &[usize], at: &DVector<f64>) -> DVector<f64> {
    let mut all = begin.clone();
    for (k, value) in free.iter().zip(at) {
        all[*k] = *value;
    }
    all
}

/// Fewest readings of a kind, fitted and held out, of which something is concluded.
const FEWEST: [usize; 2] = [6, 3];

/// What logs show.
pub(crate) fn shown(logs: &[HeldLog]) -> Result<Assumed, ThermalError> {
    let (mut growth, mut friction) = ([0; 2], [0; 2]);
    for held in logs {
        let of = |log: &GrowthLog| {
            let worked = log.stretches.iter();
            let worked = worked.filter(|s| s.friction.is_some_and(|power| power > 0.0));
            [log.comparisons(), worked.count()]
        };
        let (part, whole) = (of(&held.log.first(held.fitted)), of(&held.log));
        for (count, i) in [(&mut growth, 0), (&mut friction, 1)] {
            count[0] += part[i];
            count[1] += whole[i] - part[i];
        }
    }
    let enough = |count: [usize; 2]| count[0] >= FEWEST[0] && count[1] >= FEWEST[1];
    let shows = Assumed {
        growth: enough(growth),
        warming: enough(friction),
    };
    let most = growth[0].max(friction[0]);
    check(
        shows.growth || shows.warming,
        "number of readings to fit",
        most as f64,
        "",
        "logs with at least 6 readings of growth, or of the friction's power, to fit, and 3 more that are held out or in logs to check on",
    )?;
    Ok(shows)
}
