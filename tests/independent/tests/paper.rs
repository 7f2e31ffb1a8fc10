//! The machine without anything hidden gives the paper's tracking errors.

use independent_axis::{Hidden, LoopNoise, Parameters, Random, run, s_curve};

/// Largest and mean tracking error, µm.
fn errors(limits: [f64; 4]) -> [f64; 2] {
    let (p, mut all) = (Parameters::paper(), Vec::new());
    let (none, noise) = (Hidden::default(), LoopNoise::default());
    let mut random = Random::new(1, 0);
    run(&p, &none, &s_curve(limits), &noise, &mut random, |s| {
        all.push(1e6 * (s.wanted.position - s.seen.position).abs());
    })
    .unwrap();
    let most = all.iter().copied().fold(0.0, f64::max);
    [most, all.iter().sum::<f64>() / all.len() as f64]
}

#[test]
fn tracking_errors_are_those_of_the_converged_model() {
    let cases = [
        ([0.3, 0.1, 0.225, 1.2], [54.453, 5.3491]),
        ([0.3, 0.1, 0.225, 1.4], [57.671, 5.3559]),
        ([0.3, 0.1, 0.12, 1.0], [50.888, 3.0319]),
        ([0.3, 0.12, 0.16, 1.0], [50.888, 4.4928]),
    ];
    for (limits, [most, mean]) in cases {
        let got = errors(limits);
        println!("{limits:?}: {got:?} against {:?}", [most, mean]);
        assert!((got[0] - most).abs() < 0.1, "{got:?}, not {most}");
        assert!((got[1] - mean).abs() < 0.03, "{got:?}, not {mean}");
    }
}
