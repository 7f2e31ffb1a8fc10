//! Up to which frequency a log is balanced.

use std::f64::consts::TAU;

use super::channel::TorqueChannel;
use super::error::BalanceError;
use super::motion::{Measured, Whose};
use super::orders::{Order, orders};
use super::prepared::{BELOW, DEVIATIONS, inertia, natural_frequency, wind_up};
use super::quality::{CutoffBound, TOLERATED};
use super::spectrum::Noise;
use super::together::Together;
use crate::axis::Axis;

/// Highest cut-off of the comparison as a share of the sampling rate: there derivatives are good to
/// 4e-6, and to 3e-4 where the low-pass has left a fifth.
pub(super) const HIGHEST: f64 = 0.25;

/// The same where nothing asks for more: motion of ten and more samples a wave, behind a low-pass that
/// takes nothing of what is compared. But of slow logs what one of 100 Hz has, Hz.
const USUAL: f64 = 0.04;
const USUAL_OF_SLOW: f64 = 4.0;

/// Cut-off over the frequency of what repeats with the motor's turn: the low-pass leaves 0.9 of it.
const ABOVE_ORDER: f64 = 1.3;

/// Share of the fast part of an effort for which its cut-off is raised: what is smaller is not worth the noise
/// above.
const LARGE: f64 = 0.1;

/// Samples that are compared at least where a log has them: four times as many as have to be.
const ENOUGH: f64 = 4.0 * super::prepared::LEAST as f64;

/// Share of an effort, RMS about its mean, that noise of the motion may take or add where the inertia
/// hardly matters.
const HARDLY: f64 = 0.1;

/// Highest cut-off as a share of the natural frequency below which what is measured moves as
/// one: there a two-mass drive's inertia seems greater by 4 %.
const RIGID: f64 = 0.2;

/// Highest cut-off as a share of the frequency at which a load that is not measured swings against
/// the motor: what it does there is computed.
const SOFT: f64 = 0.4;

/// Rate from which on nobody asks whether a log shows a machine's motion, Hz: the lowest that a replay
/// takes. Of slower ones, the highest cut-off has to be above most of the acceleration's power: what is
/// faster would come back below it.
const FAST_ENOUGH: f64 = 100.0;
const MOST_OF_MOTION: f64 = 0.9;

/// Share of the speed, RMS, that its noise may make look like rest.
const TOLD: f64 = 0.2;

/// A cut-off, and what bounds it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cutoff {
    /// Of the comparison, Hz.
    pub frequency: f64,
    /// Highest of the motion, Hz: where noise of the motion would matter below that of the comparison.
    pub of_motion: f64,
    pub bound: CutoffBound,
}

impl Cutoff {
    /// The lower of two, in either.
    pub fn lower(self, other: Self) -> Self {
        let frequency = self.frequency.min(other.frequency);
        let bound = match other.frequency < self.frequency {
            true => other.bound,
            false => self.bound,
        };
        Self {
            frequency,
            of_motion: self.of_motion.min(other.of_motion),
            bound,
        }
    }
}

/// A log of which the cut-off is sought.
pub(super) struct Sought<'a> {
    pub axis: &'a Axis,
    pub measured: &'a [Measured],
    pub channel: TorqueChannel,
    /// What it shows.
    pub effort: &'a [f64],
    /// Of the log, s.
    pub period: f64,
}

