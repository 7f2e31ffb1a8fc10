//! A machine that is run period by period: against its axes alone, and against closed forms.

use std::sync::Arc;

use axis_machine::{AxisGiven, BaseMode, CoupledMachine, GantryBeam, RunningMachine};
use axis_sim::{ClosedLoop, Start};
use compensator::{Compensator, Correction, NoCompensation, Sample};
use trajectories::Setpoint;

use crate::coupled::{stage, x_by_y};

/// A circle of 5 mm at 30 mm/s, its references held over each period; `grown` in a second.
fn at(t: f64, axis: usize) -> Setpoint {
    let (radius, omega) = (5e-3, 6.0);
    let grown = (t / 1.0).min(1.0);
    let angle = omega * t
        - if axis == 1 {
            0.5 * std::f64::consts::PI
        } else {
            0.0
        };
    Setpoint {
        position: grown * radius * angle.cos(),
        ..Setpoint::default()
    }
}

fn given(t: f64) -> [AxisGiven; 2] {
    [0, 1].map(|axis| AxisGiven {
        reference: at(t, axis),
        load: if axis == 1 { 4.0 } else { 0.0 },
        ..AxisGiven::default()
    })
}

/// Without anything between them, axes of a machine move to the bit as each does alone.
#[test]
fn uncoupled_axes_move_as_each_alone() {
    let stage = stage();
    let machine = Arc::new(CoupledMachine::new([&stage, &stage]).unwrap());
    let mut running = RunningMachine::begin(machine, [0.0; 2]).unwrap();
    let closed_loop = ClosedLoop::new(&stage).unwrap();
    let mut alone = [0, 1].map(|_| closed_loop.start(&Start::at(0.0)).unwrap());
    for k in 0..5000_u32 {
        let t = f64::from(k) * running.period();
        running.advance(&given(t)).unwrap();
        for (axis, state) in alone.iter_mut().enumerate() {
            let AxisGiven {
                reference, load, ..
            } = given(t)[axis];
            state.set_outer_load(load);
            closed_loop
                .step(state, [&reference; 2], &mut NoCompensation, |_| ())
                .unwrap();
            let position = state.plant().seen().position;
            assert_eq!(running.positions()[axis].to_bits(), position.to_bits());
            assert_eq!(running.tool()[axis].to_bits(), position.to_bits());
        }
    }
    assert_eq!(running.periods(), 5000);
    assert!((running.cycles()[0].error()).abs() < 1e-3);
}

/// Squareness moves the tool by φ y, cross-talk by k times the mean acceleration of the last 10 ms.
#[test]
fn coupling_moves_the_tool() {
    let stage = stage();
    let (phi, k) = (1e-3, 1e-4);
    let machine = CoupledMachine::new([&stage, &stage]).unwrap();
    let machine = Arc::new(machine.with_coupling(x_by_y(phi, k)));
    let start = [0.01, -0.02];
    let mut running = RunningMachine::begin(machine, start).unwrap();
    let mut speeds = vec![0.0];
    let mut greatest = 0.0_f64;
    for i in 0..4000_u32 {
        let mut now = given(f64::from(i) * running.period());
        for axis in 0..2 {
            now[axis].reference.position += start[axis];
        }
        running.advance(&now).unwrap();
        speeds.push(running.speeds()[1]);
        let [x, y] = running.positions();
        // 10 ms are 50 periods of 0.2 ms.
        let before = speeds[speeds.len().saturating_sub(51)];
        let acceleration = (speeds[speeds.len() - 1] - before) / 0.01;
        let moved = phi * (y - start[1]) + k * acceleration;
        let [u, v] = running.tool();
        assert!((u - x - moved).abs() < 1e-15, "{i}: {} {moved}", u - x);
        assert_eq!(v, y);
        greatest = greatest.max(moved.abs());
    }
    assert!(greatest > 5e-6, "{greatest}");
}

