//! EMPS, a ball-screw stage: A. Janot, M. Gautier, M. Brunot, "Data Set and Reference
//! Models of EMPS", Workshop on Nonlinear System Identification Benchmarks, Eindhoven 2019.
//!
//! Published, by least squares on the torque balance (position low-passed at 100 Hz, both
//! sides decimated by 10): M 95.1089 kg, Fv 203.5034 N·s/m, Fc 20.3935 N, offset −3.1648 N;
//! relative force error 4.08 % on the log that was fitted, 5.98 % on the one with pulses
//! (asymmetric: 3.11 % and 5.37 %).

use super::{Told, axis, discover, folder, holds, off, only, read};

const FROM: &str = "nonlinearbenchmark.org (EMPS)";

/// Drive gain, N/V.
const GAIN: f64 = 35.15065188;

fn told(settings: &discrepancy::Settings) -> Option<Told> {
    let folder = folder("emps", FROM)?;
    let machine = axis("emps-balance", "");
    let fit = read(&machine, &folder, &["emps.csv"]);
    let check = read(&machine, &folder, &["emps_pulses.csv"]);
    Some(discover(&machine, &fit, &check, settings))
}

/// RMS of a rest as a share of the RMS of the command, on the check log.
fn relative_error(told: &Told) -> f64 {
    let set = &told.found.check_logs;
    let command = &set.logs[0].measured[0];
    let power = command.iter().map(|v| v * v).sum::<f64>() / command.len() as f64;
    told.discovery.gap.check.channels[0].after / power.sqrt()
}

#[test]
fn the_published_model_has_the_published_parameters() {
    let effects = ["coulomb-friction", "viscous-friction", "constant-load"];
    let Some(told) = told(&only(&effects)) else {
        return;
    };
    let (by, [low, high]) = told.known("mass");
    let mass = (100.0 * by, [100.0 * low, 100.0 * high]);
    let [dry, viscous, load] = effects.map(|name| told.value(name, 0));
    let published = [95.1089, 20.3935, 203.5034, -3.1648];
    for (found, published) in [mass, dry, viscous, load].into_iter().zip(published) {
        assert!(holds(found, published), "{found:?} beside {published}");
        // The published fit weighs all samples alike, turning points and rest included.
        assert!(off(found, published) < 0.06, "{found:?} beside {published}");
    }
    // Published: 5.98 %.
    assert!(relative_error(&told) < 0.054, "{}", relative_error(&told));
}

#[test]
fn mass_alone_lacks_dry_and_viscous_friction_of_the_published_sizes() {
    let Some(told) = told(&discrepancy::Settings::default()) else {
        return;
    };
    let (by, _) = told.known("mass");
    assert!((100.0 * by / 95.1540 - 1.0).abs() < 0.005, "{by}");
    // The published asymmetric model, which knows no Stribeck friction: Fc 20.1440 and
    // 20.6277 N, Fv 166.7061 and 240.4236 N·s/m.
    // Levels that differ by 2 % bring nothing on the log with pulses.
    let dry = told.value("coulomb-friction", 0);
    assert!(off(dry, 20.1440) < 0.05, "{dry:?}");
    assert!(off(dry, 20.6277) < 0.05, "{dry:?}");
    let viscous = [0, 1].map(|p| told.value("asymmetric-viscous-friction", p));
    assert!(off(viscous[0], 166.7061) < 0.1, "{viscous:?}");
    assert!(off(viscous[1], 240.4236) < 0.1, "{viscous:?}");
    // Published: 5.37 % with the asymmetric model.
    assert!(relative_error(&told) < 0.0537, "{}", relative_error(&told));
    let force = GAIN * told.discovery.gap.check.channels[0].after;
    assert!(force < 2.68, "{force}");
}
