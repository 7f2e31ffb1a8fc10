//! The log of a run.

use axis_sim::effects::{ActiveEffect, Effect};
use axis_sim::{ClosedLoop, CsvRecorder, Cycle, Recorder};
use compensator::NoCompensation;

use crate::{PRINTED, axis};

#[test]
fn channels_are_named_and_complete() {
    let axis = axis(PRINTED);
    let mut recorder = Recorder::new(&axis);
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

/// The text of a run that is written while it goes on is that of its log.
#[test]
fn the_log_can_be_written_while_the_run_goes_on() {
    let axis = axis(PRINTED);
    let closed_loop = ClosedLoop::new(&axis).unwrap();
    let motion = axis.plan(&axis.trajectories[1]).unwrap();
    // Whole blocks of rows, one more and one less, and none.
    for rows in [1, 4095, 4096, 4097, 8192, 10_000] {
        let mut whole = Recorder::new(&axis);
        let mut flow = CsvRecorder::new(Vec::new(), Recorder::new(&axis));
        closed_loop.run(&motion, &mut NoCompensation, |cycle| {
            if whole.cycles().len() < rows {
                whole.push(cycle);
                flow.push(cycle);
            }
        });
        let mut expected = Vec::new();
        axis_log::write_csv_to(&mut expected, &whole.log().unwrap()).unwrap();
        assert!(flow.finish().unwrap() == expected, "{rows} rows");
    }
    assert!(
        CsvRecorder::new(Vec::new(), Recorder::new(&axis))
            .finish()
            .is_err(),
        "no rows"
    );
}

/// Takes some bytes, then no more.
struct Full(usize);

impl std::io::Write for Full {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if bytes.len() > self.0 {
            return Err(std::io::ErrorKind::StorageFull.into());
        }
        self.0 -= bytes.len();
        Ok(bytes.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_disk_that_fills_up_is_told() {
    let recorder = Recorder::new(&axis(PRINTED));
    // Times of a log increase, and these do not.
    let mut flow = CsvRecorder::new(Vec::new(), recorder.clone());
    (0..2).for_each(|_| flow.push(&Cycle::default()));
    let error = flow.finish().err().unwrap();
    assert_eq!(error.kind(), std::io::ErrorKind::InvalidData);
    let mut flow = CsvRecorder::new(Full(100), recorder);
    for k in 0..5000 {
        flow.push(&Cycle {
            time: f64::from(k),
            ..Cycle::default()
        });
    }
    let error = flow.finish().err().unwrap();
    assert_eq!(error.kind(), std::io::ErrorKind::StorageFull);
}

/// An axis whose load, or reference, is logged on a late clock: in memory and in pieces, the log
/// shows what that clock times of so many cycles before, and everything else as it was.
#[test]
fn a_log_shows_channels_as_late_as_their_clock_is() {
    let of_reference = [
        "position_ref_m",
        "velocity_ref_m_s",
        "acceleration_ref_m_s2",
    ];
    for whole in [7_i32, -7] {
        shows_late("clock-offset", &["position_m"], whole);
        shows_late("reference-delay", &of_reference, whole);
    }
}

fn shows_late(effect: &str, channels: &[&str], whole: i32) {
    let axis = axis(PRINTED);
    let (cycles, period) = (5000, axis.period);
    let motion = axis.plan(&axis.trajectories[1]).unwrap();
    let mut late = axis.clone();
    late.effects.push(ActiveEffect {
        effect: Effect::named(effect).unwrap(),
        values: vec![f64::from(whole) * period],
    });
    let mut straight = Recorder::new(&late);
    let mut shown = Recorder::as_logged(&late, period).unwrap();
    let mut flow = CsvRecorder::new(Vec::new(), shown.clone());
    ClosedLoop::new(&late)
        .unwrap()
        .run(&motion, &mut NoCompensation, |cycle| {
            if straight.cycles().len() < cycles {
                straight.push(cycle);
                shown.push(cycle);
                flow.push(cycle);
            }
        });
    let (straight, shown) = (straight.log().unwrap(), shown.log().unwrap());
    for (was, is) in straight.channels().iter().zip(shown.channels()) {
        let is_late = channels.contains(&was.name.as_str());
        let by = if is_late { whole } else { 0 };
        let at = |k: usize| (k as i64 - i64::from(by)).clamp(0, cycles as i64 - 1) as usize;
        for (k, sample) in is.samples.iter().enumerate() {
            let expected = was.samples[at(k)];
            assert!((sample - expected).abs() < 1e-12, "{} {k}", was.name);
        }
        assert!(!is_late || was.samples != is.samples, "{} moves", was.name);
    }
    let mut expected = Vec::new();
    axis_log::write_csv_to(&mut expected, &shown).unwrap();
    assert!(flow.finish().unwrap() == expected);
}
