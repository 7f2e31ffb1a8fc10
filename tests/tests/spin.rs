//! A small motor that is spun slowly or swung by a sine of torque, simulated by code that shares none
//! with the library, and a file that knows next to nothing of it.

use axis_log::Log;
use axis_sim::{Axis, Balance};
use discrepancy::logs::check_log;
use discrepancy::{Discovery, Evidence, Settings, Verdict};
use independent_axis::{Random, SpunBy, SpunMotor, Table, spun_log};

use crate::slide::as_log;

const PERIOD: f64 = 1e-3;

/// As users write such files: `inertia` (kg·m²) is a guess, and so is the way on which friction
/// comes on.
fn machine(inertia: f64, more: &str) -> Axis {
    Axis::parse("spun.toml", &file(inertia, more)).unwrap()
}

fn file(inertia: f64, more: &str) -> String {
    format!(
        r#"
schema = 2
name = "spun"

[mechanism]
kind = "torque-motor"
table_inertia_kg_m2 = {inertia:e}

[actuator]
kind = "torque-source"
torque_limit_n_m = 0.025
bandwidth_hz = 1000

[friction]
kind = "coulomb-rotary"
viscous_n_m_s_per_rad = 0
coulomb_n_m = 0
presliding_rad = 0.001

[stroke]
minimum_rad = -5000
maximum_rad = 5000
start_rad = 0

[tolerances]
table_inertia = "unknown"
{more}"#
    )
}

const MOTOR: SpunMotor = SpunMotor {
    dry: 2e-3,
    cogging: [12.0, 0.0],
    angle_noise: 1e-5,
};

/// What is found on a log to fit, one to check and one to test, turned so.
fn found(machine: &Axis, motor: &SpunMotor, by: [SpunBy; 3], duration: f64) -> Discovery {
    let mut seed = 0;
    let [fit, check, test] = by.map(|by| {
        seed += 1;
        let table = spun_log(motor, by, duration, &mut Random::new(seed, 3));
        vec![(format!("log {seed}"), of_load(&table, machine), PERIOD)]
    });
    let evidence = Evidence::new(machine, fit, check, test).unwrap();
    let found = evidence.discover(machine, &Settings::default(), |_| {});
    let found = found.unwrap().1.discovery;
    println!("{}", found.sentence);
    found
}

/// As the machine's log has it: the angle is that of the load.
fn of_load(table: &Table, machine: &Axis) -> Log {
    let mut table = table.clone();
    let angle = 1;
    let r = machine.travel_per_radian();
    table.rows.iter_mut().for_each(|row| row[angle] *= r);
    as_log(&table)
}

fn has(found: &Discovery, name: &str) -> bool {
    found.effects.iter().any(|e| e.name == name)
}

/// The numbers of the first effect of that name.
fn numbers(found: &Discovery, name: &str) -> Vec<f64> {
    let effect = found.effects.iter().find(|e| e.name == name);
    let effect = effect.unwrap_or_else(|| panic!("no {name}: {}", found.sentence));
    effect.parameters.iter().map(|p| p.value).collect()
}

/// The current is a sine of 2 Hz in each log, and so are inertia and friction: a load of that period
/// was named, with the inertia at the edge of its tolerance.
#[test]
fn what_repeats_with_the_drive_is_no_load_in_time() {
    let by = [0.011, 0.010, 0.012].map(|torque| SpunBy::Sine([torque, 2.0]));
    let motor = SpunMotor {
        angle_noise: 8e-3,
        ..MOTOR
    };
    let found = found(&machine(6e-6, ""), &motor, by, 8.0);
    assert_eq!(found.verdict, Verdict::Explained);
    assert!(!has(&found, "cyclic-load"));
    // By direction or not: the two levels are the same.
    let names = ["coulomb-friction", "asymmetric-friction"];
    let name = names.into_iter().find(|name| has(&found, name)).unwrap();
    let dry = numbers(&found, name)[0];
    assert!((dry / MOTOR.dry - 1.0).abs() < 0.05, "{dry}");
    let mut known = found.recalibrated.iter();
    let inertia = known.find(|k| k.name == "table-inertia").unwrap().share;
    assert!(
        (6e-6 * (1.0 + inertia) / 5e-6 - 1.0).abs() < 0.03,
        "{inertia}"
    );
}

