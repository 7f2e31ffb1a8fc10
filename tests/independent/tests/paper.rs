//! The machine without anything hidden gives the paper's tracking errors.

#[path = "../../needs.rs"]
mod needs;

use independent_axis::{Hidden, LoopNoise, Machine, Parameters, Random, run, s_curve};

/// Largest and mean tracking error, µm.
fn errors(limits: [f64; 4]) -> [f64; 2] {
    let (p, mut all) = (Parameters::paper(), Vec::new());
    let (none, noise) = (Hidden::default(), LoopNoise::default());
    let mut random = Random::new(1, 0);
    run((&p, &none), &s_curve(limits), (&noise, &mut random), |s| {
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

/// Another program's trajectory 1, where its log lies beside the project.
#[test]
fn trajectory_1_is_that_of_another_program() {
    let Some(file) = needs::shared("golden/trajectory1_published.csv") else {
        return;
    };
    let mut reader = csv::Reader::from_path(file).unwrap();
    let (p, mut all) = (Parameters::paper(), Vec::new());
    let (none, noise) = (Hidden::default(), LoopNoise::default());
    let motion = s_curve([0.3, 0.1, 0.225, 1.2]);
    let mut random = Random::new(1, 0);
    run((&p, &none), &motion, (&noise, &mut random), |s| {
        all.push(*s)
    })
    .unwrap();
    let mut worst = [0.0_f64; 4];
    for (row, sample) in reader.records().zip(all.iter().step_by(10)) {
        let row = row.unwrap();
        let number = |i: usize| row[i].parse::<f64>().unwrap();
        assert!((number(0) - sample.time).abs() < 1e-9);
        let turned = sample.seen.angle - motion.start() / p.travel();
        let seen = &sample.seen;
        let all = [seen.position, turned, seen.speed, seen.current[1]];
        for (place, value) in all.into_iter().enumerate() {
            worst[place] = worst[place].max((value - number(2 + place)).abs());
        }
    }
    println!("position, angle, speed, q current off by at most {worst:?}");
    // The limit cycle near standstill loses its phase first: 0.02 µm is the agreement that
    // the two programs have in their largest errors.
    assert!(worst[0] < 2e-8, "{worst:?}");
    assert!(
        worst[1] < 2e-5 && worst[2] < 1e-2 && worst[3] < 2e-2,
        "{worst:?}"
    );
}

/// Half the control period's share of steps does not exist from outside; so the machine
/// itself is stepped at 10 and at 5 µs under the same voltages.
#[test]
fn steps_of_10_us_are_short_enough() {
    let p = Parameters::paper();
    let after = |step: f64, steps: usize| {
        let mut machine = Machine::new(&p, Hidden::default(), 0.6, 0.0, step);
        for k in 0..steps {
            let t = k as f64 * step;
            // One and a half ampere, so that the table breaks away and slides.
            let voltage = if t < 0.1 { [0.0, 1.5] } else { [0.0, 0.3] };
            machine.step(voltage).unwrap();
        }
        machine.seen()
    };
    let [coarse, fine, finer] = [1, 2, 4].map(|n| after(1e-5 / n as f64, 20_000 * n));
    let [rough, better] = [coarse, fine].map(|m| (m.position - finer.position).abs());
    println!("off by {rough:e} m at 10 µs, {better:e} m at 5 µs");
    assert!(rough < 1e-9, "{rough:e}");
    // Of second order: (1 − 1/16) / (1/4 − 1/16) = 5.
    assert!(rough > 3.0 * better, "{rough:e}, {better:e}");
}
