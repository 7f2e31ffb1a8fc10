//! A motor on a torque-controlled bench: github:TeacherRock/LuGre_Friction (no licence).
//!
//! A plain least squares of inertia, dry and viscous friction on `J_1` where it is faster
//! than 5 rad/s gives J 1.84e-4 kg·m², 0.0321 N·m and 7.5e-5 N·m·s/rad, and leaves
//! 3.4 mN·m RMS.

use super::{Told, axis, discover, folder, holds, off, only, read};
use discrepancy::Settings;

const FROM: &str = "github:TeacherRock/LuGre_Friction, as CSV (data/axes/lugre-bench.toml)";

/// Inertia of the axis file, kg·m².
const INERTIA: f64 = 2e-4;

fn told(more: &str, settings: &Settings) -> Option<Told> {
    let folder = folder("lugre-bench", FROM)?;
    let machine = axis("lugre-bench", more);
    let fit = read(&machine, &folder, &["J_1.csv", "J_3.csv", "Fs_1.csv"]);
    let check = read(&machine, &folder, &["J_2.csv", "J_4.csv"]);
    Some(discover(&machine, &fit, &check, settings))
}

#[test]
fn above_5_rad_per_s_inertia_and_friction_are_those_of_plain_least_squares() {
    let effects = ["coulomb-friction", "viscous-friction"];
    let Some(told) = told("\n[balance]\nslowest_rad_per_s = 5\n", &only(&effects)) else {
        return;
    };
    let [dry, viscous] = effects.map(|name| told.value(name, 0));
    for (found, published) in [(inertia(&told), 1.84e-4), (dry, 0.0321), (viscous, 7.5e-5)] {
        assert!(holds(found, published), "{found:?} beside {published}");
    }
    // Theirs leaves 3.4 mN·m on the log it was fitted to, before any low-pass.
    assert!(told.discovery.gap.check.channels[0].after < 3.4e-3);
}

/// Down to where the encoder shows motion, friction is another: it rises from break-away at
/// 0.025 N·m on `Fs_1` to the dry friction that least squares see above 5 rad/s, and more
/// slowly from there. So dry friction is named with another onset than the model's, and a
/// steeper viscous one.
#[test]
fn inertia_alone_lacks_dry_and_viscous_friction() {
    let Some(told) = told("", &Settings::default()) else {
        return;
    };
    assert!(off(inertia(&told), 1.84e-4) < 0.06, "{:?}", inertia(&told));
    let dry = [0, 1].map(|p| told.value("asymmetric-friction", p).0);
    let dry = 0.5 * (dry[0] + dry[1]);
    let viscous = told.value("viscous-friction", 0).0;
    // It comes on with speed, below 1 rad/s.
    let form = told.effect("asymmetric-friction").form.as_ref().unwrap();
    assert!(form.below < 1.0, "{form:?}");
    // In the middle of the range of plain least squares.
    let at_20 = dry + 20.0 * viscous;
    assert!(
        (at_20 / (0.0321 + 20.0 * 7.5e-5) - 1.0).abs() < 0.05,
        "{at_20}"
    );
    assert!(told.discovery.gap.check.channels[0].after < 2e-3);
}

/// The inertia and its 95 % interval, kg·m².
fn inertia(told: &Told) -> (f64, [f64; 2]) {
    let (by, ends) = told.known("table-inertia");
    (INERTIA * by, ends.map(|end| INERTIA * end))
}
