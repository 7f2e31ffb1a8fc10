//! Whether a current loop is stable.
//!
//! A winding under a voltage that is held over the period T, and begins to act n + f periods
//! after its sample (0 ≤ f < 1), is the discrete lag
//!
//! ```text
//! i' = a i + β₀ u(k − n) + β₁ u(k − n − 1),   a = exp(−R T / L)
//! β₀ = (1 − exp(−R (1 − f) T / L)) / R,   β₀ + β₁ = (1 − a) / R
//! ```
//!
//! and with a PI controller, which integrates before it gives its output, the loop's poles are the
//! roots of
//!
//! ```text
//! (z − 1)(z − a) z^(n+1) + ((k_p + k_i T) z − k_p)(β₀ z + β₁)
//! ```
//!
//! Whether all lie inside the unit circle is told by the reflection coefficients of Schur and Cohn.

use crate::SixDigits;
use crate::part::PartError;

/// A winding and when its controller acts on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurrentLoop {
    /// H.
    pub inductance: f64,
    /// Ω.
    pub resistance: f64,
    /// s.
    pub period: f64,
    /// Control periods from a sample until its voltage begins to act.
    pub late: f64,
}

/// Gains that are tried for a stable one, each 0.9 times the last: down to a 1e-9th.
const TRIED: usize = 200;

impl CurrentLoop {
    /// Refuses gains (V/A, V/(A·s)) with which the current is unstable.
    ///
    /// # Errors
    /// [`PartError`] with the gain of the file that is too high, under its `key`.
    pub fn check(&self, key: &'static str, gains: [f64; 2]) -> Result<(), PartError> {
        if self.is_stable(gains) {
            return Ok(());
        }
        let [proportional, integral] = gains;
        let most = self.most(integral);
        let [gain, sum, hertz, millihenry, edge] = [
            proportional,
            integral,
            1.0 / self.period,
            1e3 * self.inductance,
            most,
        ]
        .map(SixDigits);
        let late = match self.late > 0.0 {
            true => format!(
                ", whose voltage begins to act {} periods after its sample,",
                SixDigits(self.late)
            ),
            false => String::new(),
        };
        let too_high = proportional >= most;
        let mut valid = vec!["the frequency of the drive's current controller".to_owned()];
        match too_high && most > 0.0 {
            true => valid.push(format!("less than {edge} V/A")),
            false => valid.push(format!("a smaller integral than {sum} V/(A·s)")),
        }
        if self.late > 0.0 {
            valid.push("a shorter current_delay_periods".to_owned());
        }
        let last = valid.pop().unwrap_or_default();
        Err(PartError::together(
            format!(
                "has a frequency of {hertz} Hz, at which {key} = {gain} V/A makes the current of a winding of {millihenry} mH{late} unstable"
            ),
            format!("{}, or {last}", valid.join(", ")),
        ))
    }

    /// What is left of a current over a period, and β₀ and β₁, A/V.
    fn winding(&self) -> [f64; 3] {
        let part = self.late - self.late.floor();
        // (1 − exp(−R t / L)) / R, which is t / L without resistance.
        let rise = |share: f64| {
            let decay = self.resistance * share * self.period / self.inductance;
            match decay > 1e-9 {
                true => -(-decay).exp_m1() / self.resistance,
                false => share * self.period / self.inductance,
            }
        };
        let kept = (-self.resistance * self.period / self.inductance).exp();
        let newest = rise(1.0 - part);
        [kept, newest, rise(1.0) - newest]
    }

    fn is_stable(&self, [proportional, integral]: [f64; 2]) -> bool {
        if proportional == 0.0 && integral == 0.0 {
            // No loop is closed.
            return true;
        }
        let [a, newest, older] = self.winding();
        let shift = self.late as usize + 1;
        // Rising powers; without an integral, 1/(z − 1) is no part of the loop.
        let (own, controller) = match integral == 0.0 {
            true => (vec![-a, 1.0], vec![proportional]),
            false => {
                let with = proportional + integral * self.period;
                (vec![a, -1.0 - a, 1.0], vec![-proportional, with])
            }
        };
        let mut sum = vec![0.0; shift];
        sum.extend(own);
        for (i, c) in controller.iter().enumerate() {
            sum[i] += c * older;
            sum[i + 1] += c * newest;
        }
        inside_unit_circle(sum)
    }