/// Under a constant force a beam's drives share it; a base under a load at constant acceleration settles at −μ q̈/ω².
#[test]
fn bases_and_beams_act() {
    let stage = stage();
    let beam = GantryBeam {
        stiffness: 1e6,
        damping: 100.0,
        tool: 0.5,
    };
    let machine = CoupledMachine::new([&stage, &stage]).unwrap();
    let machine = machine.with_gantry(1, &stage, beam).unwrap();
    let mut running = RunningMachine::begin(Arc::new(machine), [0.0; 2]).unwrap();
    let pushed = [
        AxisGiven::default(),
        AxisGiven {
            load: 8.0,
            ..AxisGiven::default()
        },
    ];
    for _ in 0..200 {
        running.advance(&pushed).unwrap();
    }
    let alone = {
        let machine = Arc::new(CoupledMachine::new([&stage, &stage]).unwrap());
        let mut running = RunningMachine::begin(machine, [0.0; 2]).unwrap();
        let half = [
            AxisGiven::default(),
            AxisGiven {
                load: 4.0,
                ..AxisGiven::default()
            },
        ];
        for _ in 0..200 {
            running.advance(&half).unwrap();
        }
        running.positions()
    };
    assert!(alone[1] < -1e-9);
    assert!((running.positions()[1] - alone[1]).abs() < 1e-3 * alone[1].abs());

    let mode = BaseMode {
        frequency: 60.0,
        damping: 0.5,
        mass_ratio: 0.2,
        at_tool: 1.0,
    };
    let machine = CoupledMachine::new([&stage, &stage]).unwrap();
    let machine = machine.with_base(0, mode).unwrap();
    let mut running = RunningMachine::begin(Arc::new(machine), [-0.05, 0.0]).unwrap();
    let acceleration = 0.5;
    let mut moved = 0.0;
    for k in 0..1500_u32 {
        let t = f64::from(k) * running.period();
        let mut now = [AxisGiven::default(); 2];
        now[0].reference = Setpoint {
            position: -0.05 + 0.5 * acceleration * t * t,
            velocity: acceleration * t,
            acceleration,
            jerk: 0.0,
        };
        running.advance(&now).unwrap();
        moved = running.tool()[0] - running.positions()[0];
    }
    let omega = std::f64::consts::TAU * 60.0;
    let settled = -0.2 * acceleration / (omega * omega);
    assert!(
        (moved - settled).abs() < 0.05 * settled.abs(),
        "{moved} {settled}"
    );
}

#[test]
fn a_drive_that_stops_is_named() {
    let stage = stage();
    let machine = Arc::new(CoupledMachine::new([&stage, &stage]).unwrap());
    let mut running = RunningMachine::begin(machine, [0.0; 2]).unwrap();
    let mut far = [AxisGiven::default(); 2];
    far[1].reference.position = 5.0;
    let stopped = (0..5000).find_map(|_| running.advance(&far).err()).unwrap();
    assert!(
        stopped.to_string().starts_with("axis 2 (from 1)"),
        "{stopped}"
    );
}

/// Within a period each drive is where its own closed loop is there; the torque that is added is the motor's. Drives of 5 and 10 kHz.
#[test]
fn within_a_period_each_drive_is_where_its_loop_is() {
    let slow = stage();
    let mut fast = slow.clone();
    fast.period = 0.5 * slow.period;
    let machine = Arc::new(CoupledMachine::new([&slow, &fast]).unwrap());
    let mut running = RunningMachine::begin(machine, [0.0; 2]).unwrap();
    let loops = [&slow, &fast].map(|axis| ClosedLoop::new(axis).unwrap());
    let mut alone = loops
        .each_ref()
        .map(|one| one.start(&Start::at(0.0)).unwrap());
    let torque = 0.5;
    let added = [&slow, &fast].map(|axis| torque / axis.torque_constant());
    for k in 0..300_u32 {
        let mut now = given(f64::from(k) * running.period());
        now[0].torque = torque;
        now[1].torque = torque;
        for (axis, parts) in [(0, 1_u32), (1, 2)] {
            let reference = now[axis].reference;
            let offset = &mut Constant(added[axis]);
            let (one, state) = (&loops[axis], &mut alone[axis]);
            state.set_outer_load(now[axis].load);
            let mut there = state.clone();
            let mut share = 0.75 * f64::from(parts);
            while share > 0.999 {
                one.step(&mut there, [&reference; 2], offset, |_| ())
                    .unwrap();
                share -= 1.0;
            }
            let (there, cycle) = one.within(&there, [&reference; 2], offset, share).unwrap();
            let within = running.within(&now, 0.75).unwrap();
            let shown = within.loops()[axis].plant().seen().position;
            assert_eq!(shown.to_bits(), there.plant().seen().position.to_bits());
            assert_eq!(within.cycles()[axis].position, cycle.position);
            for _ in 0..parts {
                one.step(state, [&reference; 2], offset, |_| ()).unwrap();
            }
        }
        running.advance(&now).unwrap();
        for (axis, state) in alone.iter().enumerate() {
            let position = state.plant().seen().position;
            assert_eq!(running.positions()[axis].to_bits(), position.to_bits());
        }
    }
}

/// A constant command.
struct Constant(f64);

impl Compensator for Constant {
    fn reset(&mut self) {}

    fn correct(&mut self, _: &Sample) -> Correction {
        Correction {
            command: self.0,
            ..Correction::default()
        }
    }
}
