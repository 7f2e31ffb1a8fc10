//! A voltage that comes late, and is held for a control period.

use std::collections::VecDeque;

use foc_pmsm::Dq;

/// The last few voltages that were asked for, and the one that acts now.
#[derive(Clone, Debug)]
pub(super) struct LateVoltage {
    /// Whole control periods by which one is late, and the time (s) that is a part of one more.
    whole: usize,
    part: f64,
    /// The newest first.
    past: VecDeque<Dq>,
    /// Since the last sample, s.
    time: f64,
}

impl LateVoltage {
    /// Voltages that begin to act `late` control periods of `period` seconds after their
    /// sample; there were none before the first.
    pub fn new(late: f64, period: f64) -> Self {
        let whole = late.floor();
        Self {
            whole: whole as usize,
            part: (late - whole) * period,
            past: VecDeque::from(vec![Dq::ZERO; whole as usize + 2]),
            time: 0.0,
        }
    }

    /// As if `voltage` had been asked for, for ever.
    pub fn settle(&mut self, voltage: Dq) {
        self.past.iter_mut().for_each(|past| *past = voltage);
        self.time = 0.0;
    }

    /// Takes the voltage of the sample that is taken now.
    pub fn push(&mut self, voltage: Dq) {
        self.past.pop_back();
        self.past.push_front(voltage);
        self.time = 0.0;
    }

    /// Mean of what acts over the next `h` seconds, which end before the next sample: in a
    /// step in which one voltage follows another both count by their shares.
    pub fn over(&mut self, h: f64) -> Dq {
        let before = ((self.part - self.time) / h).clamp(0.0, 1.0);
        self.time += h;
        let at = |i: usize| self.past.get(i).copied().unwrap_or(Dq::ZERO);
        let [now, earlier] = [at(self.whole), at(self.whole + 1)];
        if before == 0.0 {
            return now;
        }
        now * (1.0 - before) + earlier * before
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What acts in steps of a quarter of a period, of voltages 1, 2, 3, … asked for in turn.
    fn acting(late: f64) -> Vec<f64> {
        let mut line = LateVoltage::new(late, 1.0);
        let mut all = Vec::new();
        for k in 1..=4 {
            line.push(Dq {
                d: 0.0,
                q: f64::from(k),
            });
            all.extend([0; 4].map(|_| line.over(0.25).q));
        }
        all
    }

    #[test]
    fn a_voltage_acts_for_one_period_from_its_time_on() {
        let held = |late: usize| -> Vec<f64> {
            (0..16)
                .map(|i: usize| (4 + i).saturating_sub(late) / 4)
                .map(|k| k as f64)
                .collect()
        };
        for (late, quarters) in [(0.0, 0), (0.25, 1), (0.75, 3), (1.0, 4), (2.5, 10)] {
            assert_eq!(acting(late), held(quarters), "{late}");
        }
        // Half of a step each.
        assert_eq!(acting(0.125)[..6], [0.5, 1.0, 1.0, 1.0, 1.5, 2.0]);
    }
}
