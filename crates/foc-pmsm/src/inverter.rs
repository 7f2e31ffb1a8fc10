//! A two-level inverter with a centre-aligned carrier: as the mean voltage
//! of a period, and as the switched voltages inside it.

use crate::error::{FocError, check, positive};
use crate::frames::{AlphaBeta, Dq, Phases};
use crate::motor::Pmsm;
use crate::svpwm::Duties;

/// Integration steps of a whole period. The rotor turns through a sixteenth
/// of the period's angle in one: at 840 rad/s electrical and 100 µs, 0.3°.
const PIECES: u32 = 16;

/// A validated inverter. Immutable, without memory.
///
/// The period starts and ends at the carrier's crest, in the middle of a zero
/// vector (all legs low); a leg with duty D is on the upper rail for D·T
/// about the period's middle. At the start the current's ripple crosses its
/// mean: this is where the currents are sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inverter {
    dc_voltage: f64,
    period: f64,
    dead_time: f64,
}

/// A stretch of a period in which no leg switches.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Segment {
    /// How long it lasts, s; may be 0.
    pub duration: f64,
    /// Whether leg a, b, c is on the upper rail.
    pub upper: [bool; 3],
    /// The voltage vector, V.
    pub voltage: AlphaBeta,
}

/// Where the rotor is and how fast it turns.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rotor {
    /// Electrical angle of the d axis at the period's start, rad.
    pub electrical_angle: f64,
    /// Mechanical speed, rad/s, constant over the period.
    pub speed: f64,
}

impl Rotor {
    /// Electrical angle (rad) a time `t` (s) after the period's start.
    #[inline]
    pub fn angle_after(&self, motor: &Pmsm, t: f64) -> f64 {
        self.electrical_angle + motor.electrical_speed(self.speed) * t
    }
}

impl Inverter {
    /// An inverter with DC-link voltage U_dc (V), PWM period T (s) and dead
    /// time (s) between the two switches of a leg; dead time 0 is the ideal
    /// inverter, bit for bit.
    ///
    /// # Errors
    /// [`FocError`] unless voltage and period are finite and greater than 0
    /// and 0 ≤ dead time < period/2.
    pub fn new(dc_voltage: f64, period: f64, dead_time: f64) -> Result<Self, FocError> {
        positive("dc_voltage", dc_voltage)?;
        positive("period", period)?;
        let ok = (0.0..0.5 * period).contains(&dead_time);
        let valid = "0 or greater and less than half the period";
        check(ok, "dead_time", dead_time, valid)?;
        Ok(Self {
            dc_voltage,
            period,
            dead_time,
        })
    }

    /// PWM period, s.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// The mean voltage vector (V) that dead time adds while all legs switch
    /// and no pulse is shorter than it: −sgn(i) U_dc t_d/T in each phase, from
    /// the phase currents (A, positive into the motor). Jeong and Park, IEEE
    /// Trans. Ind. Electron. 38 (1991) 108–114.
    pub fn dead_time_voltage(&self, currents: Phases) -> AlphaBeta {
        let lost = self.dc_voltage * self.dead_time / self.period;
        let error = |i: f64| -lost * sign(i);
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
    pub fn effective_duties(&self, duties: Duties, currents: Phases) -> Duties {
        let fraction = self.dead_time / self.period;
        let leg = |duty: f64, i: f64| {
            if duty > 0.0 && duty < 1.0 {
                (duty - sign(i) * fraction).clamp(0.0, 1.0)
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
    pub fn averaged(&self, duties: Duties, currents: Phases) -> AlphaBeta {
        self.effective_duties(duties, currents)
            .voltage(self.dc_voltage)
    }

    /// Switched model: the seven stretches between the six switching
    /// instants of a period, in order; some have no length where legs switch
    /// together or not at all. The sign of each phase current is the one at
    /// the period's start.
    pub fn switched(&self, duties: Duties, currents: Phases) -> [Segment; 7] {
        let pulses = [
            self.pulse(duties.a, currents.a),
            self.pulse(duties.b, currents.b),
            self.pulse(duties.c, currents.c),
        ];
        let mut instants = [0.0; 8];
        for (k, &(on, off)) in pulses.iter().enumerate() {
            instants[2 * k + 1] = on;
            instants[2 * k + 2] = off;
        }
        instants[7] = self.period;
        instants.sort_unstable_by(f64::total_cmp);
        core::array::from_fn(|k| self.segment(&pulses, instants[k], instants[k + 1]))
    }

    /// When a leg is on the upper rail. A positive current delays the rise
    /// by the dead time, a negative one the fall; what would pass the
    /// period's end is put before the pulse, so that volt-seconds agree with
    /// the averaged model (in a steady state it would come from the previous
    /// period).
    fn pulse(&self, duty: f64, current: f64) -> (f64, f64) {
        let mut on = 0.5 * self.period * (1.0 - duty);
        let mut off = 0.5 * self.period * (1.0 + duty);
        if duty > 0.0 && duty < 1.0 {
            if current > 0.0 {
                on = (on + self.dead_time).min(off);
            } else if current < 0.0 {
                let late = off + self.dead_time;
                off = late.min(self.period);
                on = (on - (late - off)).max(0.0);
            }
        }
        (on, off)
    }

    fn segment(&self, pulses: &[(f64, f64); 3], start: f64, end: f64) -> Segment {
        let middle = 0.5 * (start + end);
        let upper = pulses.map(|(on, off)| on < middle && middle < off);
        let level = |k: usize| if upper[k] { self.dc_voltage } else { 0.0 };
        Segment {
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

    /// The currents (A) a period after `i0` with the averaged voltage, which
    /// stands still in the stator while the rotor turns.
    pub fn averaged_step(&self, motor: &Pmsm, i0: Dq, rotor: Rotor, duties: Duties) -> Dq {
        let currents = phase_currents(i0, rotor);
        let voltage = self.averaged(duties, currents);
        self.hold(motor, i0, rotor, 0.0, voltage, self.period)
    }

    /// The currents (A) a period after `i0` with the switched voltages.
    pub fn switched_step(&self, motor: &Pmsm, i0: Dq, rotor: Rotor, duties: Duties) -> Dq {
        let mut i = i0;
        let mut t = 0.0;
        for segment in self.switched(duties, phase_currents(i0, rotor)) {
            i = self.hold(motor, i, rotor, t, segment.voltage, segment.duration);
            t += segment.duration;
        }
        i
    }

    /// Holds a stator voltage from `t` for `duration`: midpoint steps, each
    /// seeing the voltage from the rotor's angle in its middle.
    fn hold(
        &self,
        motor: &Pmsm,
        i0: Dq,
        rotor: Rotor,
        t: f64,
        voltage: AlphaBeta,
        duration: f64,
    ) -> Dq {
        // At least one, so that a NaN duration is seen in the currents.
        let share = libm::ceil(f64::from(PIECES) * (duration / self.period));
        let pieces = (share as u32).clamp(1, PIECES);
        let h = duration / f64::from(pieces);
        (0..pieces).fold(i0, |i, k| {
            let middle = t + (f64::from(k) + 0.5) * h;
            let u = voltage.park(rotor.angle_after(motor, middle));
            motor.step(i, u, rotor.speed, h)
        })
    }
}

fn phase_currents(i: Dq, rotor: Rotor) -> Phases {
    i.inverse_park(rotor.electrical_angle).inverse_clarke()
}

/// −1, 0 or 1: unlike `signum`, no current has no sign.
fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        0.0
    }
}
