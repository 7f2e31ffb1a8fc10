//! Replays of a rigid mass: its following-error limit, and logs too long.

use axis_log::{Channel, Log};
use axis_sim::{Axis, Replay, ReplayError, RunStopped, StopReason};

use crate::{PRINTED, RIGID, text};

/// A reference that runs at 0.1 m/s, every millisecond.
fn moving() -> Log {
    let t: Vec<f64> = (0..500).map(|k| f64::from(k) * 1e-3).collect();
    let position: Vec<f64> = t.iter().map(|t| 0.1 * t).collect();
    Log::new(vec![
        Channel::new("t_s", t).unwrap(),
        Channel::new("position_ref_m", position.clone()).unwrap(),
        Channel::new("position_m", position).unwrap(),
    ])
    .unwrap()
}

#[test]
fn a_rigid_mass_has_its_own_following_error_limit() {
    let replay = Replay::new(&moving(), 1e-3).unwrap();
    let with = |limit: &str| {
        let content = text(RIGID).replace("[stroke]", &format!("{limit}\n[stroke]"));
        replay.run(&Axis::parse("emps.toml", &content).unwrap(), &[], None)
    };
    // A P–P loop lags by about v / K_p = 0.62 mm.
    assert!(with("").is_ok());
    assert!(with("following_error_limit_mm = 1").is_ok());
    let error = with("following_error_limit_mm = 0.5").unwrap_err();
    assert!(matches!(
        error,
        ReplayError::Stopped(RunStopped {
            reason: StopReason::FollowingError(5e-4, _),
            ..
        })
    ));
    assert!(
        error.to_string().contains("following_error_limit"),
        "{error}"
    );
}

#[test]
fn a_log_too_long_to_be_held_is_refused() {
    for file in [PRINTED, RIGID] {
        let axis = Axis::parse(file, &text(file)).unwrap();
        // Two rows, 10⁹ s apart.
        let ends = |name, last| Channel::new(name, vec![0.0, last]).unwrap();
        let log = Log::new(vec![
            ends("t_s", 1e9),
            ends("position_ref_m", 0.0),
            ends("position_m", 0.0),
        ])
        .unwrap();
        let error = Replay::new(&log, 1e9)
            .unwrap()
            .run(&axis, &[], None)
            .unwrap_err();
        assert!(matches!(error, ReplayError::TooLong { .. }), "{error}");
        assert!(
            error.to_string().contains("more than 1e8 cycles"),
            "{error}"
        );
    }
}

#[test]
fn a_period_that_is_none_is_refused() {
    for period in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        let error = Replay::new(&moving(), period).unwrap_err();
        assert!(matches!(error, ReplayError::Period { .. }), "{error}");
    }
}
