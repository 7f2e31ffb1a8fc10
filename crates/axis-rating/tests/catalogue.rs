//! Worked examples and factors that makers print. Tolerances are those of the printed digits.

use std::f64::consts::{PI, TAU};

use axis_rating::screw::dn_value;
use axis_rating::{
    BASE_REVOLUTIONS, BeltTeeth, GuideBase, RollingElement, ScrewMounting, ScrewStrength, life,
};

use crate::near;

/// Steel as THK and MISUMI have it: E = 2.06e5 N/mm², 7.85e-6 kg/mm³.
fn screw(root_mm: f64, mounting: ScrewMounting) -> ScrewStrength {
    ScrewStrength {
        root_diameter_m: 1e-3 * root_mm,
        youngs_modulus_pa: 2.06e11,
        density_kg_per_m3: 7850.0,
        mounting,
    }
}

/// MISUMI 2025, page 1676: root 12.5 mm, fixed-supported, 820 mm: 3630 N, with m = 10 and the share 0.5. The exact m is
/// n π³ E/128 = 9.98 here, which MISUMI rounds up.
#[test]
fn permissible_axial_load_of_misumi() {
    let load = screw(12.5, ScrewMounting::FixedSupported)
        .buckling_load_n(0.82)
        .unwrap();
    near(0.5 * load, 3630.0, 0.003);
}

/// THK 514E, page A15-30: with the share 0.5 the load is η₂ d⁴/ℓ² 10⁴ N (mm), η₂ = 5 n in round numbers (10 and 20; 1.3 is
/// 1.25 rounded once more); exactly it is 4.99 n.
#[test]
fn buckling_factors_of_makers() {
    for (mounting, factor) in [
        (ScrewMounting::FixedFree, 1.25),
        (ScrewMounting::SupportedSupported, 5.0),
        (ScrewMounting::FixedSupported, 10.0),
        (ScrewMounting::FixedFixed, 20.0),
    ] {
        let load = 0.5 * screw(30.0, mounting).buckling_load_n(1.5).unwrap();
        near(
            load * 1500.0_f64.powi(2) / 30.0_f64.powi(4) / 1e4,
            factor,
            0.0025,
        );
    }
}

/// HSK, *Screw Shaft Design*: m of the load m d⁴/L² 10³ kgf (mm) with E = 2.1e4 kgf/mm² and its share of 0.5.
#[test]
fn buckling_factors_of_hsk() {
    for (mounting, printed) in [
        (ScrewMounting::FixedFree, 1.3),
        (ScrewMounting::SupportedSupported, 5.1),
        (ScrewMounting::FixedSupported, 10.2),
        (ScrewMounting::FixedFixed, 20.3),
    ] {
        // In kgf and mm, which the formula does not mind.
        let strength = ScrewStrength {
            root_diameter_m: 30.0,
            youngs_modulus_pa: 2.1e4,
            density_kg_per_m3: 1.0,
            mounting,
        };
        let load = strength.buckling_load_n(1500.0).unwrap();
        let factor = 0.5 * load * 1500.0_f64.powi(2) / 30.0_f64.powi(4) / 1e3;
        assert!((factor - printed).abs() < 0.05, "{factor} {printed}");
    }
}

/// THK 513-1E, page A15-32: with the share 0.8 the speed is λ₂ d/ℓ² 10⁷ rpm (mm), λ₂ = 3.4, 9.7, 15.1 and 21.9.
#[test]
fn critical_speed_factors_of_thk() {
    for (mounting, factor, printed_mode) in [
        (ScrewMounting::FixedFree, 3.4, "1.875"),
        (ScrewMounting::SupportedSupported, 9.7, "3.142"),
        (ScrewMounting::FixedSupported, 15.1, "3.927"),
        (ScrewMounting::FixedFixed, 21.9, "4.730"),
    ] {
        let speed = screw(30.0, mounting).critical_speed_rad_per_s(1.5).unwrap();
        let rpm = 0.8 * speed * 30.0 / PI;
        let found = rpm * 1500.0_f64.powi(2) / 30.0 / 1e7;
        assert!((found - factor).abs() < 0.05, "{found} {factor}");
        assert_eq!(format!("{:.3}", mounting.mode()), printed_mode);
    }
}

