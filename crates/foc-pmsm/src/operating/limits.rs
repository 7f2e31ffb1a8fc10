//! The currents of a torque within the limits of current and voltage.

use crate::frames::Dq;
use crate::math::{clamp, length};
use crate::motor::Pmsm;
use axis_scalar::Scalar;

/// What the drive can do in this cycle. Negative limits count as 0.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct OperatingLimits<T = f64> {
    /// Length I of the current, A (infinity: no limit).
    pub current: T,
    /// Length U of the voltage, V: U_dc/√3 for linear modulation, less what the current
    /// controllers are to keep for themselves (infinity: no limit).
    pub voltage: T,
}

/// What decided about the currents.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum OperatingRegion {
    /// The least current that makes the torque.
    Mtpa,
    /// The torque is too much for the current limit: the most that it allows.
    CurrentLimit,
    /// The torque is made, with more current than the least, since the voltage allows no
    /// other.
    FieldWeakening,
    /// The torque is too much: the most that current and voltage allow together.
    CurrentAndVoltageLimit,
    /// The torque is too much: the most that the voltage allows; more current would make
    /// less (maximum torque per volt).
    Mtpv,
    /// The voltage does not even suffice for no torque, or an input is not a number. The
    /// currents are those of the least voltage, or not numbers.
    Unreachable,
}

/// The currents of a torque, as [`Pmsm::operating_currents`] finds them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct OperatingCurrents<T = f64> {
    /// Current references, A.
    pub current: Dq<T>,
    /// The torque that they make, N·m: what was asked for, or less.
    pub torque: T,
    /// What decided.
    pub region: OperatingRegion,
}

impl<T: Scalar> Pmsm<T> {
    /// The shortest current (A) that makes `torque` (N·m) at the mechanical `speed`
    /// (rad/s) within the limits, or, where there is none, that with the most torque of
    /// the same sign. The voltage is that of the steady state, with the resistance; at a
    /// speed that changes the controllers need some more.
    ///
    /// Current circle |i| ≤ I and voltage ellipse |R i + ω_e J λ| ≤ U are convex, and so
    /// is the set of currents that make at least the torque. Along i_d the torque that
    /// they leave has therefore one maximum, and beside it the shortest current is where
    /// the constant-torque line leaves the ellipse towards the locus of
    /// [`Pmsm::mtpa_for_torque`]. Both are found by bisection, to the last place, in a
    /// bounded number of steps (26 each in `f32`, 55 in `f64`); below base speed by none.
    /// The operating regions are those of Morimoto et al. 1990 (doi 10.1109/28.60058),
    /// for any saliency, without magnets too.
    ///
    /// Only i_d that the voltage allows without torque are used, so that the torque can
    /// always be taken off; a generator's ellipse reaches a little further.
    ///
    /// ```
    /// use foc_pmsm::{MotorParameters, OperatingLimits, OperatingRegion, Pmsm};
    ///
    /// let motor = Pmsm::new(MotorParameters {
    ///     pole_pairs: 4, resistance: 0.75, inductance_d: 4.11e-3,
    ///     inductance_q: 13.2e-3, flux_linkage: 0.2735_f64,
    /// })?;
    /// let limits = OperatingLimits { current: 15.0, voltage: 312.0 };
    /// let slow = motor.operating_currents(10.0, 100.0, &limits);
    /// let fast = motor.operating_currents(10.0, 320.0, &limits);
    /// assert_eq!(slow.region, OperatingRegion::Mtpa);
    /// assert_eq!(fast.region, OperatingRegion::FieldWeakening);
    /// assert!((fast.torque - 10.0).abs() < 1e-12 && fast.current.d < slow.current.d);
    /// let u = motor.steady_voltage(fast.current, 320.0);
    /// assert!((u.dot(u).sqrt() - 312.0).abs() < 1e-9);
    /// # Ok::<(), foc_pmsm::FocError>(())
    /// ```
    pub fn operating_currents(
        &self,
        torque: T,
        speed: T,
        limits: &OperatingLimits<T>,
    ) -> OperatingCurrents<T> {
        let numbers = [torque, speed, limits.current, limits.voltage];
        if numbers.iter().any(|x| x.is_nan()) {
            return OperatingCurrents {
                current: Dq {
                    d: T::NAN,
                    q: T::NAN,
                },
                torque: T::NAN,
                region: OperatingRegion::Unreachable,
            };
        }
        // Mirrored at the d axis, torque and speed change their signs, u_d keeps its own.
        let sign = T::ONE.copysign(torque);
        let plane = Plane::new(self, sign * self.electrical_speed(speed), limits);
        let (mut i, region) = plane.currents(self, self.torque_over_pairs(torque).abs());
        i.q *= sign;
        OperatingCurrents {
            current: i,
            torque: self.torque(i),
            region,
        }
    }
}

