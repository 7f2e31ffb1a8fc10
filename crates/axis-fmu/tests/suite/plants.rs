//! The machine alone.

use axis_fmu::{Unit, UnitKind, VariableKind};
use axis_sim::{ClosedLoop, Start};
use compensator::NoCompensation;
use trajectories::Motion;

use crate::{get, set, text, unit};

/// A plant in step mode, at the position where its axis begins.
fn plant(name: &str) -> Unit {
    let mut unit = Unit::of(UnitKind::Plant, name, &text(name)).unwrap();
    unit.enter_initialization(0.0, None).unwrap();
    unit.exit_initialization().unwrap();
    unit
}

/// Its first input: torque or force of the motor.
fn motor(unit: &Unit) -> String {
    unit.variables().iter().nth(1).unwrap().name.clone()
}

/// First of its outputs that are named so, whatever the unit.
fn output(unit: &mut Unit, begin: &str) -> f64 {
    let all = unit.variables().clone();
    let found = all.iter().find(|v| v.name.starts_with(begin));
    get(unit, &found.unwrap().name)
}

/// Fed with the torque that the motor has in the closed loop at the end of each internal step, the
/// machine moves as it does there.
#[test]
fn under_the_closed_loops_torque_it_moves_as_there() {
    for name in [
        "liu2025.toml",
        "belt.toml",
        "rotary-table.toml",
        "linear-motor.toml",
        "joint.toml",
        "rack.toml",
        "screw-datasheet.toml",
    ] {
        let mut unit = plant(name);
        let axis = unit.axes()[0].clone();
        let motion = axis.plan(&axis.trajectories[0]).unwrap();
        let closed_loop = ClosedLoop::new(&axis).unwrap();
        let mut state = closed_loop
            .start(&Start::at(motion.at(0.0).position))
            .unwrap();
        let steps = (axis.period / axis.simulation.step - 1e-9).ceil().max(1.0) as u32;
        let is_force = motor(&unit) == "motor_force_n";
        let per_torque = if is_force {
            1.0 / axis.travel_per_radian()
        } else {
            1.0
        };
        let (mut off, mut moved) = (0.0_f64, 0.0_f64);
        for k in 0..2000_u32 {
            let [now, next] = [k, k + 1].map(|k| motion.at(f64::from(k) * axis.period));
            let mut torques = Vec::new();
            for part in 1..steps {
                let share = f64::from(part) / f64::from(steps);
                let within = closed_loop.within(&state, [&now, &next], &mut NoCompensation, share);
                torques.push(within.unwrap().0.plant().seen().torque);
            }
            let stepped = closed_loop.step(&mut state, [&now, &next], &mut NoCompensation, |_| ());
            stepped.unwrap();
            torques.push(state.plant().seen().torque);
            for torque in torques {
                let motor = motor(&unit);
                set(&mut unit, &motor, torque * per_torque);
                let time = unit.time();
                let step = axis.period / f64::from(steps);
                unit.step(time, step).unwrap();
            }
            let seen = state.plant().seen();
            off = off.max((output(&mut unit, "machine.position") - seen.position).abs());
            moved = moved.max(seen.displacement.abs());
        }
        println!("{name}: off by {off:e} of {moved:e}, {steps} steps a period");
        assert!(moved > 1e-4 && off == 0.0, "{name}: {off}");
    }
}

/// A torque at the motor and the force that it makes on the load leave the machine at rest, F = T/r,
/// but for the wind-up; one alone moves it.
#[test]
fn torque_and_load_balance() {
    for name in ["liu2025.toml", "belt.toml", "linear-motor.toml"] {
        let moved = |torque: f64, load: f64| {
            let mut unit = plant(name);
            let travel = unit.axes()[0].travel_per_radian();
            let is_force = motor(&unit) == "motor_force_n";
            let force = if is_force { torque / travel } else { torque };
            let (motor, start) = (motor(&unit), output(&mut unit, "machine.position"));
            set(&mut unit, &motor, force);
            set(&mut unit, "load_force_n", load / travel);
            unit.step(0.0, 0.1).unwrap();
            output(&mut unit, "machine.position") - start
        };
        // More than friction holds.
        let enough = 4.0 * plant(name).axes()[0].torque_constant();
        let (both, torque, load) = (
            moved(enough, enough),
            moved(enough, 0.0),
            moved(0.0, enough),
        );
        println!("{name}: {both:e}, {torque:e}, {load:e} m");
        assert!(torque > 0.0 && load < 0.0);
        assert!(both.abs() < 0.02 * torque.min(-load), "{name}: {both}");
    }
}

