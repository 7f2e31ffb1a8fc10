//! Two coupled motors: github:malik-robert/HSM150-data (no licence).
//!
//! Catalogue values inside its files: J 1.2e-4 kg·m², B 7.03e-5 N·m·s/rad.

use super::{axis, discover, folder, holds, read};
use discrepancy::Settings;

const FROM: &str = "github:malik-robert/HSM150-data, as CSV (data/axes/hsm150.toml)";

#[test]
fn two_motors_lack_dry_friction() {
    let Some(folder) = folder("hsm150", FROM) else {
        return;
    };
    let machine = axis("hsm150", "");
    let fit = ["pos_0.06_1.csv", "pos_0.065_1.csv", "neg_0.04_1.csv"];
    let fit = read(&machine, &folder, &fit);
    let check = read(&machine, &folder, &["pos_0.065_2.csv", "neg_0.045_1.csv"]);
    let told = discover(&machine, &fit, &check, &Settings::default());
    let dry = [0, 1].map(|p| told.value("asymmetric-friction", p).0);
    // 0.05 N·m keep up 139 rad/s forward, 0.03 N·m some 155 rad/s backward.
    assert!(dry[0] > 0.03 && dry[0] < 0.05, "{dry:?}");
    assert!(dry[1] > 0.02 && dry[1] < 0.03, "{dry:?}");
    // The catalogue's values turn out to be those of the whole rig, not of each motor.
    let (less, [low, high]) = told.value("payload-mass", 0);
    let inertia = (2.4e-4 + less, [2.4e-4 + low, 2.4e-4 + high]);
    assert!(
        holds(inertia, 1.2e-4) && !holds(inertia, 2.4e-4),
        "{inertia:?}"
    );
    let (by, [low, high]) = told.known("viscous");
    let viscous = (1.406e-4 * by, [1.406e-4 * low, 1.406e-4 * high]);
    assert!(
        holds(viscous, 7.03e-5) && !holds(viscous, 1.406e-4),
        "{viscous:?}"
    );
    assert!(told.discovery.gap.check.reduction > 0.85);
}
