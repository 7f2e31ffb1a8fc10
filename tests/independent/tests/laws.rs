//! Hidden terms and noise keep the laws that they stand for.

use independent_axis::cases::{CASES, named};
use independent_axis::{
    Bump, Columns, Friction, Hidden, Logger, LoopNoise, Machine, Motion, Parameters, Random,
    Sample, exercises, run,
};

fn samples(hidden: &Hidden, motion: &Motion) -> Vec<Sample> {
    let (p, mut all) = (Parameters::paper(), Vec::new());
    let noise = LoopNoise::default();
    let mut random = Random::new(1, 0);
    run((&p, hidden), motion, (&noise, &mut random), |s| {
        all.push(*s)
    })
    .unwrap();
    all
}

/// Mean of the q current over a stretch of time, A.
fn current(all: &[Sample], from: f64, to: f64) -> f64 {
    let inside = all.iter().filter(|s| (from..to).contains(&s.time));
    let (sum, n) = inside.fold((0.0, 0), |(sum, n), s| (sum + s.seen.current[1], n + 1));
    sum / f64::from(n)
}

/// In even motion the torque balances friction: K_t i = G(ω) + σ2 ω + r · hidden force.
#[test]
fn in_even_motion_the_current_carries_all_friction() {
    let p = Parameters::paper();
    let friction = Friction {
        viscous: 3000.0,
        forward: 50.0,
        backward: 20.0,
        load: 100.0,
        ..Friction::default()
    };
    let hidden = Hidden {
        friction,
        ..Hidden::default()
    };
    let speed = 0.08;
    for (sign, dry) in [(1.0, 50.0), (-1.0, 20.0)] {
        let motion = Motion::from(0.7).rest(0.2).by(sign * 0.16, speed, 0.3);
        // Once the integral of the speed's controller has settled.
        let seen = current(&samples(&hidden, &motion), 1.9, 2.1);
        let (w, r) = (speed / p.travel(), p.travel());
        let own = p.coulomb + p.viscous * w;
        let torque = sign * (own + r * (dry + 3000.0 * speed)) + r * 100.0;
        let off = seen * p.torque_constant / torque - 1.0;
        println!("{sign}: {seen} A, off by {off:e}");
        assert!(off.abs() < 2e-3, "{off:e}");
    }
}

/// Forward and backward of a machine without a sense of direction mirror each other.
#[test]
fn motion_the_other_way_is_mirrored() {
    let hidden = Hidden {
        backlash: 5e-6,
        ..Hidden::default()
    };
    let to = |sign: f64| {
        let motion = Motion::from(0.75).rest(0.05).by(sign * 0.02, 0.1, 0.1);
        samples(&hidden, &motion)
    };
    // Nearer to the motor the screw is stiffer: the way is mirrored but for that.
    for (a, b) in to(1.0).iter().zip(&to(-1.0)) {
        let apart = (a.seen.position - 0.75) + (b.seen.position - 0.75);
        assert!(apart.abs() < 5e-8, "{apart:e} at {}", a.time);
    }
}

/// Within its gap the screw turns without the table.
#[test]
fn backlash_is_turned_through_before_the_table_moves() {
    let p = Parameters::paper();
    let gap = 40e-6;
    let hidden = Hidden {
        backlash: gap,
        ..Hidden::default()
    };
    let mut machine = Machine::new(&p, hidden, 0.6, 0.0, 1e-5);
    let origin = machine.seen().angle;
    let way = |m: &Machine| p.travel() * (m.seen().angle - origin);
    while way(&machine) < 0.49 * gap {
        assert!(machine.seen().position == 0.6);
        machine.step([0.0, 1.0]).unwrap();
    }
    while way(&machine) < 0.7 * gap {
        machine.step([0.0, 1.0]).unwrap();
    }
    assert!(machine.seen().position > 0.6);
}

#[test]
fn a_bump_is_highest_at_its_centre_and_turns_with_the_speed() {
    let b = Bump {
        peak: 100.0,
        centre: 0.7,
        width: 0.05,
    };
    let friction = Friction {
        bump: Some(b),
        ..Friction::default()
    };
    let at = |x, v| friction.force(1.0, x, v);
    assert!((at(0.7, 0.1) - 100.0).abs() < 1e-9);
    assert!((at(0.75, 0.1) - 100.0 * (-0.5_f64).exp()).abs() < 1e-9);
    assert_eq!(at(0.72, 0.1), -at(0.72, -0.1));
    assert_eq!(at(0.7, 0.0), 0.0);
}

