//! Low-pass filters without phase, and derivatives.

use std::f64::consts::PI;

/// A fourth-order Butterworth low-pass, run forward and back: gain 1/(1 + (f/f_c)⁸), no
/// phase.
#[derive(Clone, Copy, Debug)]
pub(super) struct LowPass {
    sections: [Section; 2],
    /// Samples by which a series is continued at either end.
    reach: usize,
}

/// One pair of poles: b₀ (1 + z⁻¹)² / (1 + a₁ z⁻¹ + a₂ z⁻²).
#[derive(Clone, Copy, Debug)]
struct Section {
    b: f64,
    a: [f64; 2],
}

impl LowPass {
    /// With −6 dB (forward and back) at `cutoff`, in cycles per sample, below 0.5.
    pub fn new(cutoff: f64) -> Self {
        let cutoff = cutoff.min(0.49);
        let k = (PI * cutoff).tan();
        let section = |part: f64| {
            // 1/Q of a Butterworth pair of poles.
            let damping = 2.0 * (part * PI / 8.0).cos();
            let norm = 1.0 / (1.0 + k * damping + k * k);
            Section {
                b: k * k * norm,
                a: [
                    2.0 * (k * k - 1.0) * norm,
                    (1.0 - k * damping + k * k) * norm,
                ],
            }
        };
        Self {
            sections: [section(1.0), section(3.0)],
            // The slower poles decay by e^(−7) in three periods of the cut-off.
            reach: (3.0 / cutoff).ceil() as usize,
        }
    }

    /// The series filtered; its ends are continued by their point reflection.
    pub fn apply(&self, series: &[f64]) -> Vec<f64> {
        let n = series.len();
        if n < 2 {
            return series.to_vec();
        }
        let reach = self.reach.min(n - 1);
        let (first, last) = (series[0], series[n - 1]);
        let before = (1..=reach).rev().map(|k| 2.0 * first - series[k]);
        let after = (1..=reach).map(|k| 2.0 * last - series[n - 1 - k]);
        let mut all: Vec<f64> = before.chain(series.iter().copied()).chain(after).collect();
        for _ in 0..2 {
            for section in &self.sections {
                section.run(&mut all);
            }
            all.reverse();
        }
        all[reach..reach + n].to_vec()
    }
}

impl Section {
    /// Runs it over a series, settled on its first value.
    fn run(&self, series: &mut [f64]) {
        let Some(&first) = series.first() else {
            return;
        };
        let [a1, a2] = self.a;
        let mut kept = [(1.0 - self.b) * first, (self.b - a2) * first];
        for value in series {
            let x = *value;
            let y = self.b * x + kept[0];
            kept = [2.0 * self.b * x - a1 * y + kept[1], self.b * x - a2 * y];
            *value = y;
        }
    }
}

/// Derivative by central differences over five points: off by (2πf h)⁴/30, 0.5 % at a tenth
/// of the sampling rate and 0.01 % at a twenty-fifth. At the ends over fewer points.
pub(super) fn derivative(series: &[f64], h: f64) -> Vec<f64> {
    let n = series.len();
    let at = |k: usize| {
        if k >= 2 && k + 2 < n {
            let near = series[k + 1] - series[k - 1];
            let far = series[k + 2] - series[k - 2];
            return (8.0 * near - far) / (12.0 * h);
        }
        let (from, to) = (k.saturating_sub(1), (k + 1).min(n - 1));
        (series[to] - series[from]) / (h * (to - from).max(1) as f64)
    };
    (0..n).map(at).collect()
}

/// Integral from the first sample on, by trapezoids.
pub(super) fn integral(series: &[f64], h: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let steps = series.windows(2).map(|w| 0.5 * h * (w[0] + w[1]));
    let sums = steps.map(|step| {
        sum += step;
        sum
    });
    std::iter::once(0.0)
        .chain(sums)
        .take(series.len())
        .collect()
}

