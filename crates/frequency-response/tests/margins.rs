use std::f64::consts::{PI, TAU};

use frequency_response::{Complex, LoopLine, LoopMargins};

fn lines(of: impl Fn(Complex<f64>) -> Complex<f64>, from: f64, to: f64) -> Vec<LoopLine> {
    let at = |i: usize| {
        let frequency_hz = from * (to / from).powf(f64::from(i as u32) / 4000.0);
        let value = of(Complex::new(0.0, TAU * frequency_hz));
        LoopLine {
            frequency_hz,
            value,
            deviation: 0.01,
        }
    };
    (0..=4000).map(at).collect()
}

/// a e^{−sτ}/s: crossover a, phase margin π/2 − aτ, gain margin π/(2aτ), delay margin π/2a − τ.
#[test]
fn an_integrator_with_delay() {
    let (a, tau) = (100.0, 4e-3);
    let found = LoopMargins::of(&lines(|s| a / s * (-s * tau).exp(), 0.1, 1000.0)).unwrap();
    let near = |found: Option<f64>, truth: f64| (found.unwrap() / truth - 1.0).abs() < 1e-4;
    assert!(near(found.crossover_hz, a / TAU));
    assert!(near(found.phase, 0.5 * PI - a * tau));
    assert!(near(found.phase_deg(), 90.0 - a * tau * 180.0 / PI));
    assert!(near(found.gain_up, 0.5 * PI / (a * tau)));
    assert!(near(found.delay_s, 0.5 * PI / a - tau));
    assert!(found.gain_down.is_none());
}

/// k/(s(s + 1)): |1 + L|² = (w² − 2kw + k² + w)/(w² + w) with w = ω², so its least is at the positive root of
/// k w² − k² w − k²/2; the standard deviation is |S|² times that of L.
#[test]
fn the_greatest_sensitivity() {
    let k = 2.0;
    let found = LoopMargins::of(&lines(|s| k / (s * (s + 1.0)), 1e-3, 10.0)).unwrap();
    let w = 0.5 * (k + (k * k + 2.0 * k).sqrt());
    let least = (w * w - 2.0 * k * w + k * k + w) / (w * w + w);
    let truth = 1.0 / least.sqrt();
    assert!(
        (found.sensitivity.value / truth - 1.0).abs() < 1e-5,
        "{found:?} {truth}"
    );
    assert!((found.sensitivity.frequency_hz * TAU / w.sqrt() - 1.0).abs() < 3e-3);
    let deviation = found.sensitivity.value.powi(2) * 0.01;
    assert!((found.sensitivity.deviation - deviation).abs() < 1e-12);
}

/// k(s + 1)²/s³ is stable for k above 1/2 alone: at ω = 1 it is −2k, so the gain may fall to 1/(2k).
#[test]
fn a_conditionally_stable_loop_has_a_lower_margin() {
    let k = 2.0;
    let found = LoopMargins::of(&lines(
        |s| (s + 1.0) * (s + 1.0) * k / (s * s * s),
        1e-2,
        100.0,
    ))
    .unwrap();
    assert!((found.gain_down.unwrap() - 0.25).abs() < 1e-4, "{found:?}");
    assert!(found.gain_up.is_none());
}
