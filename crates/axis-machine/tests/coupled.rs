//! Squareness, straightness and cross-talk: against the closed forms on a circle.

use std::sync::Arc;

use axis_machine::{
    AxisCoupling, AxisMotion, CoupledMachine, Coupling, Lap, Laps, MachineError, Straightness,
};
use axis_pipeline::strategies::{NONE, Predictors};
use axis_sim::Axis;
use toolpath::named::CircleTest;
use toolpath::{FeedLimits, FeedProfile};
use trajectories::Motion;

pub fn stage() -> Axis {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../data/axes/linear-stage.toml"
    );
    Axis::read(file.as_ref()).unwrap()
}

pub fn circle(radius: f64, feed: f64) -> (Arc<FeedProfile<2>>, (f64, f64)) {
    let circle = CircleTest::new(radius).path().unwrap();
    let limits = FeedLimits::equal(feed, feed, 1.0, 20.0);
    (
        Arc::new(FeedProfile::plan(&circle.path, &limits).unwrap()),
        circle.counted,
    )
}

pub fn x_by_y(squareness: f64, crosstalk: f64) -> Coupling {
    let pair = AxisCoupling {
        of: 0,
        by: 1,
        squareness,
        crosstalk,
        straightness: None,
    };
    Coupling::new(vec![pair]).unwrap()
}

/// A lap without compensation.
pub fn bare(
    machine: &CoupledMachine<2>,
    profile: &Arc<FeedProfile<2>>,
    correction: Option<Coupling>,
) -> Lap<2> {
    let strategies = machine.drives().iter().map(|drive| {
        NONE.strategy(&Predictors::of(drive.closed_loop.axis()))
            .unwrap()
    });
    let mut laps = Laps::new(machine, strategies.collect()).unwrap();
    if let Some(coupling) = correction {
        laps = laps.correcting(coupling);
    }
    laps.lap(profile).unwrap().lap
}

/// Radial deviations of the counted turn from a circle about 0.
pub fn radial(lap: &Lap<2>, counted: (f64, f64), radius: f64) -> Vec<(f64, f64)> {
    let of = |&[x, y]: &[f64; 2]| (y.atan2(x), x.hypot(y) - radius);
    lap.traced.between(counted).iter().map(of).collect()
}

#[test]
fn without_anything_between_them_axes_run_as_alone() {
    let stage = stage();
    let machine = CoupledMachine::new([&stage, &stage]).unwrap();
    let (profile, _) = circle(0.01, 0.05);
    let lap = bare(&machine, &profile, None);
    let loops = axis_sim::ClosedLoop::new(&stage).unwrap();
    let none = || Box::new(compensator::NoCompensation);
    let driven = [0, 1].map(|_| axis_machine::Driven::new(&loops, none()));
    let alone = axis_machine::trace(&profile, driven).unwrap();
    assert_eq!(lap.traced.positions(), alone.positions());
    assert_eq!(lap.records.len(), 2);
    assert_eq!(lap.records[1].len(), alone.positions().len());
}

/// φ gives ½ φ R sin 2θ, k gives −½ k (v²/R) sin 2θ: what the coupled machine has beside the bare one.
#[test]
fn squareness_and_crosstalk_deform_a_circle_as_the_closed_form_says() {
    let stage = stage();
    let bare_machine = CoupledMachine::new([&stage, &stage]).unwrap();
    let (radius, feed) = (0.02, 0.1);
    let (profile, counted) = circle(radius, feed);
    let reference = radial(&bare(&bare_machine, &profile, None), counted, radius);
    let rate = feed * feed / radius;
    // Measured: 0.017 % and 1.4 % of the amplitude in the root mean square; after reversals a_y is not that of the circle.
    for (phi, k, tolerance) in [(50e-6, 0.0, 5e-4), (0.0, 10e-6, 0.03)] {
        let machine = bare_machine.clone().with_coupling(x_by_y(phi, k));
        let found = radial(&bare(&machine, &profile, None), counted, radius);
        let amplitude = 0.5 * (phi * radius - k * rate);
        let mut square = 0.0;
        for (&(theta, with), &(_, without)) in found.iter().zip(&reference) {
            square += (with - without - amplitude * (2.0 * theta).sin()).powi(2);
        }
        let off = (square / found.len() as f64).sqrt() / amplitude.abs();
        assert!(off < tolerance, "{phi} {k}: {off}");
    }
}

/// At R 50 mm and 3 m/min, 20 µm/m and 20 µm/(m/s²) cancel; at 10 m/min they do not.
#[test]
fn at_one_feed_squareness_and_crosstalk_cancel() {
    let coupling = x_by_y(20e-6, 20e-6);
    let most = |radius: f64, feed: f64| -> f64 {
        let radial = |k: u32| {
            let (sin, cos) = (f64::from(k) * 0.01).sin_cos();
            let rate = feed * feed / radius;
            let shift = coupling.shift(
                &[radius * cos, radius * sin],
                &[0.0; 2],
                &[-rate * cos, -rate * sin],
            );
            (shift[0] * cos + shift[1] * sin).abs()
        };
        (0..629).map(radial).fold(0.0, f64::max)
    };
    assert!(most(0.05, 0.05) < 1e-20);
    // ½ · 20e-6 · (0.05 − 0.5556) m.
    assert!((most(0.05, 10.0 / 60.0) - 5.0556e-6).abs() < 1e-9);
}

