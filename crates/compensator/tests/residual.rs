//! What no parameter holds: found from records made here, and left alone where it is noise.
#![cfg(feature = "identify")]
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use cfnn::{Network, Scaling, Shape};
use compensator::{
    HARMONICS, NETWORK_INPUTS, NetworkBasis, Residual, ResidualAt, ResidualBasis, ResidualLearner,
    ResidualModel, Unexplained, over_gaussian,
};
use proptest::prelude::*;

const TRAVEL: f64 = 0.01 / std::f64::consts::TAU;
const STROKE: [f64; 2] = [0.0, 1.5];
const COULOMB: f64 = 0.68;
const SMOOTHING: f64 = 1.5e-3;
const SPACING: f64 = 1e-3;

/// Cogging of 11 periods a turn, more friction near 0.7 m, a spring about 0.75 m.
fn truth(angle: f64, position: f64, direction: f64) -> f64 {
    let bump = 30.0 * (-((position - 0.7) / 0.03).powi(2)).exp();
    let spring = 40.0 * (position - 0.75);
    0.04 * (11.0 * angle + 0.6).cos() + TRAVEL * (direction * bump + spring)
}

struct Noise(u64);

impl Noise {
    /// Nearly normal, of deviation 1.
    fn next(&mut self) -> f64 {
        let mut sum = -6.0;
        for _ in 0..12 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            sum += (self.0 >> 11) as f64 / (1_u64 << 53) as f64;
        }
        sum
    }
}

/// White noise of this deviation behind the Gaussian that torques pass.
fn smoothed(noise: &mut Noise, deviation: f64, count: usize) -> Vec<f64> {
    let reach = (4.0 * SMOOTHING / SPACING).ceil() as usize;
    let white: Vec<f64> = (0..count + 2 * reach)
        .map(|_| deviation * noise.next())
        .collect();
    let weight = |i: usize| {
        let away = (i as f64 - reach as f64) * SPACING / SMOOTHING;
        (-0.5 * away * away).exp()
    };
    let weights: Vec<f64> = (0..=2 * reach).map(weight).collect();
    let whole: f64 = weights.iter().sum();
    let behind = |window: &[f64]| -> f64 { window.iter().zip(&weights).map(|(n, w)| n * w).sum() };
    white
        .windows(weights.len())
        .map(|window| behind(window) / whole)
        .collect()
}

/// A move there and back at one speed, torque and noise behind the Gaussian.
fn move_at(speed: f64, noise: &mut Noise, deviation: f64, scale: f64) -> Vec<Unexplained> {
    let one_way = 0.3 / speed;
    let count = (2.0 * one_way / SPACING) as usize;
    let noise = smoothed(noise, deviation, count);
    (0..count)
        .map(|k| {
            let t = k as f64 * SPACING;
            let (position, direction) = if t < one_way {
                (0.6 + speed * t, 1.0)
            } else {
                (0.9 - speed * (t - one_way), -1.0)
            };
            let angle = position / TRAVEL + 0.3;
            let motor_speed = direction * speed / TRAVEL;
            // Only the cogging varies within the Gaussian.
            let gain = (-0.5 * (11.0 * motor_speed * SMOOTHING).powi(2)).exp();
            let cogging = 0.04 * (11.0 * angle + 0.6).cos();
            let smooth = truth(angle, position, direction) + (gain - 1.0) * cogging;
            Unexplained {
                position,
                motor_angle: angle,
                motor_speed,
                direction,
                torque: scale * smooth + noise[k],
            }
        })
        .collect()
}

fn learner() -> ResidualLearner {
    ResidualLearner::new(STROKE, TRAVEL, COULOMB)
}

#[test]
fn torque_over_angle_and_force_over_position_are_found() {
    let (mut learner, mut noise) = (learner(), Noise(3));
    for (i, speed) in [0.05, 0.08, 0.06, 0.1].into_iter().enumerate() {
        let explained = learner.learn(&move_at(speed, &mut noise, 0.008, 1.0), SPACING, SMOOTHING);
        // A new move was explained before it was learned from, but for the first.
        assert!(i == 0 || explained > 0.8, "{i} {explained}");
    }
    let model = learner.model().unwrap();
    let (mut worst, mut most) = (0.0_f64, 0.0_f64);
    for k in 0..3000 {
        let position = 0.62 + 0.26 * f64::from(k) / 3000.0;
        let angle = position / TRAVEL + 0.3;
        for direction in [-1.0, 1.0] {
            let [torque, force] = model.at(angle, position, direction);
            let wanted = truth(angle, position, direction);
            worst = worst.max((torque + TRAVEL * force - wanted).abs());
            most = most.max(wanted.abs());
        }
    }
    assert!(worst < 0.08 * most, "{worst} of {most}");
    // Where it has not been it adds next to nothing but the cogging.
    let [_, force] = model.at(0.0, 0.2, 1.0);
    assert!((TRAVEL * force).abs() < 0.02, "{force}");
}

