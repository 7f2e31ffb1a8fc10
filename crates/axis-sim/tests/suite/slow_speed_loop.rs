//! A speed loop that is slower than the control takes its speed over its own period.

use axis_sim::{ClosedLoop, Cycle, Measured};
use compensator::NoCompensation;

use crate::changed;

const PERIOD: f64 = 1.0 / 8000.0;

/// The rack, its speed loop at 2 kHz beside 8 kHz, shown a motor encoder that turns evenly by one
/// step of `step` rad in four control periods.
fn shown(step: f64) -> Vec<Cycle> {
    let axis = changed(
        "rack.toml",
        &[(
            "position_rate_khz = 4",
            "position_rate_khz = 2\nspeed_rate_khz = 2",
        )],
    );
    let motion = axis.plan(&axis.trajectories[0]).unwrap();
    let (mut cycles, mut k) = (Vec::new(), 0_u32);
    let first = std::cell::Cell::new(None);
    let even = |m: &mut Measured| {
        let start = first.get().unwrap_or(m.motor_angle);
        first.set(Some(start));
        m.motor_angle = start + step * f64::from(k.div_ceil(4));
        k += 1;
    };
    // The machine goes on by itself: it does not matter for how long.
    let _ = ClosedLoop::new(&axis)
        .unwrap()
        .run_sensed(&motion, &mut NoCompensation, even, |c| {
            if cycles.len() < 400 {
                cycles.push(*c);
            }
        });
    cycles
}

#[test]
fn an_even_ramp_of_an_encoder_is_an_even_speed() {
    let step = 1e-5;
    let cycles = shown(step);
    assert!(cycles.len() >= 200, "{}", cycles.len());
    for c in &cycles[8..] {
        let off = c.measured.motor_speed / (step / (4.0 * PERIOD)) - 1.0;
        // Rounding of an angle of some 100 rad.
        assert!(off.abs() < 1e-7, "{}: {}", c.time, c.measured.motor_speed);
    }
}

#[test]
fn a_speed_is_held_until_the_next_is_taken() {
    let axis = changed(
        "rack.toml",
        &[(
            "position_rate_khz = 4",
            "position_rate_khz = 2\nspeed_rate_khz = 2",
        )],
    );
    let motion = axis.plan(&axis.trajectories[0]).unwrap();
    let mut cycles = Vec::new();
    ClosedLoop::new(&axis)
        .unwrap()
        .run(&motion, &mut NoCompensation, |c| cycles.push(*c))
        .completed()
        .unwrap();
    for (k, period) in cycles.chunks_exact(4).enumerate().skip(1) {
        let before = &cycles[4 * k - 4];
        let turned = period[0].measured.motor_angle - before.measured.motor_angle;
        let speed = turned / (4.0 * PERIOD);
        for c in period {
            assert_eq!(c.measured.motor_speed, speed, "{}", c.time);
        }
    }
}
