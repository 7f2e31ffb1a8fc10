//! How runs begin, and how one goes on where another ended.

use axis_sim::{Axis, ClosedLoop, Cycle, Sensors, Start};
use compensator::NoCompensation;
use trajectories::{Motion, Setpoint};

use crate::{Dwell, OTHERS, PRINTED, axis, bits, changed, text};

/// A file with a weight on it.
fn loaded(name: &str, weight: f64) -> Axis {
    let content = text(name) + &format!("\n[[load]]\nkind = \"gravity\"\nweight_n = {weight}\n");
    Axis::parse(name, &content).unwrap()
}

fn run(closed_loop: &ClosedLoop, motion: &impl Motion) -> Vec<Cycle> {
    let mut cycles = Vec::new();
    closed_loop
        .run(motion, &mut NoCompensation, |c| cycles.push(*c))
        .completed()
        .unwrap();
    cycles
}

/// Settled under its loads, nothing moves while the reference rests: with perfect sensors,
/// with those of the file, and with the motor's alone.
#[test]
fn at_rest_under_gravity_nothing_moves() {
    let axes = [
        (loaded(PRINTED, 800.0), 800.0),
        (loaded("rack.toml", -500.0), -500.0),
        (loaded("belt.toml", 60.0), 60.0),
        (loaded("screw-datasheet.toml", 800.0), 800.0),
        (loaded("linear-motor.toml", 100.0), 100.0),
        (axis("linear-stage.toml"), 10.0),
        // Level at 0; 60 N·m there.
        (axis("joint.toml"), 60.0 * (60f64.to_radians()).sin()),
    ];
    for (axis, weight) in axes {
        let at = axis.stroke.start;
        let motion = Dwell { at, duration: 0.2 };
        let mut perfect = axis.clone();
        perfect.sensors = Sensors::default();
        let mut semi_closed = perfect.clone();
        semi_closed.sensors.load = axis_sim::LoadSensor::Missing;
        let torque = weight * travel_at(&axis, weight);
        for axis in [&perfect, &semi_closed, &axis] {
            let cycles = run(&ClosedLoop::new(axis).unwrap(), &motion);
            let (mut moved, mut off) = (0.0_f64, 0.0_f64);
            for c in &cycles {
                moved = moved.max((c.position - at).abs());
                off = off.max((c.torque / torque - 1.0).abs());
            }
            println!("{}: {moved:e}, torque off by {off:e}", axis.name);
            // Measured 0, and 3.2e-13 where the screw has elements.
            assert!(moved < 1e-15, "{}: {moved:e}", axis.name);
            assert!(off < 2e-12, "{}: {off:e}", axis.name);
        }
    }
}

/// dx/dθ at the start under a force on the load: of the joint, whose load leads its motor by half a minute of
/// arc, sin 2θ, at the angle θ with the wind-up of the gear.
fn travel_at(axis: &Axis, force: f64) -> f64 {
    let r = axis.travel_per_radian();
    match axis.name.as_str() {
        "joint" => {
            let angle = (axis.stroke.start + force / 2.5e4) / r;
            let amplitude = (0.5_f64 / 60.0).to_radians();
            r + 2.0 * amplitude * (2.0 * angle).cos()
        }
        _ => r,
    }
}

/// Bristles that a motion has left bent hold the axis back, and the torque against them.
#[test]
fn friction_that_is_left_is_held() {
    for file in OTHERS.into_iter().chain([PRINTED]) {
        let mut axis = axis(file);
        axis.sensors = Sensors::default();
        axis.loads.clear();
        let closed_loop = ClosedLoop::new(&axis).unwrap();
        let share = -0.7;
        let start = Start {
            friction: share,
            ..Start::at(axis.stroke.start)
        };
        let mut state = closed_loop.start(&start).unwrap();
        let law = axis.friction.law.parameters();
        let lever = axis.friction.lever(axis.travel_per_radian());
        let force = share * law.coulomb / lever;
        let [held, of_coulomb] = state.plant().friction();
        // Measured 2.2e-16 and 1.1e-16.
        let off = [held / force - 1.0, of_coulomb - share];
        assert!(off.iter().all(|off| off.abs() < 2e-15), "{file}: {off:?}");
        let motion = Dwell {
            at: axis.stroke.start,
            duration: 0.1,
        };
        let (mut moved, mut off) = (0.0_f64, 0.0_f64);
        let torque = force * travel_at(&axis, force);
        closed_loop
            .run_from(
                &mut state,
                &motion,
                &mut NoCompensation,
                |_| (),
                |c| {
                    moved = moved.max((c.position - axis.stroke.start).abs());
                    off = off.max((c.torque / torque - 1.0).abs());
                },
            )
            .completed()
            .unwrap();
        println!("{file}: {moved:e}, torque off by {off:e}");
        // Measured 0 and 3.4e-13.
        assert!(moved < 1e-15 && off < 2e-12, "{file}: {moved:e} {off:e}");
    }
}