/// The torque of a current is that of the axis' torque constant.
#[test]
fn a_current_is_its_torque() {
    let [mut by_torque, mut by_current] = [(); 2].map(|()| plant("liu2025.toml"));
    let constant = by_torque.axes()[0].torque_constant();
    set(&mut by_torque, "motor_torque_n_m", 3.0 * constant);
    set(&mut by_current, "motor_iq_a", 3.0);
    for unit in [&mut by_torque, &mut by_current] {
        unit.step(0.0, 0.01).unwrap();
    }
    let [a, b] = [&mut by_torque, &mut by_current].map(|unit| get(unit, "machine.position_m"));
    assert_eq!(a, b);
    assert_eq!(
        get(&mut by_current, "machine.motor_torque_n_m"),
        3.0 * constant
    );
    let has_current = |name: &str| plant(name).variables().named("motor_iq_a").is_some();
    // A torque source has no currents.
    assert_eq!(
        has_current("emps.toml"),
        unit("emps.toml")
            .variables()
            .named("machine.iq_a")
            .is_some()
    );
}

/// Steps of any length: inputs act from the point where they are set. The torque comes up over the
/// first internal step, h at most, so that the displacement a t²/2 is off by h/t at most.
#[test]
fn steps_of_any_length_are_made() {
    let mut whole = plant("belt.toml");
    let period = whole.axes()[0].period;
    let end = |unit: &mut Unit, step: f64| {
        set(unit, "motor_torque_n_m", 1.0);
        let mut time = 0.0;
        while time < 160.0 * period * (1.0 - 1e-9) {
            unit.step(time, step).unwrap();
            time += step;
        }
        assert!((unit.time() - 160.0 * period).abs() < 1e-9 * period.max(1e-3));
        get(unit, "machine.position_m")
    };
    let start = get(&mut whole, "machine.position_m");
    let one = end(&mut whole, 160.0 * period) - start;
    for share in [0.4, 0.25, 1.6, 3.2, 1.0] {
        let parts = end(&mut plant("belt.toml"), share * period) - start;
        println!("{share}: {} of {one}", parts - one);
        let ramp = 0.5 / 160.0;
        assert!(
            (parts / one - 1.0).abs() < ramp,
            "{share}: {parts} of {one}"
        );
    }
}

/// It has the variables of the mechanics, begins at the position that was set, and refuses to leave its stroke.
#[test]
fn a_plant_has_no_control() {
    let name = "liu2025.toml";
    let mut plant = Unit::of(UnitKind::Plant, name, &text(name)).unwrap();
    let all = plant.variables().clone();
    let inputs = all
        .iter()
        .filter(|v| matches!(v.kind, VariableKind::Input(_)));
    let inputs: Vec<&str> = inputs.map(|v| v.name.as_str()).collect();
    assert_eq!(inputs, ["motor_torque_n_m", "motor_iq_a", "load_force_n"]);
    let is_of =
        |v: &str| v.starts_with("drive.t_s") || v.starts_with("control.") || v.ends_with("_ref_m");
    assert!(!all.iter().any(|v| is_of(&v.name)));
    assert_ne!(plant.token(), unit(name).token());
    assert_eq!(UnitKind::of_token(&plant.token()), UnitKind::Plant);
    set(&mut plant, "unit.start_position_m", 0.3);
    set(&mut plant, "mechanism.table_mass_kg", 300.0);
    plant.enter_initialization(0.0, None).unwrap();
    plant.exit_initialization().unwrap();
    assert_eq!(get(&mut plant, "machine.position_m"), 0.3);
    let saved = plant.clone();
    let go_on = |mut unit: Unit| {
        set(&mut unit, "motor_torque_n_m", 5.0);
        unit.step(0.0, 0.0123).unwrap();
        get(&mut unit, "machine.position_m")
    };
    assert_eq!(go_on(saved.clone()), go_on(saved));
    set(&mut plant, "motor_torque_n_m", 100.0);
    let said = plant.step(0.0, 10.0).unwrap_err().to_string();
    assert!(said.contains("left its stroke"), "{said}");
    assert!(plant.time() < 10.0);
}