impl Sought<'_> {
    /// Refuses a log that is slower than its motion.
    pub fn check_rate(&self) -> Result<(), BalanceError> {
        let rate = 1.0 / self.period;
        let each = self.measured.iter().map(|m| m.noise.holds(MOST_OF_MOTION));
        let motion = each.fold(0.0, f64::max);
        let least = (motion / HIGHEST).min(FAST_ENOUGH);
        match rate < least {
            true => Err(BalanceError::Slow {
                rate,
                motion,
                least,
            }),
            false => Ok(()),
        }
    }

    /// The cut-off of this log, and the orders of the motor's turn with which its effort repeats.
    pub fn cutoff(&self) -> (Cutoff, Vec<Order>) {
        let most = HIGHEST / self.period;
        let orders = self.orders();
        if let Some(asked) = self.axis.balance.cutoff {
            let bound = match asked > most {
                true => CutoffBound::Rate,
                false => CutoffBound::Asked,
            };
            return (self.up_to([0.0, asked.min(most)], [bound; 2]), orders);
        }
        let usual = (USUAL / self.period).max(USUAL_OF_SLOW).min(most);
        let each = self
            .measured
            .iter()
            .map(|m| m.noise.cutoff(usual, TOLERATED));
        let by_noise = each.fold(usual, f64::min);
        let stiff = rigid_below(self.axis, self.measured);
        let (strict, bound) = match (by_noise < usual, stiff < by_noise) {
            (_, true) => (stiff, CutoffBound::Stiffness),
            (true, false) => (by_noise, CutoffBound::Noise),
            (false, false) => (usual, CutoffBound::Rate),
        };
        let asks = self.needed(&orders).min(most);
        let found = match asks > strict {
            true => self.up_to([strict, asks], [bound, CutoffBound::Needed]),
            false => Cutoff {
                frequency: strict,
                of_motion: f64::INFINITY,
                bound,
            },
        };
        (found, orders)
    }

    fn orders(&self) -> Vec<Order> {
        let Some(angle) = self.measured.iter().find(|m| m.whose == Whose::Motor) else {
            let load = &self.measured[0];
            let r = self.axis.travel_per_radian();
            let angle: Vec<f64> = load.positions(self.period).iter().map(|x| x / r).collect();
            return orders(self.effort, &angle, USUAL, HIGHEST);
        };
        orders(self.effort, &angle.positions(self.period), USUAL, HIGHEST)
    }

    /// Cut-off at which all shows that repeats with the motor's turn, and enough samples are left, Hz.
    fn needed(&self, orders: &[Order]) -> f64 {
        let duration = self.effort.len() as f64 * self.period;
        let samples = ENOUGH / (super::prepared::RATE * duration);
        let of_order = orders.iter().filter(|o| o.share >= LARGE);
        let of_order = of_order.map(|o| ABOVE_ORDER * o.frequency / self.period);
        of_order.fold(samples, f64::max)
    }

    /// The cut-off `high`, if noise of the motion and the transmission's give hardly matter below it, beside
    /// the effort: an inertia that is far off where it makes next to nothing of the effort is no reason to
    /// leave out the rest. Where they would, the motion is low-passed where they do not, if what it has
    /// between makes next to nothing of the effort either; or else the cut-off is that, and `low` at least.
    fn up_to(&self, [low, high]: [f64; 2], [bound, asked]: [CutoffBound; 2]) -> Cutoff {
        const STEPS: i32 = 100;
        let matters = self.matters();
        let whole = Cutoff {
            frequency: high,
            of_motion: f64::INFINITY,
            bound: asked,
        };
        let tried = (0..=STEPS).map(|k| high * 1e-2_f64.powf(f64::from(k) / f64::from(STEPS)));
        let mut tried = tried.filter(|f| *f >= low && !matters.at(*f));
        match tried.next() {
            Some(f) if f == high => whole,
            Some(f) if !matters.between([f, high]) => Cutoff {
                of_motion: f,
                ..whole
            },
            Some(f) if low > 0.0 => Cutoff {
                frequency: f,
                bound: CutoffBound::Noise,
                ..whole
            },
            // Asked for, whatever it may be.
            _ if low == 0.0 => whole,
            _ => Cutoff {
                frequency: low,
                bound,
                ..whole
            },
        }
    }

    fn matters(&self) -> Matters<'_> {
        let first = &self.measured[0];
        let file = inertia(self.axis, first.whose);
        Matters {
            noise: &first.noise,
            together: first.together(self.effort, self.period),
            per_torque: self.channel.per_torque(self.axis).abs(),
            inertia: file,
            reach: self.reach(),
            far_share: self.far_share(),
            speed: first.speed_square(self.period),
        }
    }

    /// Share by which the axis file leaves the whole inertia open.
    fn reach(&self) -> f64 {
        let whole = self.axis.mechanism.total_inertia();
        let tolerances = self.axis.known_tolerances();
        let one = |at: usize| {
            let mut shares = vec![0.0; tolerances.len()];
            shares[at] = tolerances[at];
            let other = self.axis.with_known(&shares).mechanism.total_inertia();
            (other / whole - 1.0).abs()
        };
        let sum: f64 = (0..tolerances.len()).map(one).sum();
        sum.min(0.95)
    }

    /// Share of the whole inertia at the end that was not measured; with both measured, what lies beyond a
    /// transmission's second mode is some of either.
    fn far_share(&self) -> f64 {
        let mechanism = &self.axis.mechanism;
        let r = self.axis.travel_per_radian();
        let load = (mechanism.load_inertia() * r * r / mechanism.total_inertia()).clamp(0.0, 1.0);
        match self.measured {
            [one] if one.whose == Whose::Motor => load,
            [_] => 1.0 - load,
            _ => 1.0,
        }
    }
}