/// The current plane at one speed, for torques of 0 and more.
struct Plane<T> {
    psi: T,
    /// L_q − L_d, H.
    delta: T,
    resistance: T,
    /// ω_e L_d, Ω.
    reactance_d: T,
    /// ω_e L_q, Ω.
    reactance_q: T,
    /// ω_e ψ, V.
    induced: T,
    current: T,
    voltage: T,
}

/// What is known of one i_d: the largest i_q, and the sign of the torque's slope.
struct Slice<T> {
    q: T,
    /// Whether the voltage, not the current, limits i_q.
    by_voltage: bool,
    rising: bool,
}

impl<T: Scalar> Plane<T> {
    fn new(motor: &Pmsm<T>, omega: T, limits: &OperatingLimits<T>) -> Self {
        let p = motor.parameters();
        Self {
            psi: p.flux_linkage,
            delta: motor.saliency(),
            resistance: p.resistance,
            reactance_d: omega * p.inductance_d,
            reactance_q: omega * p.inductance_q,
            induced: omega * p.flux_linkage,
            current: limits.current.max(T::ZERO),
            voltage: limits.voltage.max(T::ZERO),
        }
    }

    fn currents(&self, motor: &Pmsm<T>, t: T) -> (Dq<T>, OperatingRegion) {
        let (mut i, mut region) = (motor.mtpa_for(t), OperatingRegion::Mtpa);
        let within = length(i.d, i.q) <= self.current;
        if !within {
            i = motor.mtpa(self.current);
            region = OperatingRegion::CurrentLimit;
        }
        if self.length_of_voltage(i) <= self.voltage {
            return (i, region);
        }
        let Some((low, high)) = self.without_torque() else {
            let d = clamp(self.least_voltage(), -self.current, self.current);
            return (Dq { d, q: T::ZERO }, OperatingRegion::Unreachable);
        };
        let t = if within { t } else { self.factor(i.d) * i.q };
        let (top, enough) = self.strongest(low, high, t);
        if enough {
            let d = self.nearest(top, clamp(i.d, low, high), t);
            let q = t / self.factor(d);
            return (Dq { d, q }, OperatingRegion::FieldWeakening);
        }
        let slice = self.slice(top);
        let i = Dq { d: top, q: slice.q };
        let inside = length(i.d, i.q) < self.current * (T::ONE - T::EPSILON.sqrt());
        let region = if slice.by_voltage && inside {
            OperatingRegion::Mtpv
        } else {
            OperatingRegion::CurrentAndVoltageLimit
        };
        (i, region)
    }

    /// Of the steady state, V.
    fn length_of_voltage(&self, i: Dq<T>) -> T {
        let d = self.resistance * i.d - self.reactance_q * i.q;
        let q = self.resistance * i.q + self.reactance_d * i.d + self.induced;
        length(d, q)
    }

    /// The i_d (A) with the least voltage at i_q = 0.
    fn least_voltage(&self) -> T {
        let (r, x) = (self.resistance, self.reactance_d);
        let square = r * r + x * x;
        if square == T::ZERO {
            return T::ZERO;
        }
        -x * self.induced / square
    }

