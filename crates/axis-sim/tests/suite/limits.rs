//! What leaves a control is within what its actuator takes, whatever lies in between.

use axis_sim::{Axis, ClosedLoop, Cycle, Start};
use compensator::{Compensator, Correction, NoCompensation, Sample};

use trajectories::{Limits, Motion, SCurve};

use crate::{OTHERS, PRINTED, RIGID, axis, changed};

/// Steps of the command to and fro, beyond every limit.
struct BangBang {
    most: f64,
    cycle: u32,
    half_period: u32,
}

impl Compensator for BangBang {
    fn reset(&mut self) {
        self.cycle = 0;
    }

    fn correct(&mut self, _: &Sample) -> Correction {
        let back = (self.cycle / self.half_period) % 2 == 1;
        self.cycle += 1;
        Correction {
            position: 0.0,
            command: if back { -self.most } else { self.most },
        }
    }
}

/// The greatest command under those, and whether a limit was met.
fn driven(axis: &Axis, half_period: u32) -> (f64, bool) {
    let start = axis.stroke.start;
    let limits = Limits::new(0.1, 1.0, 20.0).unwrap();
    let motion = SCurve::plan(start, start + 0.05, &limits).unwrap();
    let mut steps = BangBang {
        most: 3.0 * axis.actuator.limit(),
        cycle: 0,
        half_period,
    };
    let (mut most, mut met) = (0.0_f64, false);
    let _ = ClosedLoop::new(axis)
        .unwrap()
        .run(&motion, &mut steps, |c| {
            most = most.max(c.command.effort.abs());
            met |= c.command.saturated;
        });
    (most, met)
}

#[test]
fn no_command_passes_the_limit_on_any_axis() {
    for name in OTHERS.into_iter().chain([PRINTED, RIGID]) {
        let axis = axis(name);
        for half_period in [1, 7, 40] {
            let (most, met) = driven(&axis, half_period);
            assert!(met, "{name}");
            assert!(most <= axis.actuator.limit(), "{name}: {most}");
        }
    }
}

/// A notch answers to a step with 1.1 times the step, and with more to steps at its frequency.
#[test]
fn no_command_passes_the_limit_behind_a_notch() {
    let filters = "position_rate_khz = 4\ncommand_lowpass_hz = 900\nnotch_hz = 320";
    let axis = changed("rack.toml", &[("position_rate_khz = 4", filters)]);
    for half_period in [9, 12, 13, 100_000] {
        let (most, met) = driven(&axis, half_period);
        assert!(
            met && most == axis.actuator.limit(),
            "{half_period}: {most}"
        );
    }
}

/// Cycles of the rotary table on 150 V at 700 deg/s, its current limit near what its motion takes,
/// each with the greatest command that its drive took in it, A.
fn weakened() -> Vec<(f64, Cycle)> {
    let weakening =
        "dc_link_v = 150\nfield_weakening_gain_a_per_v_s = 20\nfield_weakening_current_a = 6";
    let axis = changed(
        "rotary-table.toml",
        &[
            ("dc_link_v = 540", weakening),
            ("current_limit_a = 30", "current_limit_a = 8"),
            (
                "following_error_limit_deg = 1",
                "following_error_limit_deg = 90",
            ),
            ("maximum_deg = 360", "maximum_deg = 1200"),
        ],
    );
    let limits = Limits::new(700f64.to_radians(), 12.0, 200.0).unwrap();
    let motion = SCurve::plan(-6.0, 20.0, &limits).unwrap();
    let closed = ClosedLoop::new(&axis).unwrap();
    let mut state = closed.start(&Start::at(-6.0)).unwrap();
    let at = |k: u64| motion.at(k as f64 * axis.period);
    let cycle = |k: u64| {
        let most = state.actuator().available();
        let along = [&at(k), &at(k + 1)];
        let cycle = closed.step(&mut state, along, &mut NoCompensation, |_| ());
        (most, cycle.unwrap())
    };
    (0..closed.cycles(&motion)).map(cycle).collect()
}

/// The d current takes a part of what the drive may give, and the speed controller is told: its
/// command is within the rest, and leaves it where the error turns.
#[test]
fn field_weakening_does_not_wind_the_speed_controller_up() {
    let (mut limited, mut stuck, mut longest) = (0, 0, 0);
    for (most, c) in weakened() {
        assert!(c.command.effort.abs() <= most, "{most} A: {c:?}");
        let weak = most < 7.5;
        if !weak || c.command.effort.abs() < most {
            stuck = 0;
            continue;
        }
        limited += 1;
        // At the limit although the speed is beyond its set point already.
        let error = c.command.speed_ref - c.measured.motor_speed;
        stuck = if error * c.command.effort < 0.0 {
            stuck + 1
        } else {
            0
        };
        longest = longest.max(stuck);
    }
    println!("{limited} cycles at the limit that is left, {longest} of them beyond the set point");
    assert!(limited > 100, "{limited}");
    assert!(longest < 100, "{longest}");
}