/// *White Paper: 10 Steps to Achieve Optimal Ball Screw Selection* (zbook.org): 100 in long, 1 in root diameter, about
/// 18 Hz fixed at both ends, about 8 Hz supported.
#[test]
fn natural_frequencies_of_a_white_paper() {
    for (mounting, hertz) in [
        (ScrewMounting::FixedFixed, 18.0),
        (ScrewMounting::SupportedSupported, 8.0),
    ] {
        let speed = screw(25.4, mounting)
            .critical_speed_rad_per_s(2.54)
            .unwrap();
        assert!((speed / TAU - hertz).abs() < 0.5, "{}", speed / TAU);
    }
}

/// MISUMI 2025, page 1678: C = 4400 N, P_m = 250 N, f_w = 1.2, 2118 rpm: 24824 h (unrounded 24826.6).
#[test]
fn life_of_a_nut_of_misumi() {
    let revolutions =
        life::nominal_life(BASE_REVOLUTIONS, 4400.0, 1.2 * 250.0, RollingElement::Ball).unwrap();
    near(
        life::life_h(revolutions, 2118.0 / 60.0).unwrap(),
        24824.0,
        1.2e-4,
    );
}

/// A calculation by MITCalc (*Ball screws*, printed example): 1000 N, f_w = 1.2, 2400 rpm, 20000 h ask for
/// C_a = 17073.1 N; DN is 76800 at 32 mm, against 110000.
#[test]
fn rating_and_dn_value_of_mitcalc() {
    let revolutions =
        life::nominal_life(BASE_REVOLUTIONS, 17073.1, 1200.0, RollingElement::Ball).unwrap();
    near(life::life_h(revolutions, 40.0).unwrap(), 20_000.0, 2e-5);
    let dn = dn_value(0.032, 2400.0 * PI / 30.0, 110_000.0).unwrap();
    near(dn.value, 76800.0, 1e-12);
    assert!(dn.holds());
}

/// Jindal, *Machine Design*, example 18-2 (as a notebook of Python-Textbook-Companions): C = 5590 N, F_r = 1250 N,
/// F_a = 625 N, X = 0.56, Y = 1.2: 57.3 million revolutions; with the outer ring turning (X = 1.2 · 0.56) 43.46.
#[test]
fn bearing_of_a_text_book() {
    for (x, millions) in [(0.56, 57.3), (1.2 * 0.56, 43.46)] {
        let load = life::equivalent_load_n(1250.0, 625.0, [x, 1.2]).unwrap();
        let life = life::nominal_life(1e6, 5590.0, load, RollingElement::Ball).unwrap();
        near(life / 1e6, millions, 1e-3);
    }
}

/// linearmotiontips.com, *One thing you need to know about linear bearing life*: a rating of 100 km times 1.26 is that of
/// 50 km.
#[test]
fn guide_ratings_of_both_bases() {
    let life = |base: GuideBase, rating: f64| {
        life::nominal_life(base.travel_m(), rating, 3000.0, RollingElement::Ball).unwrap()
    };
    let (of_100, of_50) = (
        life(GuideBase::Km100, 20_000.0),
        life(GuideBase::Km50, 1.26 * 20_000.0),
    );
    near(of_50, of_100, 3.0 * 0.005 / 1.26);
}

/// CONTI SYNCHROFLEX, calculation example (belt-pilot.com): AT10, z = 25, 300 N·m at standstill, 11.70 N·cm for each tooth of the
/// pulley, tooth in mesh and cm of width, 12 teeth in mesh: 8.54 cm. Pull 7539 N, of a pitch circle of 79.58 mm, cut to
/// whole newtons.
#[test]
fn width_of_a_synchroflex_belt() {
    let (teeth, pitch) = (25.0, 0.01);
    let radius = teeth * pitch / TAU;
    let pull = 300.0 / radius;
    assert_eq!((2.0 * 300.0 / 0.07958_f64).trunc(), 7539.0);
    near(pull, 2.0 * 300.0 / 0.07958, 0.005 / 79.58);
    // N·m for each tooth of the pulley, tooth in mesh and metre of width, and the force of that torque.
    let torque_per_width = 11.70 * 1e-2 / 1e-2;
    let belt = |width_m: f64| BeltTeeth {
        force_per_width_n_per_m: torque_per_width * teeth / radius,
        width_m,
        in_mesh: 12.5,
    };
    let found = belt(0.0854).tooth_load(pull).unwrap();
    near(found.margin(), 1.0, 0.01 / 8.54);
    let chosen = belt(0.1).tooth_load(pull).unwrap();
    assert!(chosen.holds() && !belt(0.085).tooth_load(pull).unwrap().holds());
}