/// The series `by` samples later, through four neighbours (Lagrange); held at the ends.
pub(super) fn ahead(series: Vec<f64>, by: f64) -> Vec<f64> {
    if by == 0.0 || series.is_empty() {
        return series;
    }
    let last = series.len() as i64 - 1;
    let whole = by.floor();
    let p = by - whole;
    let weights = [
        -p * (p - 1.0) * (p - 2.0) / 6.0,
        (p + 1.0) * (p - 1.0) * (p - 2.0) / 2.0,
        -(p + 1.0) * p * (p - 2.0) / 2.0,
        (p + 1.0) * p * (p - 1.0) / 6.0,
    ];
    let at = |k: i64| series[k.clamp(0, last) as usize];
    let one = |k: i64| {
        let from = k.saturating_add(whole as i64);
        let near = (-1..3).zip(weights);
        near.map(|(i, w)| w * at(from.saturating_add(i))).sum()
    };
    (0..=last).map(one).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::{LowPass, ahead, derivative, integral};

    fn sine(frequency: f64, n: usize) -> Vec<f64> {
        (0..n).map(|k| (TAU * frequency * k as f64).sin()).collect()
    }

    /// Amplitude of a sine after a map, and its phase, from the middle of the series.
    fn answer(frequency: f64, map: impl Fn(&[f64]) -> Vec<f64>) -> [f64; 2] {
        let n = 4000;
        let out = map(&sine(frequency, n));
        let (mut re, mut im) = (0.0, 0.0);
        for (k, value) in out.iter().enumerate().take(3000).skip(1000) {
            let (sin, cos) = (TAU * frequency * k as f64).sin_cos();
            re += value * sin / 1000.0;
            im += value * cos / 1000.0;
        }
        [re, im]
    }

    #[test]
    fn the_filter_has_its_gain_and_no_phase() {
        let filter = LowPass::new(0.05);
        for frequency in [0.005_f64, 0.02, 0.05, 0.08] {
            let [re, im] = answer(frequency, |s| filter.apply(s));
            // The bilinear transform warps frequencies.
            let ratio = (TAU * frequency / 2.0).tan() / (TAU * 0.05 / 2.0).tan();
            assert!(
                (re - 1.0 / (1.0 + ratio.powi(8))).abs() < 1e-6,
                "{frequency}: {re}"
            );
            assert!(im.abs() < 1e-6, "{frequency}: {im}");
        }
    }

    #[test]
    fn straight_lines_stay_to_the_ends() {
        let line: Vec<f64> = (0..500).map(|k| 3.0 + 0.1 * f64::from(k)).collect();
        let out = LowPass::new(0.02).apply(&line);
        let worst = line.iter().zip(&out).map(|(a, b)| (a - b).abs());
        assert!(worst.fold(0.0, f64::max) < 1e-3);
    }

    #[test]
    fn derivative_and_shift_are_those_of_a_sine() {
        let w = TAU * 0.04;
        let [re, im] = answer(0.04, |s| derivative(s, 1.0));
        assert!(re.abs() < 1e-9 && (im / w - 1.0).abs() < w.powi(4) / 29.0);
        let [re, im] = answer(0.02, |s| ahead(s.to_vec(), 2.5));
        let turned = TAU * 0.02 * 2.5;
        assert!((re - turned.cos()).abs() < 1e-4 && (im - turned.sin()).abs() < 1e-4);
        let cubic: Vec<f64> = (0..50).map(|k| f64::from(k).powi(3)).collect();
        assert!((ahead(cubic, 0.3)[20] - 20.3_f64.powi(3)).abs() < 1e-9);
    }

    #[test]
    fn the_integral_of_a_line_is_its_parabola() {
        let line: Vec<f64> = (0..11).map(f64::from).collect();
        assert!((integral(&line, 0.1)[10] - 5.0).abs() < 1e-12);
    }
}