/// Set points as they come, one a cycle.
struct Listed<'a>(&'a [Setpoint], f64);

impl Motion for Listed<'_> {
    fn duration(&self) -> f64 {
        (self.0.len() - 1) as f64 * self.1
    }
    fn at(&self, t: f64) -> Setpoint {
        let k = (t / self.1).round() as usize;
        self.0[k.min(self.0.len() - 1)]
    }
}

#[test]
fn a_run_goes_on_where_another_ended() {
    for file in OTHERS.into_iter().chain([PRINTED]) {
        let axis = axis(file);
        let closed_loop = ClosedLoop::new(&axis).unwrap();
        let motion = axis.plan(&axis.trajectories[1]).unwrap();
        let period = axis.period;
        let all: Vec<Setpoint> = (0..500).map(|k| motion.at(k as f64 * period)).collect();
        let whole = run(&closed_loop, &Listed(&all, period));
        let mut state = closed_loop.start(&Start::at(axis.stroke.start)).unwrap();
        let mut parts = Vec::new();
        // The last of a part is held until the next begins: a sampling instant each.
        for part in [&all[..200], &all[200..201], &all[201..]] {
            closed_loop
                .run_from(
                    &mut state,
                    &Listed(part, period),
                    &mut NoCompensation,
                    |_| (),
                    |c| {
                        parts.push(*c);
                    },
                )
                .completed()
                .unwrap();
        }
        assert_eq!(whole.len(), 500);
        let bits = |cycles: &[Cycle]| cycles.iter().flat_map(bits).collect::<Vec<u64>>();
        assert!(bits(&whole) == bits(&parts), "{file}");

        // By hand, the same.
        let mut state = closed_loop.start(&Start::at(axis.stroke.start)).unwrap();
        let mut by_hand = Vec::new();
        for k in 0..500 {
            let next = all[(k + 1).min(499)];
            let step = [&all[k], &next];
            let cycle = closed_loop.step(&mut state, step, &mut NoCompensation, |_| ());
            by_hand.push(cycle.unwrap());
        }
        assert!(bits(&whole) == bits(&by_hand), "{file}");
    }
}

/// A copy of a state goes on as the original does, and a state at rest begins at time 0.
#[test]
fn a_state_is_a_snapshot() {
    let axis = changed("rack.toml", &[("resolution_um = 0.1", "noise_um = 0.5")]);
    let closed_loop = ClosedLoop::new(&axis).unwrap();
    let dwell = Dwell {
        at: axis.stroke.start,
        duration: 0.02,
    };
    let mut state = closed_loop.start(&Start::at(axis.stroke.start)).unwrap();
    let go = |state: &mut axis_sim::LoopState| {
        let mut all = Vec::new();
        closed_loop
            .run_from(state, &dwell, &mut NoCompensation, |_| (), |c| all.push(*c))
            .completed()
            .unwrap();
        all
    };
    let first = go(&mut state);
    let mut copy = state.clone().at_rest();
    let (a, b) = (go(&mut state), go(&mut copy));
    assert_eq!(a[0].time, first.len() as f64 * axis.period);
    assert_eq!(b[0].time, 0.0);
    for (mut a, b) in a.into_iter().zip(b) {
        a.time = b.time;
        assert_eq!(bits(&a), bits(&b));
    }
    // The noise goes on, and does not begin anew.
    let mut again = closed_loop.start(&Start::at(axis.stroke.start)).unwrap();
    assert_eq!(bits(&go(&mut again)[7]), bits(&first[7]));
    assert_ne!(
        first[7].measured.position,
        go(&mut again)[7].measured.position
    );
}

/// What the command of a standstill tells of it is how the axis was left.
#[test]
fn a_start_is_estimated_from_the_command_that_holds_it() {
    let axes = OTHERS.iter().map(|name| axis(name));
    for axis in axes.chain([loaded(PRINTED, 300.0)]) {
        let start = Start {
            friction: -0.4,
            ..Start::at(axis.stroke.start)
        };
        let closed_loop = ClosedLoop::new(&axis).unwrap();
        let mut state = closed_loop.start(&start).unwrap();
        let rest = Setpoint::at_rest(start.position);
        let cycle = closed_loop
            .step(&mut state, [&rest, &rest], &mut NoCompensation, |_| ())
            .unwrap();
        let found = axis.held(start.position, cycle.command.effort);
        assert!(
            (found.friction + 0.4).abs() < 0.02,
            "{}: {found:?}",
            axis.name
        );
    }
}
