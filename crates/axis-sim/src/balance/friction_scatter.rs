//! Samples at which friction depends on motion that the sensor does not resolve.
//!
//! Close to a reversal, and where an axis sticks and slips, friction depends on a motion that is
//! finer than the noise of its sensor, or faster than the low-pass. To find out how
//! much, the motion is measured once more: with the same noise added, behind the same low-pass,
//! friction comes out differently where it depends on these, and the same elsewhere (simulation and
//! extrapolation: Cook, Stefanski, J. Am. Stat. Assoc. 89 (1994) 1314,
//! doi:10.1080/01621459.1994.10476871).

use lugre::LuGre;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::filter::LowPass;
use super::law::friction_from;
use super::motion::{Course, Measured, Whose};
use super::wind_up::{behind_a_spring, with_stiffness};
use crate::axis::Axis;

/// Times that the motion is measured once more.
const TIMES: u64 = 8;

/// Factors on the bristles' stiffness, in turn.
const STIFFER: [f64; 2] = [2.0, 0.5];

/// A motion that is measured once more by the sensor that showed it.
pub(super) struct Remeasured<'a> {
    pub axis: &'a Axis,
    pub measured: &'a Measured,
    /// The load's course as it was found.
    pub load: &'a Course,
    /// Stiffness between it and what was measured, N/m or N·m/rad.
    pub spring: Option<f64>,
    /// Of the samples, s.
    pub period: f64,
    /// Of the motion's low-pass, Hz.
    pub cutoff: f64,
}

impl Remeasured<'_> {
    /// Change of the friction at the load by that, RMS, sample by sample, behind the
    /// `filter` of the comparison, N or N·m.
    pub fn friction_scatter(&self, filter: &LowPass) -> Vec<f64> {
        let friction = self.axis.friction.share();
        let lever = friction.lever(self.axis.travel_per_radian());
        let own = behind_a_spring(&friction.law, self.spring, lever);
        let first = self.load.speed.first().map_or(0.0, |v| v / lever);
        let settled = own.steady_bristle(first);
        let along = |law: &LuGre, bristle, course: &Course| {
            friction_from(law, bristle, lever, course, self.period)
        };
        let once = along(&own, settled, self.load);
        let mut squares = vec![0.0; once.len()];
        for seed in 0..TIMES {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let law = with_stiffness(
                &own,
                STIFFER[seed as usize % STIFFER.len()] * own.parameters().stiffness,
            );
            let bristle = law.bristle_limit() * random.random_range(-1.0..1.0);
            let twice = along(&law, bristle, &self.again(&mut random));
            let change: Vec<f64> = twice.iter().zip(&once).map(|(b, a)| b - a).collect();
            for (sum, by) in squares.iter_mut().zip(filter.apply(&change)) {
                *sum += by * by / TIMES as f64;
            }
        }
        squares.into_iter().map(f64::sqrt).collect()
    }

    fn again(&self, random: &mut ChaCha8Rng) -> Course {
        let at_the_load = match self.measured.whose {
            Whose::Load => 1.0,
            Whose::Motor => self.axis.travel_per_radian(),
        };
        let deviation = at_the_load * self.measured.noise.deviation(self.period);
        let noisy = |x: &f64| {
            let unit: f64 = StandardNormal.sample(random);
            x + deviation * unit
        };
        let shown: Vec<f64> = self.measured.shown(self.load).iter().map(noisy).collect();
        self.measured.smoothed(&shown, self.period, self.cutoff)
    }
}
