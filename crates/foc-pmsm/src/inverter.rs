//! A two-level inverter with a centre-aligned carrier: as the mean voltage
//! of a period, and as the switched voltages inside it.

mod steps;

use crate::error::{FocError, check, positive};
use crate::frames::{AlphaBeta, Phases};
use crate::math::clamp;
use crate::motor::Pmsm;
use crate::svpwm::Duties;
use axis_scalar::Scalar;
use core::cmp::Ordering;

/// A validated inverter. Immutable, without memory.
///
/// The period starts and ends at the carrier's crest, in the middle of a zero
/// vector (all legs low); a leg with duty D is on the upper rail for D·T
/// about the period's middle. At the start the current's ripple crosses its
/// mean: this is where the currents are sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inverter<T = f64> {
    dc_voltage: T,
    period: T,
    dead_time: T,
}

/// A stretch of a period in which no leg switches.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SwitchingSegment<T = f64> {
    /// How long it lasts, s; may be 0.
    pub duration: T,
    /// Whether leg a, b, c is on the upper rail.
    pub upper: [bool; 3],
    /// The voltage vector, V.
    pub voltage: AlphaBeta<T>,
}

/// Where the rotor is and how fast it turns.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rotor<T = f64> {
    /// Electrical angle of the d axis at the period's start, rad.
    pub electrical_angle: T,
    /// Mechanical speed, rad/s, constant over the period.
    pub speed: T,
}

impl<T: Scalar> Rotor<T> {
    /// Electrical angle (rad) a time `t` (s) after the period's start.
    #[inline]
    pub fn angle_after(&self, motor: &Pmsm<T>, t: T) -> T {
        self.electrical_angle + motor.electrical_speed(self.speed) * t
    }
}

impl<T: Scalar> Inverter<T> {
    /// An inverter with DC-link voltage U_dc (V), PWM period T (s) and dead
    /// time (s) between the two switches of a leg; dead time 0 is the ideal
    /// inverter, bit for bit.
    ///
    /// # Errors
    /// [`FocError`] unless voltage and period are finite and greater than 0
    /// and 0 ≤ dead time < period/2.
    pub fn new(dc_voltage: T, period: T, dead_time: T) -> Result<Self, FocError> {
        positive("dc_voltage", dc_voltage)?;
        positive("period", period)?;
        let ok = (T::ZERO..T::HALF * period).contains(&dead_time);
        let valid = "0 or greater and less than half the period";
        check(ok, "dead_time", dead_time, valid)?;
        Ok(Self {
            dc_voltage,
            period,
            dead_time,
        })
    }

    /// PWM period, s.
    pub fn period(&self) -> T {
        self.period
    }

    /// The mean voltage vector (V) that dead time adds while all legs switch
    /// and no pulse is shorter than it: −sgn(i) U_dc t_d/T in each phase, from
    /// the phase currents (A, positive into the motor). Jeong and Park, IEEE
    /// Trans. Ind. Electron. 38 (1991) 108–114.
    pub fn dead_time_voltage(&self, currents: Phases<T>) -> AlphaBeta<T> {
        let lost = self.dc_voltage * self.dead_time / self.period;
        let error = |i: T| -lost * sign(i);
        Phases {
            a: error(currents.a),
            b: error(currents.b),
            c: error(currents.c),
        }
        .clarke()
    }

    /// The duties that arrive at the motor. A positive current holds its leg
    /// on the lower rail through the dead time, a negative one on the upper:
    /// D − sgn(i) t_d/T, within \[0, 1\]. A leg that does not switch loses
    /// nothing.
    pub fn effective_duties(&self, duties: Duties<T>, currents: Phases<T>) -> Duties<T> {
        let fraction = self.dead_time / self.period;
        let leg = |duty: T, i: T| {
            if duty > T::ZERO && duty < T::ONE {
                clamp(duty - sign(i) * fraction, T::ZERO, T::ONE)
            } else {
                duty
            }
        };
        Duties {
            a: leg(duties.a, currents.a),
            b: leg(duties.b, currents.b),
            c: leg(duties.c, currents.c),
        }
    }

    /// Averaged model: the mean voltage vector (V) of a period, from the
    /// duties and the phase currents (A) at its start.
    pub fn averaged(&self, duties: Duties<T>, currents: Phases<T>) -> AlphaBeta<T> {
        self.effective_duties(duties, currents)
            .voltage(self.dc_voltage)
    }

    /// Switched model: the seven stretches between the six switching
    /// instants of a period, in order; some have no length where legs switch
    /// together or not at all. The sign of each phase current is the one at
    /// the period's start.
    pub fn switched(&self, duties: Duties<T>, currents: Phases<T>) -> [SwitchingSegment<T>; 7] {
        let pulses = [
            self.pulse(duties.a, currents.a),
            self.pulse(duties.b, currents.b),
            self.pulse(duties.c, currents.c),
        ];
        let mut instants = [T::ZERO; 8];
        for (k, &(on, off)) in pulses.iter().enumerate() {
            instants[2 * k + 1] = on;
            instants[2 * k + 2] = off;
        }
        instants[7] = self.period;
        instants.sort_unstable_by(ascending);
        core::array::from_fn(|k| self.segment(&pulses, instants[k], instants[k + 1]))
    }

    /// When a leg is on the upper rail. A positive current delays the rise
    /// by the dead time, a negative one the fall; what would pass the
    /// period's end is put before the pulse, so that volt-seconds agree with
    /// the averaged model (in a steady state it would come from the previous
    /// period).
    fn pulse(&self, duty: T, current: T) -> (T, T) {
        let mut on = T::HALF * self.period * (T::ONE - duty);
        let mut off = T::HALF * self.period * (T::ONE + duty);
        if duty > T::ZERO && duty < T::ONE {
            if current > T::ZERO {
                on = (on + self.dead_time).min(off);
            } else if current < T::ZERO {
                let late = off + self.dead_time;
                off = late.min(self.period);
                on = (on - (late - off)).max(T::ZERO);
            }
        }
        (on, off)
    }

    fn segment(&self, pulses: &[(T, T); 3], start: T, end: T) -> SwitchingSegment<T> {
        let middle = T::HALF * (start + end);
        let upper = pulses.map(|(on, off)| on < middle && middle < off);
        let level = |k: usize| if upper[k] { self.dc_voltage } else { T::ZERO };
        SwitchingSegment {
            duration: end - start,
            upper,
            voltage: Phases {
                a: level(0),
                b: level(1),
                c: level(2),
            }
            .clarke(),
        }
    }
}

/// −1, 0 or 1: unlike `signum`, no current has no sign.
fn sign<T: Scalar>(x: T) -> T {
    if x > T::ZERO {
        T::ONE
    } else if x < T::ZERO {
        -T::ONE
    } else {
        T::ZERO
    }
}

/// A total order, which sorting needs: what is not a number stands at the end
/// of its sign, as in `f64::total_cmp`.
fn ascending<T: Scalar>(a: &T, b: &T) -> Ordering {
    let end = |x: T| match (x.is_nan(), T::ONE.copysign(x) > T::ZERO) {
        (false, _) => 0,
        (true, positive) => 2 * i8::from(positive) - 1,
    };
    let values = a.partial_cmp(b).unwrap_or(Ordering::Equal);
    end(*a).cmp(&end(*b)).then(values)
}