    /// The highest proportional gain, V/A, with which the loop is stable beside that integral;
    /// 0 if there is none.
    fn most(&self, integral: f64) -> f64 {
        let [a, newest, older] = self.winding();
        // Beyond (1 + a)/b, b = β₀ + β₁, a pole is left of −1 where nothing is late; late by a part f
        // of a period it is so beyond 1/(1 − 2 f) of that, while two leave the circle together
        // beyond about 1/(f b): never both above twice of it. Longer delays leave less.
        let mut high = 3.0 * (1.0 + a) / (newest + older);
        let stable = |p: f64| self.is_stable([p, integral]);
        for _ in 0..TRIED {
            let mut low = 0.9 * high;
            if stable(low) {
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    *(if stable(middle) { &mut low } else { &mut high }) = middle;
                }
                return low;
            }
            high = low;
        }
        0.0
    }
}

/// Whether all roots of a polynomial, its coefficients in rising powers, are inside the unit
/// circle.
fn inside_unit_circle(mut p: Vec<f64>) -> bool {
    while p.len() > 1 {
        let degree = p.len() - 1;
        let reflection = p[0] / p[degree];
        if reflection.is_nan() || reflection.abs() >= 1.0 {
            return false;
        }
        // (p(z) − ρ z^n p(1/z)) / z
        p = (1..=degree)
            .map(|i| p[i] - reflection * p[degree - i])
            .collect();
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a current that is 1 A off is less than that after 4000 periods. The winding goes
    /// in small steps, and each voltage acts from its time on.
    fn settles([p, i]: [f64; 2], w: &CurrentLoop) -> bool {
        let (mut current, mut integral) = (1.0_f64, 0.0);
        let steps = 40;
        let h = w.period / f64::from(steps);
        let late = (w.late * f64::from(steps)).round() as usize;
        let mut under_way = std::collections::VecDeque::from(vec![0.0; late]);
        for _ in 0..4000 {
            integral -= i * w.period * current;
            let voltage = integral - p * current;
            for _ in 0..steps {
                under_way.push_back(voltage);
                let voltage = under_way.pop_front().unwrap();
                let rate = |x: f64| (voltage - w.resistance * x) / w.inductance;
                current += h * rate(current + 0.5 * h * rate(current));
            }
        }
        current.abs() < 1.0
    }

    #[test]
    fn a_gain_is_refused_from_where_the_current_swings_up() {
        let quick = [(2.0, 10_000.0), (0.0, 0.0), (40.0, 0.0), (2.0, 60_000.0)];
        // Beside a longer delay no gain goes with such integrals.
        let slow = [(2.0, 3000.0), (0.0, 0.0), (40.0, 0.0), (2.0, 1000.0)];
        let cases = [(0.0, quick), (0.3, quick), (1.0, slow), (1.75, slow)];
        let each = cases
            .into_iter()
            .flat_map(|(late, gains)| gains.map(|gains| (late, gains)));
        for (late, (resistance, integral)) in each {
            let winding = CurrentLoop {
                inductance: 0.018,
                resistance,
                period: 5e-4,
                late,
            };
            let edge = winding.most(integral);
            let refused = |share: f64| winding.check("p", [share * edge, integral]).is_err();
            let at = |share: f64| settles([share * edge, integral], &winding);
            assert!(edge > 0.0, "{winding:?} {integral}");
            assert!(!refused(0.99) && refused(1.01), "{winding:?} {edge} V/A");
            assert!(at(0.99) && !at(1.01), "{winding:?} {edge} V/A");
        }
    }

    /// k_p T/L = 2 without a delay; 1 with one of a period, z² − z + k = 0; and of two periods
    /// the golden ratio less one, (√5 − 1)/2: z³ − z² + k = 0.
    #[test]
    fn edges_of_a_pure_inductance() {
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        for (late, edge) in [(0.0, 2.0), (1.0, 1.0), (2.0, golden)] {
            let winding = CurrentLoop {
                inductance: 0.02,
                resistance: 0.0,
                period: 1e-4,
                late,
            };
            let found = winding.most(0.0) * 1e-4 / 0.02;
            assert!((found - edge).abs() < 1e-9, "{late}: {found}");
        }
    }

    #[test]
    fn what_is_wrong_is_said() {
        let winding = CurrentLoop {
            inductance: 0.018,
            resistance: 2.0,
            period: 5e-4,
            late: 1.0,
        };
        let said = |gains| winding.check("current_q_proportional", gains).unwrap_err();
        let high = said([90.0, 10_000.0]);
        assert!(high.what.contains("1 periods after its sample"), "{high:?}");
        assert!(high.valid.contains("less than"), "{high:?}");
        assert!(
            high.valid.contains("shorter current_delay_periods"),
            "{high:?}"
        );
        // Too much of the integral, whatever the proportional gain.
        let sum = said([1.0, 1e6]);
        assert!(sum.valid.contains("smaller integral"), "{sum:?}");
    }
}
