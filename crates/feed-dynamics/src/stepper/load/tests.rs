//! The search against plain halving of the speed, and where there is nothing to find.

use super::{LoadSearch, find_load, find_load_within};
use crate::TableMotion;
use proptest::prelude::*;

/// Motion whose speed falls from `free` by `compliance` for each newton.
fn falling(free: f64, compliance: f64) -> impl Fn(f64) -> TableMotion {
    move |load| TableMotion {
        displacement: 0.0,
        speed: free - compliance * load,
    }
}

fn find(free: f64, compliance: f64, guess: f64, law: impl Fn(f64) -> f64) -> (f64, LoadSearch) {
    let mut asked = f64::NAN;
    let (load, end) = find_load(guess, compliance, falling(free, compliance), |m| {
        asked = m.speed;
        law(m.speed)
    });
    if end.converged {
        // What the law was asked last is what came out.
        let speed = free - compliance * load;
        assert!((asked - speed).abs() <= 1.01e-11, "{asked} {speed}");
    }
    (load, end)
}

/// The end speed by halving, for a load that grows with the speed.
fn by_halving(free: f64, compliance: f64, law: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (-1e6, 1e6);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle + compliance * law(middle) > free {
            high = middle;
        } else {
            low = middle;
        }
    }
    low
}

proptest! {
    /// A law that is known to be no steeper than a part of what the motion gives way:
    /// fewer tries, the same end.
    #[test]
    fn a_bound_of_the_slope_saves_tries_and_keeps_the_end(
        compliance in -9.0..-2.0_f64,
        contraction in -6.0..0.0_f64,
        slopes in (-1.0..1.0_f64, -1.0..1.0_f64),
        knee in -0.1..0.1_f64,
        free in -0.3..0.3_f64,
        off in -8.0..0.0_f64,
    ) {
        let c = 10_f64.powf(compliance);
        let steepest = 10_f64.powf(contraction) / c;
        let law = |v: f64| steepest * if v > knee { slopes.1 } else { slopes.0 } * (v - knee);
        let truth = free - c * find(free, c, 0.0, law).0;
        let guess = law(truth) + 10_f64.powf(off) / c;
        let motion = falling(free, c);
        let (load, end) = find_load_within(steepest, guess, c, motion, |m| law(m.speed));
        prop_assert!(end.converged, "{end:?}");
        let rounding = 1e-14 * c * load.abs();
        let speed = free - c * load;
        prop_assert!((speed - truth).abs() <= 2.01e-11 + rounding, "{speed} {truth} {end:?}");
        prop_assert!(end.rounds <= find(free, c, guess, law).1.rounds);
    }

    /// Laws with kinks, a soft start of any steepness and two straight parts: a
    /// newton of load calls for up to 10⁵ newtons back.
    #[test]
    fn loads_that_grow_with_speed_are_found(
        compliance in -9.0..-2.0_f64,
        steepness in -4.0..5.0_f64,
        slopes in (0.0..1.0_f64, 0.0..1.0_f64),
        knee in -0.1..0.1_f64,
        level in 0.0..1000.0_f64,
        free in -0.3..0.3_f64,
        guess in -2000.0..2000.0_f64,
    ) {
        let c = 10_f64.powf(compliance);
        let steep = 10_f64.powf(steepness) / c;
        let law = |v: f64| {
            let soft = level * (steep * v / level.max(1e-3)).tanh();
            soft + steep * if v > knee { slopes.1 } else { slopes.0 } * (v - knee)
        };
        let (load, end) = find(free, c, guess, law);
        prop_assert!(end.converged, "{end:?}");
        let (speed, truth) = (free - c * load, by_halving(free, c, law));
        // 1e-11 m/s, and the rounding of the load times the compliance.
        let rounding = 1e-14 * c * load.abs();
        prop_assert!((speed - truth).abs() <= 1.01e-11 + rounding, "{speed} {truth} {end:?}");
        // 68 in 100 000 cases.
        prop_assert!(end.rounds <= 100, "{end:?}");
    }

    /// Any bounded continuous law, falling as steeply as it likes, several
    /// solutions included: one of them is found.
    #[test]
    fn bounded_loads_are_found(
        compliance in -9.0..-2.0_f64,
        steepness in -3.0..3.0_f64,
        waves in 1.0..50.0_f64,
        level in 0.1..1000.0_f64,
        free in -0.3..0.3_f64,
        guess in -2000.0..2000.0_f64,
    ) {
        let c = 10_f64.powf(compliance);
        let steep = 10_f64.powf(steepness) / (c * level);
        let law = |v: f64| -level * (steep * v).tanh() + 0.3 * level * (waves * steep * v).sin();
        let (load, end) = find(free, c, guess, law);
        prop_assert!(end.converged, "{end:?}");
        // The law's value goes through the load's within the tolerance, or is
        // apart from it by what the tolerance can change in it.
        let off = |by: f64| law(free - c * load + by) - (load - by / c);
        let near = || (-100..=100).map(|i| off(1.1e-13 * f64::from(i)));
        let rounding = 1e-13 * (load.abs() + level);
        let crosses = near().any(|o| o >= -rounding) && near().any(|o| o <= rounding);
        let slope = steep * level * c * (1.0 + 0.3 * waves);
        let meets = off(0.0).abs() * c <= 1.1e-11 * (1.0 + slope);
        prop_assert!(crosses || meets, "{} {end:?}", off(0.0));
    }
}

#[test]
fn a_heavy_table_needs_one_try_where_the_guess_is_good_and_two_where_it_is_not() {
    // 515 kg, 100 µs, 6e5 N·s/m: a newton calls for 0.058 N.
    let (c, slope) = (1e-4 / 1030.0, 6e5);
    let law = |v: f64| 400.0 + slope * v;
    let truth = 400.0 / (1.0 + slope * c);
    // 1e-11 m/s are 1.03e-4 N.
    let (_, end) = find(0.0, c, truth + 0.9e-4, law);
    assert_eq!((end.rounds, end.converged), (1, true));
    let (load, end) = find(0.0, c, truth + 1e-3, law);
    assert_eq!((end.rounds, end.converged), (2, true));
    // Two tries give a straight line's solution to rounding.
    assert!((load - truth).abs() < 1e-12 * truth, "{load} {truth}");
}

#[test]
fn a_law_that_jumps_holds_the_speed_where_it_does() {
    for mass in [1.0, 515.0] {
        let c = 1e-4 / (2.0 * mass);
        let (load, end) = find(30.0 * c, c, -2000.0, |v| 100.0 * v.signum());
        assert!(end.converged && (load - 30.0).abs() * c < 2e-11, "{load}");
        // The law itself gives one of the jump's ends.
        assert!(end.residual.abs() > 60.0, "{end:?}");
    }
}

#[test]
fn what_has_no_solution_says_so() {
    type Law = fn(f64) -> f64;
    let laws: [(&str, Law); 4] = [
        ("not a number", |_| f64::NAN),
        ("without bound", |_| f64::INFINITY),
        ("not a number beyond a speed", |v| {
            if v > 0.0 { f64::NAN } else { -1e3 }
        }),
        ("falling for ever", |v| -3e3 * v),
    ];
    for (name, law) in laws {
        let (_, end) = find(0.1, 1e-3, 10.0, law);
        assert!(!end.converged && end.rounds <= 250, "{name}: {end:?}");
    }
    let (_, end) = find(f64::NAN, 1e-3, 10.0, |v| v);
    assert!(!end.converged && end.rounds == 1, "{end:?}");
}
