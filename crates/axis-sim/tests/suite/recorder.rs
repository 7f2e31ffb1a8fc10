//! The log of a run.

use axis_sim::{ClosedLoop, Recorder};
use compensator::NoCompensation;

use crate::{PRINTED, axis};

#[test]
fn channels_are_named_and_complete() {
    let axis = axis(PRINTED);
    let mut recorder = Recorder::default();
    assert!(recorder.log().is_err(), "no cycles, no log");
    let motion = axis.plan(&axis.trajectories[1]).unwrap();
    ClosedLoop::new(&axis)
        .unwrap()
        .run(&motion, &mut NoCompensation, |cycle| recorder.push(cycle))
        .completed()
        .unwrap();
    let log = recorder.log().unwrap();
    assert_eq!(log.len(), recorder.cycles().len());
    let (reference, position) = (
        log.channel("position_ref_m").unwrap(),
        log.channel("position_m").unwrap(),
    );
    for ((cycle, r), p) in recorder.cycles().iter().zip(reference).zip(position) {
        assert_eq!(cycle.error(), r - p);
    }
    assert_eq!(log.time().len(), log.len());
    for name in [
        "motor_angle_rad",
        "motor_speed_rad_s",
        "iq_a",
        "iq_ref_a",
        "uq_v",
        "correction_m",
    ] {
        let samples = log.channel(name).unwrap();
        assert!(samples.iter().all(|v| v.is_finite()));
        // Nothing is a column of zeros but the correction, of which there was none.
        assert_eq!(
            samples.iter().all(|v| *v == 0.0),
            name == "correction_m",
            "{name}"
        );
    }
}