/// At one speed inertia takes no torque, and noise of the acceleration does no harm: logs were refused,
/// the low-pass being so low that 22 samples were left. Nobody gave the number of slots.
#[test]
fn at_constant_speed_cogging_of_any_order_is_found() {
    let motor = SpunMotor {
        cogging: [40.0, 1e-3],
        angle_noise: 1e-4,
        ..MOTOR
    };
    let by = [2.0, 2.4, 1.7].map(SpunBy::Speed);
    let found = found(&machine(5e-6, ""), &motor, by, 15.0);
    let cogging = numbers(&found, "cogging-torque");
    assert!((cogging[1] - 40.0).abs() < 0.01, "{cogging:?}");
    assert!((cogging[0].abs() / 1e-3 - 1.0).abs() < 0.1, "{cogging:?}");
}

/// The encoder is so coarse that its noise draws the inertia to nothing, of which the tolerance leaves a
/// tenth. What the model makes of the angle's noise is counted with that, and not with the guess: with
/// 5e-6 kg·m² it would be 3.5 mN·m, and hide the cogging. A smaller inertia is no explanation of it.
#[test]
fn noise_is_that_of_the_fitted_inertia_and_cogging_is_no_inertia() {
    let motor = SpunMotor {
        cogging: [12.0, 1.3e-3],
        angle_noise: 6e-3,
        ..MOTOR
    };
    let by = [50.0, 55.0, 45.0].map(SpunBy::Speed);
    for inertia in [5e-6, 5e-7] {
        let machine = machine(inertia, "\n[balance]\ncutoff_hz = 125\n");
        let found = found(&machine, &motor, by, 4.0);
        let cogging = numbers(&found, "cogging-torque");
        assert_eq!(cogging[1].round(), 12.0);
        assert!(!has(&found, "payload-mass") && !has(&found, "motor-inertia"));
        let gap = &found.gap.check.channels[0];
        assert!(gap.after < 2.0 * gap.floor, "{gap:?}");
        // Behind the low-pass the torque has noise of 0.1 mN·m, a tenth of 5e-6 kg·m² makes 0.35 mN·m.
        assert!(gap.floor < 4e-4, "{gap:?}");
        assert!(gap.floor <= gap.after, "{gap:?}");
    }
}

/// A joint's motor at constant speed, of which the file knows neither inertia: noise of the angle makes most of the
/// acceleration. A model that takes it as measured makes torque of that noise, which a softer gear takes away again:
/// a stiffness changed by −78 % and a resonance of 33 Hz were named.
#[test]
fn noise_of_the_acceleration_is_no_soft_gear() {
    let gear = r#"kind = "gear"
motor_inertia_kg_m2 = 2e-5
ratio = 100
gear_stiffness_n_m_per_rad = 5000
load_inertia_kg_m2 = 0.02
stiffness_damping_ms = 0.2"#;
    let mut text = file(
        5e-6,
        "motor_inertia = \"unknown\"\nload_inertia = \"unknown\"\n\n[sensors.motor]\nkind = \"encoder\"\nlines = 4096\n\n[balance]\ncutoff_hz = 100\n",
    );
    text = text.replace("kind = \"torque-motor\"\ntable_inertia_kg_m2 = 5e-6", gear);
    text = text.replace("table_inertia = \"unknown\"\n", "");
    let machine = Axis::parse("joint.toml", &text).unwrap();
    let motor = SpunMotor {
        cogging: [12.0, 1e-3],
        angle_noise: 1e-3,
        ..MOTOR
    };
    let by = [4.0, 3.2, 4.6].map(SpunBy::Speed);
    let found = found(&machine, &motor, by, 8.0);
    assert!(!has(&found, "transmission-stiffness") && !has(&found, "structural-resonance"));
    let cogging = numbers(&found, "cogging-torque");
    assert_eq!(cogging[1].round(), 12.0);
    assert!((cogging[0].abs() / 1e-3 - 1.0).abs() < 0.1, "{cogging:?}");
}

/// What lies near a hole of any length is left out: nothing is interpolated there that counts.
#[test]
fn a_hole_in_a_balanced_log_is_left_out() {
    let machine = machine(5e-6, "");
    let by = SpunBy::Sine([0.011, 2.0]);
    let table = spun_log(&MOTOR, by, 8.0, &mut Random::new(1, 3));
    let mut log = as_log(&table);
    let whole = Balance::new(&log, PERIOD, &machine).unwrap();
    for channel in ["position_rad", "torque_n_m"] {
        log.mark_missing(channel, Some(4000..4012)).unwrap();
    }
    assert!(check_log("log", &log, &machine).is_ok());
    let holed = Balance::new(&log, PERIOD, &machine).unwrap();
    let near = |t: f64| (4.0 - 0.05..4.012 + 0.05).contains(&t);
    let times = |balance: &Balance| balance.compared().time().to_vec();
    assert!(times(&whole).into_iter().any(near));
    assert!(!times(&holed).into_iter().any(near));
}