/// What noise of a motion makes of a balance up to a frequency, beside the effort.
struct Matters<'a> {
    noise: &'a Noise,
    together: Together,
    /// Of the effort's channel.
    per_torque: f64,
    /// By the axis file, per measured acceleration, and the share by which it may be off.
    inertia: f64,
    reach: f64,
    /// Share of it that was not measured where it is.
    far_share: f64,
    /// Mean square of the measured speed.
    speed: f64,
}

impl Matters<'_> {
    /// Inertia as least squares up to a frequency take it, within what is known; that without what noise
    /// draws from it; and the RMS of the motion's acceleration and of the effort about its mean, as a torque.
    fn taken(&self, frequency: f64) -> [f64; 4] {
        let [square, product, effort] = self.together.up_to(frequency);
        let drawn = self.noise.attenuation(frequency);
        let most = self.inertia * (1.0 + self.reach);
        let within = |inertia: f64| inertia.clamp(self.inertia * (1.0 - self.reach), most);
        let taken = within(product / (self.per_torque * square).max(f64::MIN_POSITIVE));
        let whole = match drawn < 1.0 {
            true => within(taken / (1.0 - drawn)),
            false => most,
        };
        let moved = (square * (1.0 - drawn)).max(0.0).sqrt();
        [taken, whole, moved, effort.sqrt() / self.per_torque]
    }

    /// Whether it matters that all is compared up to that frequency.
    fn at(&self, frequency: f64) -> bool {
        let [taken, whole, moved, effort] = self.taken(frequency);
        let [square, ..] = self.together.up_to(frequency);
        let lost = (whole - taken).abs() * moved;
        let of_far = self.far_share * taken * square.sqrt();
        let noise = taken * self.noise.least_acceleration(frequency);
        // Behind the low-pass of a motion for that cut-off.
        let noise_of_speed = self.noise.speed(frequency / BELOW);
        let hides = DEVIATIONS * noise_of_speed > TOLD * self.speed.sqrt();
        lost.max(of_far) > HARDLY * effort || noise > effort || hides
    }

    /// Whether inertia makes more of the effort than hardly anything between two frequencies: by what least
    /// squares there have go with the acceleration, noise that draws on that counted in. Where it goes with less than half of
    /// the least inertia that may be, what looks like acceleration is none.
    fn between(&self, [low, high]: [f64; 2]) -> bool {
        let [below, all] = [low, high].map(|f| self.together.up_to(f));
        let [square, product] = [0, 1].map(|i| all[i] - below[i]);
        let found = product / (self.per_torque * square).max(f64::MIN_POSITIVE);
        let least = self.inertia * (1.0 - self.reach);
        let drawn = self.noise.attenuation(high).min(MOST_DRAWN);
        let explained = product.powi(2) / square.max(f64::MIN_POSITIVE) / (1.0 - drawn);
        found >= 0.5 * least && explained > HARDLY.powi(2) * all[2]
    }
}

/// Share of an inertia that noise draws at most of which something is left to be told.
const MOST_DRAWN: f64 = 0.9;

/// The frequency, Hz, below which one measured motion stands for that of motor and load:
/// well below the first mode. Of two, each has its own inertia, up to the second.
///
/// Of a load that is found by its swinging against the motor: below the frequency of that.
fn rigid_below(axis: &Axis, measured: &[Measured]) -> f64 {
    let highest = match (measured, wind_up(axis)) {
        ([one], Some(wind_up)) if one.whose == Whose::Motor => SOFT * wind_up.swing(axis),
        _ => RIGID * natural_frequency(axis, measured.len()),
    };
    highest / TAU
}
