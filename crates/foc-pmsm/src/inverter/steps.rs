//! The motor's currents over a period of the inverter.

use super::{Inverter, Rotor};
use crate::frames::{AlphaBeta, Dq, Phases};
use crate::motor::Pmsm;
use crate::svpwm::Duties;
use axis_scalar::Scalar;

/// Integration steps of a whole period. The rotor turns through a sixteenth
/// of the period's angle in one: at 840 rad/s electrical and 100 µs, 0.3°.
const PIECES: f64 = 16.0;

impl<T: Scalar> Inverter<T> {
    /// The currents (A) a period after `i0` with the averaged voltage, which
    /// stands still in the stator while the rotor turns.
    pub fn averaged_step(
        &self,
        motor: &Pmsm<T>,
        i0: Dq<T>,
        rotor: Rotor<T>,
        duties: Duties<T>,
    ) -> Dq<T> {
        let currents = phase_currents(i0, rotor);
        let voltage = self.averaged(duties, currents);
        self.hold(
            motor,
            i0,
            rotor,
            Held {
                from: T::ZERO,
                duration: self.period,
                voltage,
            },
        )
    }

    /// The currents (A) a period after `i0` with the switched voltages.
    pub fn switched_step(
        &self,
        motor: &Pmsm<T>,
        i0: Dq<T>,
        rotor: Rotor<T>,
        duties: Duties<T>,
    ) -> Dq<T> {
        let mut i = i0;
        let mut t = T::ZERO;
        for segment in self.switched(duties, phase_currents(i0, rotor)) {
            let held = Held {
                from: t,
                duration: segment.duration,
                voltage: segment.voltage,
            };
            i = self.hold(motor, i, rotor, held);
            t += segment.duration;
        }
        i
    }

    /// The currents after a voltage was held: midpoint steps, each seeing the voltage from the
    /// rotor's angle in its middle.
    fn hold(&self, motor: &Pmsm<T>, i0: Dq<T>, rotor: Rotor<T>, held: Held<T>) -> Dq<T> {
        let duration = held.duration;
        // At least one, so that a NaN duration is seen in the currents.
        let share = T::of(PIECES) * (duration / self.period);
        let mut pieces = T::ONE;
        while pieces < share && pieces < T::of(PIECES) {
            pieces += T::ONE;
        }
        let h = duration / pieces;
        let (mut i, mut piece) = (i0, T::ZERO);
        while piece < pieces {
            let middle = held.from + (piece + T::HALF) * h;
            let u = held.voltage.park(rotor.angle_after(motor, middle));
            i = motor.step(i, u, rotor.speed, h);
            piece += T::ONE;
        }
        i
    }
}

/// A stator voltage that is held from a time of the period on, s.
struct Held<T> {
    from: T,
    duration: T,
    voltage: AlphaBeta<T>,
}

fn phase_currents<T: Scalar>(i: Dq<T>, rotor: Rotor<T>) -> Phases<T> {
    i.inverse_park(rotor.electrical_angle).inverse_clarke()
}