/// Axes that do exactly what is asked leave the tool on the path, with a correction of the references.
#[test]
fn corrected_references_put_the_tool_on_the_path() {
    let points = (0..=20).map(|i| {
        let x = 0.05 * f64::from(i);
        [x - 0.5, 3e-6 * (7.0 * x).sin()]
    });
    let table = Straightness::new(1, points.collect()).unwrap();
    let pair = |of, by, phi, k, straightness| AxisCoupling {
        of,
        by,
        squareness: phi,
        crosstalk: k,
        straightness,
    };
    let coupling = Coupling::new(vec![
        pair(0, 1, 30e-6, 20e-6, Some(table)),
        pair(1, 0, 0.0, -15e-6, None),
    ]);
    let coupling = Arc::new(coupling.unwrap());
    let (profile, counted) = circle(0.05, 0.05);
    let zeros = [0.1 - 0.05, 0.2];
    let start = |axis: usize| zeros[axis] + profile.path().at(0.0).position[axis];
    let motions = [0, 1].map(|axis| {
        AxisMotion::new(profile.clone(), axis, start(axis)).correcting(coupling.clone(), zeros)
    });
    let delay = motions[0].delay();
    assert_eq!(delay, 5e-3);
    assert_eq!(motions[0].duration(), profile.duration() + 0.01);
    let (mut off, mut slope) = (0.0_f64, [0.0_f64; 2]);
    for k in 0..4000 {
        let t = f64::from(k) * motions[0].duration() / 4000.0;
        let at = motions.each_ref().map(|m| m.at(t));
        let q = [0, 1].map(|i| at[i].position - motions[i].zero());
        let shift = coupling.shift(&q, &zeros, &at.map(|p| p.acceleration));
        let wanted = profile.axes(t - delay).position;
        let s = profile.at(t - delay).s;
        if (counted.0..counted.1).contains(&s) {
            off = off.max(
                (0..2)
                    .map(|i| (q[i] + shift[i] - wanted[i]).abs())
                    .fold(0.0, f64::max),
            );
        }
        // The derivatives are those of the position.
        let h = 1e-6;
        for motion in &motions {
            let [a, b, c] = [t - h, t, t + h].map(|t| motion.at(t.max(0.0)));
            if t > h {
                slope[0] = slope[0].max(((c.position - a.position) / (2.0 * h) - b.velocity).abs());
                slope[1] =
                    slope[1].max(((c.velocity - a.velocity) / (2.0 * h) - b.acceleration).abs());
            }
        }
    }
    // Measured 1.6e-11 m: products of two corrections (30e-6 · 15e-6 · 0.05 m/s² and the like), and the window.
    assert!(off < 5e-11, "{off}");
    // Measured 1.2e-10 and 7e-10: rounding of 0.1 m and 0.05 m/s over 2 µs; no instant lies beside a jump of jerk.
    assert!(slope[0] < 4e-10 && slope[1] < 2e-9, "{slope:?}");
}

/// sin(π x/L) has no second derivative at both ends, as the spline.
#[test]
fn straightness_is_a_smooth_curve_through_its_points() {
    let pi = std::f64::consts::PI;
    let points = (0..=16).map(|i| [f64::from(i) / 16.0, 1e-3 * (pi * f64::from(i) / 16.0).sin()]);
    let table = Straightness::new(0, points.collect()).unwrap();
    let mut off = [0.0_f64; 3];
    for i in 0..=1000 {
        let x = f64::from(i) / 1000.0;
        let (sin, cos) = (pi * x).sin_cos();
        let truth = [sin, pi * cos, -pi * pi * sin].map(|v| 1e-3 * v);
        for (off, (truth, value)) in off.iter_mut().zip(truth.iter().zip(table.at(x))) {
            *off = off.max((truth - value).abs());
        }
    }
    // Measured 3.9e-9, 1.9e-7 and 3.2e-5; (5/384) h⁴ max f⁗ is 1.9e-8.
    assert!(off[0] < 1.2e-8 && off[1] < 6e-7 && off[2] < 9e-5, "{off:?}");
    // Straight on outside.
    let [end, slope, ..] = table.at(1.0);
    assert!((table.at(1.5)[0] - end - 0.5 * slope).abs() < 1e-18);
    assert!((table.at(-0.5)[0] + 0.5 * table.at(0.0)[1]).abs() < 1e-18);
}

#[test]
fn values_that_cannot_be_are_refused() {
    let refused = |pair: AxisCoupling| Coupling::new(vec![pair]).unwrap_err().to_string();
    let pair = AxisCoupling {
        of: 1,
        by: 0,
        ..AxisCoupling::default()
    };
    for bad in [f64::NAN, f64::INFINITY, -0.02] {
        let text = refused(AxisCoupling {
            squareness: bad,
            ..pair.clone()
        });
        assert!(
            text.contains("squareness of axis 2") && text.contains("valid: from"),
            "{text}"
        );
        let text = refused(AxisCoupling {
            crosstalk: bad,
            ..pair.clone()
        });
        assert!(text.contains("cross-talk of axis 2"), "{text}");
    }
    refused(AxisCoupling {
        of: 0,
        by: 0,
        ..AxisCoupling::default()
    });
    for bad in [
        vec![],
        vec![[0.0, 0.0]],
        vec![[0.0, 0.0], [0.0, 1e-6]],
        vec![[0.0, f64::NAN], [1.0, 0.0]],
        vec![[f64::NAN, 0.0], [1.0, 0.0]],
    ] {
        assert!(matches!(
            Straightness::new(0, bad),
            Err(MachineError::Invalid { .. })
        ));
    }
}
