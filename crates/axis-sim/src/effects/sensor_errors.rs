//! What sensors get wrong.

use foc_pmsm::{Dq, Phases};

use crate::cycle::Measured;

/// What the sensors get wrong.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorErrors {
    /// Share by which both currents are shown too great.
    pub current_gain: f64,
    /// What the current sensors show at no current.
    pub current_offset: CurrentOffset,
    /// Amplitude and phase of each of the motor encoder's errors, rad.
    pub eccentricities: Vec<[f64; 2]>,
}

/// What the current sensors of a motor show at no current.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CurrentOffset {
    /// Of phases a and b, A.
    pub phases: [f64; 2],
    /// Electrical periods per radian of the motor; none of an actuator whose current has no
    /// angle, and one sensor.
    pub poles: Option<f64>,
}

impl CurrentOffset {
    /// It in the rotor's frame at a motor angle (rad), A; none if the sensors show nothing.
    pub(crate) fn at(&self, motor_angle: f64) -> Option<Dq> {
        let [a, b] = self.phases;
        if [a, b] == [0.0; 2] {
            return None;
        }
        Some(match self.poles {
            Some(poles) => Phases { a, b, c: -a - b }
                .clarke()
                .park(poles * motor_angle),
            None => Dq { d: 0.0, q: a },
        })
    }
}

impl SensorErrors {
    /// By how much the motor's encoder shows too much at an angle, rad.
    pub(crate) fn eccentricity(&self, angle: f64) -> f64 {
        let all = self.eccentricities.iter();
        all.map(|[amplitude, phase]| amplitude * (angle + phase).sin())
            .sum()
    }

    /// What these sensors make of what perfect ones would show.
    pub(crate) fn show(&self, mut m: Measured) -> Measured {
        let gain = 1.0 + self.current_gain;
        m.current = m.current * gain;
        if let Some(offset) = self.current_offset.at(m.motor_angle) {
            m.current = m.current + offset;
        }
        let true_angle = m.motor_angle;
        let mut speed_ratio = 1.0;
        for [amplitude, phase] in &self.eccentricities {
            let at = true_angle + phase;
            m.motor_angle += amplitude * at.sin();
            speed_ratio += amplitude * at.cos();
        }
        m.motor_speed *= speed_ratio;
        m
    }
}
