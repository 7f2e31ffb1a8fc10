//! The cascade with a current reference that may come late.

use std::collections::VecDeque;

use compensator::Correction;
use foc_pmsm::{Command, Dq, Measurement, Saturated, Servo, ServoState};

/// One cycle of the cascade; a late current reference is logged as it was
/// asked for, and reaches the current controllers late.
pub(crate) fn control(
    servo: &Servo,
    state: &mut ServoState,
    delay: &mut DelayLine,
    measured: &Measurement,
    reference: &foc_pmsm::Reference,
    correction: &Correction,
) -> Command {
    let correction = foc_pmsm::Correction {
        position_offset: correction.position,
        speed: 0.0,
        iq: correction.iq,
    };
    if delay.is_none() {
        return servo.cycle(state, measured, reference, &correction);
    }
    let error = reference.position - measured.position + correction.position_offset;
    let speed_ref = servo.position_loop(error, reference.motor_speed + correction.speed);
    let speed_error = speed_ref - measured.motor_speed;
    let (iq_ref, current) = servo.speed_loop(state, speed_error, correction.iq);
    let late = Dq {
        d: 0.0,
        q: delay.push(iq_ref),
    };
    let (voltage, d, q) = servo.current_loop(state, late - measured.current, Dq::ZERO);
    Command {
        speed_ref,
        iq_ref,
        voltage,
        saturated: Saturated {
            current,
            voltage_d: d,
            voltage_q: q,
        },
    }
}

/// The last few current references, and the one that is a delay old.
#[derive(Clone, Debug)]
pub(crate) struct DelayLine {
    /// In control cycles, whole and part.
    cycles: f64,
    past: VecDeque<f64>,
}

impl DelayLine {
    pub(crate) fn new(cycles: f64) -> Self {
        // Effects keep it within some thousand cycles.
        let length = (cycles.ceil() as usize).saturating_add(2);
        Self {
            cycles,
            past: VecDeque::from(vec![0.0; length]),
        }
    }

    fn is_none(&self) -> bool {
        self.cycles <= 0.0
    }

    /// Takes the newest value and gives the late one, linear between cycles.
    fn push(&mut self, newest: f64) -> f64 {
        self.past.pop_back();
        self.past.push_front(newest);
        let whole = self.cycles.floor();
        let part = self.cycles - whole;
        let at = |i: usize| self.past.get(i).copied().unwrap_or(newest);
        let after = whole as usize;
        (1.0 - part) * at(after) + part * at(after + 1)
    }
}