#[test]
fn noise_is_not_learned_and_what_stops_helping_is_not_used() {
    let (mut nothing, mut noise) = (learner(), Noise(11));
    for _ in 0..5 {
        nothing.learn(&move_at(0.1, &mut noise, 0.01, 0.0), SPACING, SMOOTHING);
        assert!(nothing.model().is_none());
    }
    let mut changed = learner();
    for _ in 0..3 {
        changed.learn(&move_at(0.08, &mut noise, 0.005, 1.0), SPACING, SMOOTHING);
    }
    assert!(changed.model().is_some());
    // Another machine: the opposite of what was learned.
    changed.learn(&move_at(0.08, &mut noise, 0.005, -1.0), SPACING, SMOOTHING);
    assert!(changed.model().is_none(), "{:?}", changed.explained());
}

/// A spring is predicted, and with it most of the power; what changes within 10 ms, seven and a
/// bit to a turn, is not.
#[test]
fn what_leaves_the_changes_is_not_used() {
    let mut learner = learner();
    for speed in [0.05, 0.08, 0.06, 0.1, 0.07] {
        let mut log = move_at(speed, &mut Noise(7), 0.0, 0.0);
        for u in &mut log {
            let spring = TRAVEL * 400.0 * (u.position - 0.75);
            u.torque = spring + 0.05 * (7.37 * u.motor_angle + 30.0 * speed).cos();
        }
        let explained = learner.learn(&log, SPACING, SMOOTHING);
        assert!(
            learner.explained().len() < 2 || explained > 0.6,
            "{explained}"
        );
        assert!(learner.model().is_none(), "{:?}", learner.explained());
    }
}

/// Hidden layers of no training, and machines that have a torque of the angle and a force of
/// the position, in shares of their own.
/// What a friction law leaves while bristles are loaded is neither learned nor judged by: moves
/// that all begin at one place would put it there.
#[test]
fn what_is_left_while_bristles_are_loaded_does_not_count() {
    let (mut all, mut sliding) = (learner(), learner());
    let mut noise = Noise(5);
    for speed in [0.03, 0.05, 0.08, 0.06] {
        let log = move_at(speed, &mut noise, 0.004, 1.0);
        let mut loaded: Vec<Unexplained> = log[..60].to_vec();
        for (k, u) in loaded.iter_mut().enumerate() {
            u.direction = 0.015 * k as f64;
            u.torque += 0.4;
        }
        loaded.extend_from_slice(&log);
        let shares = [(&mut all, &loaded), (&mut sliding, &log)]
            .map(|(learner, log)| learner.learn(log, SPACING, SMOOTHING));
        assert_eq!(shares[0], shares[1]);
    }
    assert_eq!(all.coefficients(), sliding.coefficients());
    assert!(all.model().is_some());
}

fn network_basis() -> NetworkBasis {
    let shape = Shape {
        inputs: NETWORK_INPUTS,
        hidden: vec![24],
        outputs: 2,
    };
    let mut noise = Noise(5);
    let weights = (0..shape.parameters()).map(|_| 1.5 * noise.next());
    let ranges = [
        (0.5, 1.0),
        (-1.0, 1.0),
        (-1.0, 1.0),
        (-70.0, 70.0),
        (-1.0, 1.0),
    ];
    let scaling = Scaling::from_ranges(&ranges, &[(-1.0, 1.0); 2]).unwrap();
    let network = Network::new(shape.clone(), scaling, weights.collect()).unwrap();
    let states: Vec<Unexplained> = (0..600)
        .map(|_| Unexplained {
            position: 0.75 + 0.08 * noise.next(),
            motor_angle: 3.0 * noise.next(),
            motor_speed: 30.0 * noise.next(),
            direction: noise.next().signum(),
            torque: 0.0,
        })
        .collect();
    let machines: Vec<_> = (0..60)
        .map(|_| {
            let [cogging, force] = [0.02 * noise.next(), 15.0 * noise.next()];
            states.iter().map(|u| machine(u, cogging, force)).collect()
        })
        .collect();
    NetworkBasis::new(&network, TRAVEL, 0.05, &states, &machines).unwrap()
}

fn machine(u: &Unexplained, cogging: f64, force: f64) -> [f64; 2] {
    [
        cogging * (u.motor_angle + 0.3).sin(),
        force * u.direction * (1.0 + (u.position - 0.75) / 0.2),
    ]
}