#[test]
fn normal_numbers_have_the_moments_of_their_law() {
    let (mut random, n) = (Random::new(3, 1), 200_000);
    let all: Vec<f64> = (0..n).map(|_| random.normal()).collect();
    let moment = |k: i32| all.iter().map(|x| x.powi(k)).sum::<f64>() / f64::from(n);
    // Four standard deviations of each mean: √(var x^k / n).
    let bound = |variance: f64| 4.0 * (variance / f64::from(n)).sqrt();
    assert!(moment(1).abs() < bound(1.0));
    assert!((moment(2) - 1.0).abs() < bound(2.0));
    assert!(moment(3).abs() < bound(15.0));
    assert!((moment(4) - 3.0).abs() < bound(96.0));
}

/// The logger's noise has its size, and its neighbours are alike as asked.
#[test]
fn the_logger_adds_what_it_says() {
    let all = samples(&Hidden::default(), &Motion::from(0.6).rest(20.0));
    for colour in [0.0, 0.9] {
        let logger = Logger {
            colour,
            ..Logger::NOISY
        };
        let table = logger.log(&all, Columns::Few, &mut Random::new(5, 2));
        assert_eq!(table.names, ["t_s", "position_ref_m", "position_m", "iq_a"]);
        let x: Vec<f64> = table.rows.iter().map(|r| r[3]).collect();
        let n = x.len() as f64;
        let variance = x.iter().map(|x| x * x).sum::<f64>() / n;
        let alike = x.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / n / variance;
        // Samples that are alike count as fewer.
        let counted = n * (1.0 - colour * colour) / (1.0 + colour * colour);
        let bound = 4.0 * (2.0 / counted).sqrt();
        assert!((variance / 4e-4 - 1.0).abs() < bound, "{variance}");
        assert!((alike - colour).abs() < bound, "{alike}");
    }
}

#[test]
fn the_same_seed_gives_the_same_log_and_another_another() {
    let motion = Motion::from(0.6).rest(0.02).by(1e-4, 0.01, 0.01);
    let log = |seed| {
        let mut random = Random::new(seed, 7);
        let (p, mut all) = (Parameters::paper(), Vec::new());
        let none = Hidden::default();
        run((&p, &none), &motion, (&LoopNoise::GOOD, &mut random), |s| {
            all.push(s.seen)
        })
        .unwrap();
        all
    };
    assert_eq!(log(1), log(1));
    assert_ne!(log(1), log(2));
}

/// No stretch of a motion is spent at the speeds at which the axis vibrates by itself, and
/// velocity is the slope of position.
#[test]
fn motions_are_smooth_and_keep_away_from_the_vibration() {
    for (name, motion) in exercises() {
        let (mut even, h) = (0.0, 1e-4);
        let mut last = motion.at(0.0);
        for k in 1..=(motion.duration() / h) as usize {
            let next = motion.at(k as f64 * h);
            let slope = (next.position - last.position) / h;
            let middle = f64::midpoint(next.velocity, last.velocity);
            assert!((slope - middle).abs() < 1e-5, "{name} at {}", k as f64 * h);
            let change = (next.velocity - last.velocity).abs() / h;
            let slow = (0.003..0.007).contains(&next.velocity.abs());
            even = if slow && change < 1e-3 { even + h } else { 0.0 };
            assert!(even < 0.02, "{name} at {}", k as f64 * h);
            last = next;
        }
    }
}

#[test]
fn cases_have_names_and_streams_of_their_own() {
    for (i, case) in CASES.iter().enumerate() {
        assert_eq!(named(case.name).unwrap().words, case.words);
        let apart =
            |c: &independent_axis::cases::Case| c.name != case.name && c.stream != case.stream;
        assert!(CASES[..i].iter().all(apart), "{}", case.name);
    }
    let refused = named("loop-nothin").unwrap_err().to_string();
    assert!(refused.contains("loop-nothing"), "{refused}");
}
