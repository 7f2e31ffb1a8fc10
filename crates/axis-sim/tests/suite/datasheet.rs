//! The stiffness of a ball screw from its data sheet, in closed form.

use std::f64::consts::PI;

use crate::changed;

/// Steel, a shaft of 34.4 mm and 1.5 m, the table at x: bearing, shaft, nut, coupling, torsion.
fn compliance(lead: f64, x: f64, coupling: Option<f64>, shear_modulus: f64) -> f64 {
    let diameter = 0.0344_f64;
    let (area, polar) = (PI * diameter.powi(2) / 4.0, PI * diameter.powi(4) / 32.0);
    let along = 1.0 / 750e6 + x / (206e9 * area) + 1.0 / 7.45e7;
    let turning = coupling.map_or(0.0, |k| 1.0 / k) + x / (shear_modulus * polar);
    along + (lead / (2.0 * PI)).powi(2) * turning
}

#[test]
fn torsion_and_coupling_give_way_by_the_square_of_the_lead() {
    const COUPLING: &str = "coupling_stiffness_n_m_per_rad = 1400 ";
    let steel = 206e9 / 2.6;
    let rigid = changed("screw-datasheet.toml", &[(COUPLING, "# ")]);
    let coupled = changed("screw-datasheet.toml", &[]);
    let quick = changed("screw-datasheet.toml", &[("lead_mm = 10", "lead_mm = 40")]);
    let other = changed(
        "screw-datasheet.toml",
        &[(COUPLING, "shear_modulus_gpa = 30 ")],
    );
    for (axis, lead, coupling, shear_modulus) in [
        (&rigid, 0.01, None, steel),
        (&coupled, 0.01, Some(1400.0), steel),
        (&quick, 0.04, Some(1400.0), steel),
        (&other, 0.01, None, 30e9),
    ] {
        for x in [0.05, 0.6, 1.5] {
            let r = lead / (2.0 * PI);
            let found = axis.mechanism.compliance(x) * r * r;
            let exact = compliance(lead, x, coupling, shear_modulus);
            assert!(
                (found / exact - 1.0).abs() < 1e-12,
                "{lead} {x}: {found} {exact}"
            );
        }
    }
    // Of a tenth of what gives way at a lead of 10 mm they become most of it at 40 mm.
    let share =
        |lead| 1.0 - compliance(0.0, 0.6, None, steel) / compliance(lead, 0.6, Some(1400.0), steel);
    assert!((0.09..0.11).contains(&share(0.01)) && share(0.04) > 0.6);
}