/// Of a machine of the family a move or two tell the share of torque and of force, though a log
/// has only their sum; noise alone is never used.
#[test]
fn a_network_of_other_machines_needs_few_moves() {
    let mut learner = ResidualLearner::of(network_basis(), COULOMB);
    let mut nothing = learner.clone();
    let mut noise = Noise(9);
    let [cogging, force] = [0.03, -20.0];
    for _ in 0..2 {
        let mut log = move_at(0.08, &mut noise, 0.004, 0.0);
        nothing.learn(&log, SPACING, SMOOTHING);
        assert!(nothing.model().is_none());
        for u in &mut log {
            let [mut torque, mut push] = [0.0; 2];
            over_gaussian(u, TRAVEL, SMOOTHING, |there, weight| {
                let [t, f] = machine(there, cogging, force);
                torque += weight * t;
                push += weight * f;
            });
            u.torque += torque + TRAVEL * push;
        }
        learner.learn(&log, SPACING, SMOOTHING);
    }
    assert!(learner.explained()[1] > 0.8, "{:?}", learner.explained());
    let mut network = learner.model().cloned().flatten().unwrap();
    let (mut off, mut size) = ([0.0; 2], [0.0; 2]);
    for u in move_at(0.1, &mut noise, 0.0, 0.0) {
        let found = network.besides(&at(&u));
        let wanted = machine(&u, cogging, force);
        for i in 0..2 {
            off[i] += (found[i] - wanted[i]).powi(2);
            size[i] += wanted[i].powi(2);
        }
    }
    assert!(
        off[0] < 0.1 * size[0] && off[1] < 0.1 * size[1],
        "{off:?} of {size:?}"
    );
}

fn at(u: &Unexplained) -> ResidualAt {
    ResidualAt {
        motor_angle: u.motor_angle,
        motor_speed: u.motor_speed,
        position: u.position,
        direction: u.direction,
    }
}

/// What is fitted is what is used: the equation of an instant is the network's own answer.
#[test]
fn the_network_is_the_sum_of_its_output_layer() {
    let mut basis = network_basis();
    let mut noise = Noise(21);
    let coefficients: Vec<f64> = (0..basis.size()).map(|_| noise.next()).collect();
    let mut network = basis.model(&coefficients).unwrap();
    for u in move_at(0.05, &mut noise, 0.0, 0.0).iter().step_by(50) {
        let row = basis.row(u, 0.0).times(&coefficients);
        let [torque, force] = network.besides(&at(u));
        assert!((row - (torque + TRAVEL * force)).abs() < 1e-12, "{row}");
    }
}

/// A harmonic behind a Gaussian is smaller by e^(−(nωσ)²/2).
#[test]
fn the_average_over_a_gaussian_is_that_of_a_harmonic() {
    for turned in [0.0, 0.5, 2.0, 4.0_f64] {
        let u = Unexplained {
            motor_angle: 0.7,
            motor_speed: turned / SMOOTHING,
            ..Unexplained::default()
        };
        let mut mean = 0.0;
        over_gaussian(&u, TRAVEL, SMOOTHING, |there, weight| {
            mean += weight * there.motor_angle.cos();
        });
        let wanted = (-0.5 * turned * turned).exp() * 0.7_f64.cos();
        assert!((mean - wanted).abs() < 1e-3, "{turned}: {mean} {wanted}");
    }
}

#[test]
fn what_is_no_number_is_passed_over() {
    let mut learner = learner();
    let poor = vec![
        Unexplained {
            torque: f64::NAN,
            ..Unexplained::default()
        };
        50
    ];
    assert_eq!(learner.learn(&poor, SPACING, SMOOTHING), 0.0);
    assert_eq!(learner.learn(&[], SPACING, SMOOTHING), 0.0);
    assert!(learner.model().is_none());
}

proptest! {
    /// The harmonics by recurrence are those by their sines and cosines.
    #[test]
    fn harmonics_are_what_they_say(
        pairs in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), HARMONICS),
        angle in -1e3..1e3_f64,
    ) {
        let mut model = ResidualModel::none(STROKE);
        for (slot, (a, b)) in model.harmonics.iter_mut().zip(&pairs) {
            *slot = [*a, *b];
        }
        let wanted: f64 = (1..).zip(&pairs).map(|(n, (a, b))| {
            let (sin, cos) = (f64::from(n) * angle).sin_cos();
            a * cos + b * sin
        }).sum();
        let [torque, force] = model.at(angle, 0.5, 0.0);
        prop_assert!((torque - wanted).abs() < 1e-9);
        prop_assert_eq!(force, 0.0);
        let [single, _] = model.cast::<f32>().at(angle as f32, 0.5, 0.0);
        prop_assert!((f64::from(single) - wanted).abs() < 0.05);
    }
}
