//! The outside channel in a log.

use axis_sim::{ClosedLoop, CsvRecorder};
use compensator::NoCompensation;

use crate::read;

/// Its integral is the energy that the load gained and the friction took.
#[test]
fn the_motors_power_stands_in_the_log_and_adds_up_to_its_work() {
    let axis = read(outside::HOIST);
    let motion = axis.plan(&axis.trajectories[0]).unwrap();
    let mut recorder = outside::recorder(&axis);
    let mut csv = CsvRecorder::new(Vec::new(), outside::recorder(&axis));
    ClosedLoop::new(&axis)
        .unwrap()
        .run(&motion, &mut NoCompensation, |cycle| {
            recorder.push(cycle);
            csv.push(cycle);
        })
        .completed()
        .unwrap();
    let log = recorder.log().unwrap();
    let power = log.channel("motor_power_w").unwrap();
    let work: f64 = power.iter().sum::<f64>() * axis.period;

    let last = recorder.cycles().last().unwrap();
    let lifted = last.position - axis.stroke.start;
    let slid: f64 = recorder.cycles().iter().map(|c| c.load_speed.powi(2)).sum();
    let moving = 0.5 * (0.002 * last.motor_speed.powi(2) + 200.0 * last.load_speed.powi(2));
    let taken = (1962.0 + 60.0) * lifted + 200.0 * slid * axis.period + moving;
    assert!((work / taken - 1.0).abs() < 5e-4, "{work} {taken} J");

    let text = String::from_utf8(csv.finish().unwrap()).unwrap();
    let header = text.lines().next().unwrap();
    assert!(header.ends_with("motor_power_w"), "{header}");
}