    /// The i_d within both limits at i_q = 0 whose torque per i_q is not negative.
    fn without_torque(&self) -> Option<(T, T)> {
        let (r, x, u) = (self.resistance, self.reactance_d, self.voltage);
        let square = r * r + x * x;
        let spare = square * u * u - r * r * self.induced * self.induced;
        let (middle, half) = (self.least_voltage(), spare.sqrt() / square);
        let mut low = (-self.current).max(middle - half);
        let mut high = self.current.min(middle + half);
        let zero = self.psi / self.delta;
        if self.delta > T::ZERO {
            high = high.min(zero);
        } else if self.delta < T::ZERO {
            low = low.max(zero);
        }
        // A negative `spare` has no root: `half` is NaN, and `max` would hide it.
        (spare >= T::ZERO && low <= high).then_some((low, high))
    }

    /// Torque per i_q and 1.5 p, V·s.
    fn factor(&self, d: T) -> T {
        self.psi - self.delta * d
    }

    /// The largest i_q within both limits: the ellipse is a q² + 2 b q + c ≤ 0 there.
    fn slice(&self, d: T) -> Slice<T> {
        let r = self.resistance;
        let a = r * r + self.reactance_q * self.reactance_q;
        let induced = self.reactance_d * d + self.induced;
        // R ω_e (ψ − Δ i_d), from the two products in u_d and u_q.
        let b = r * (induced - self.reactance_q * d);
        let c = r * r * d * d + induced * induced - self.voltage * self.voltage;
        let root = (b * b - a * c).max(T::ZERO).sqrt();
        let ellipse = if b > T::ZERO {
            -c / (b + root)
        } else {
            (root - b) / a
        };
        let circle = ((self.current - d) * (self.current + d))
            .max(T::ZERO)
            .sqrt();
        let factor = self.factor(d);
        if ellipse <= circle {
            let slope_b = r * (self.reactance_d - self.reactance_q);
            let slope_c = r * r * d + self.reactance_d * induced;
            let q = ellipse.max(T::ZERO);
            // d(F q)/di_d times the root, with q' = −(b' q + c'/2)/root.
            let slope = -self.delta * q * root - factor * (slope_b * q + slope_c);
            Slice {
                q,
                by_voltage: true,
                rising: slope > T::ZERO,
            }
        } else {
            // Times q, with q' = −i_d/q.
            let slope = -self.delta * circle * circle - factor * d;
            Slice {
                q: circle,
                by_voltage: false,
                rising: slope > T::ZERO,
            }
        }
    }

    /// The i_d with the most torque and false, or the first one on the way there that makes
    /// `t` and true. An infinite or undefined torque is not made.
    fn strongest(&self, mut low: T, mut high: T, t: T) -> (T, bool) {
        for _ in 0..halvings::<T>() {
            let middle = T::HALF * low + T::HALF * high;
            let slice = self.slice(middle);
            if t < self.factor(middle) * slice.q {
                return (middle, true);
            }
            if slice.rising {
                low = middle;
            } else {
                high = middle;
            }
        }
        (high, t < self.factor(high) * self.slice(high).q)
    }

    /// The i_d nearest to `wanted` that makes `t`; `able` does.
    fn nearest(&self, mut able: T, wanted: T, t: T) -> T {
        let makes = |d: T| self.factor(d) * self.slice(d).q >= t;
        let mut unable = wanted;
        if makes(wanted) {
            return wanted;
        }
        for _ in 0..halvings::<T>() {
            let middle = T::HALF * able + T::HALF * unable;
            if makes(middle) {
                able = middle;
            } else {
                unable = middle;
            }
        }
        able
    }
}

/// Until an interval is as short as the last place of its longer end.
fn halvings<T: Scalar>() -> usize {
    if T::EPSILON < T::of(1e-10) { 55 } else { 26 }
}
