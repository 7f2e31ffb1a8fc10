//! The guard: limits, fading, trips.

use compensator::{
    Combined, Compensator, Correction, Guard, GuardLimits, Guarded, NoCompensation, Sample, Status,
    Trip,
};
use proptest::prelude::*;

const LIMITS: GuardLimits = GuardLimits {
    position: 1e-4,
    effort: 3.0,
    surprise: 6.0,
    patience: 5,
    fade: 20,
};

fn correction(position: f64, command: f64) -> Correction {
    Correction { position, command }
}

fn on() -> Guard {
    let mut guard = Guard::new(LIMITS).unwrap();
    guard.switch(true);
    for _ in 0..LIMITS.fade {
        guard.pass(&Correction::default(), 0.0);
    }
    guard
}

#[test]
fn it_fades_in_and_out_without_a_jump() {
    let mut guard = Guard::new(LIMITS).unwrap();
    let asked = correction(5e-5, 2.0);
    let mut before = guard.pass(&asked, 0.0);
    assert_eq!(before, Correction::default());
    for switched in [true, false, true] {
        guard.switch(switched);
        for _ in 0..LIMITS.fade {
            let now = guard.pass(&asked, 0.0);
            let step = (now.command - before.command).abs();
            // The steepest of s² (3 − 2 s), 1.5, over 20 cycles.
            assert!(step <= 2.0 * 1.5 / 20.0 + 1e-12, "{step}");
            before = now;
        }
        let whole = if switched {
            asked
        } else {
            Correction::default()
        };
        assert!((before.command - whole.command).abs() < 1e-12);
        assert!((before.position - whole.position).abs() < 1e-16);
    }
}

#[test]
fn it_trips_for_each_reason_and_stays_off_until_switched() {
    let fine = correction(1e-5, 1.0);
    for (asked, surprise, why) in [
        (correction(2e-4, 1.0), 0.0, Trip::Position),
        (correction(1e-5, -4.0), 0.0, Trip::Effort),
        (fine, 7.0, Trip::Surprise),
        (fine, f64::NAN, Trip::Surprise),
    ] {
        let mut guard = on();
        for _ in 0..LIMITS.patience {
            guard.pass(&asked, surprise);
            assert_eq!(guard.status(), Status::On);
        }
        // A cycle within the limits starts the count anew.
        guard.pass(&fine, 0.0);
        for _ in 0..=LIMITS.patience {
            guard.pass(&asked, surprise);
        }
        assert_eq!(guard.status(), Status::Tripped(why));
        for _ in 0..LIMITS.fade {
            guard.pass(&fine, 0.0);
        }
        assert_eq!(guard.pass(&fine, 0.0), Correction::default());
        guard.switch(true);
        assert_eq!(guard.status(), Status::On);
    }
}

#[test]
fn what_is_no_number_trips_at_once_and_never_comes_out() {
    let mut guard = on();
    guard.pass(&correction(1e-5, 1.0), 0.0);
    for _ in 0..2 * LIMITS.fade {
        let out = guard.pass(&correction(f64::NAN, f64::INFINITY), 0.0);
        assert!(out.position.is_finite() && out.command.is_finite());
    }
    assert_eq!(guard.status(), Status::Tripped(Trip::NotFinite));
}

#[test]
fn limits_that_are_none_are_refused() {
    for bad in [0.0, -1.0, f64::NAN] {
        let limits = GuardLimits {
            effort: bad,
            ..LIMITS
        };
        let message = Guard::new(limits).unwrap_err().to_string();
        assert!(message.contains("effort"), "{message}");
    }
}

/// Is surprised by so much.
struct Surprised(f64);

impl Compensator for Surprised {
    fn reset(&mut self) {}

    fn correct(&mut self, _: &Sample) -> Correction {
        Correction::default()
    }

    fn surprise(&self) -> f64 {
        self.0
    }
}

/// What watches a law watches it in every wrapper that the crate has.
#[test]
fn a_surprise_comes_through_every_wrapper() {
    let trips = |law: &mut dyn Compensator| {
        let mut guarded = Guarded::new(law, on());
        for _ in 0..=LIMITS.patience {
            guarded.correct(&Sample::default());
        }
        guarded.guard().status() == Status::Tripped(Trip::Surprise)
    };
    let much = 2.0 * LIMITS.surprise;
    for surprise in [much, -much, f64::NAN] {
        let law = || Surprised(surprise);
        let calm = || Surprised(0.5 * LIMITS.surprise);
        assert!(trips(&mut Combined::new(law(), NoCompensation)));
        assert!(trips(&mut Combined::new(NoCompensation, law())));
        assert!(trips(&mut Combined::new(calm(), law())));
        assert!(trips(&mut Combined::new(law(), calm())));
        assert!(trips(&mut Combined::new(
            Combined::new(calm(), law()),
            calm()
        )));
        assert!(trips(&mut Guarded::new(law(), on())));
        let boxed: Box<dyn Compensator> = Box::new(law());
        assert!(trips(&mut Combined::new(boxed, calm())));
        assert!(trips(&mut &mut law()));
        assert!(!trips(&mut Combined::new(calm(), calm())));
    }
}

/// Counts what it is asked.
struct Counting(u32);

impl Compensator for Counting {
    fn reset(&mut self) {
        self.0 = 0;
    }

    fn correct(&mut self, _: &Sample) -> Correction {
        self.0 += 1;
        correction(1e-5, 1.0)
    }
}

#[test]
fn a_compensator_goes_on_observing_while_it_is_off() {
    let mut law = Guarded::new(Counting(0), Guard::new(LIMITS).unwrap());
    for _ in 0..7 {
        assert_eq!(law.correct(&Sample::default()), Correction::default());
    }
    assert_eq!(law.inner().0, 7);
    law.guard_mut().switch(true);
    law.reset();
    assert_eq!((law.inner().0, law.guard().status()), (0, Status::On));
}

proptest! {
    #[test]
    fn nothing_beyond_a_limit_comes_out(
        asked in prop::collection::vec((any::<f64>(), any::<f64>(), any::<f64>()), 1..60),
        switches in prop::collection::vec(any::<bool>(), 60),
    ) {
        let mut guard = Guard::new(LIMITS).unwrap();
        for (i, (position, iq, surprise)) in asked.into_iter().enumerate() {
            guard.switch(switches[i]);
            let out = guard.pass(&correction(position, iq), surprise);
            prop_assert!(out.position.abs() <= LIMITS.position);
            prop_assert!(out.command.abs() <= LIMITS.effort);
        }
    }
}

/// A compensator that begins anew asks for something else: the guard goes over to it by
/// s² (3 − 2 s), also while it fades out.
#[test]
fn a_restart_is_no_jump() {
    for switched_off in [false, true] {
        let mut guard = on();
        let mut before = guard.pass(&correction(5e-5, 2.0), 0.0);
        assert_eq!(before, correction(5e-5, 2.0));
        guard.restart();
        guard.switch(!switched_off);
        let asked = correction(-5e-5, 0.0);
        for k in 0..LIMITS.fade {
            let now = guard.pass(&asked, 0.0);
            // The steepest of the curve is 1.5, over 20 cycles; twice, where it fades out too.
            let steepest = 1.5 / 20.0 * if switched_off { 2.0 } else { 1.0 };
            assert!(
                (now.command - before.command).abs() <= 2.0 * steepest + 1e-12,
                "{k}"
            );
            assert!(
                (now.position - before.position).abs() <= 1e-4 * steepest + 1e-16,
                "{k}"
            );
            before = now;
        }
        let last = guard.pass(&asked, 0.0);
        assert_eq!(
            last,
            if switched_off {
                Correction::default()
            } else {
                asked
            }
        );
    }
}

/// Limits that are set while it runs let through what the old ones did not, without a jump; ones
/// that are none are refused and change nothing.
#[test]
fn limits_are_set_at_run_time() {
    let mut guard = on();
    let asked = correction(0.0, 10.0);
    let mut before = guard.pass(&asked, 0.0);
    assert_eq!(before.command, 3.0);
    let wide = GuardLimits {
        effort: 20.0,
        ..LIMITS
    };
    let none = GuardLimits {
        effort: f64::NAN,
        ..wide
    };
    assert!(guard.set_limits(none).is_err());
    assert_eq!(guard.limits(), &LIMITS);
    guard.set_limits(wide).unwrap();
    for _ in 0..LIMITS.fade + 1 {
        let now = guard.pass(&asked, 0.0);
        assert!((now.command - before.command).abs() <= 7.0 * 1.5 / 20.0 + 1e-12);
        before = now;
    }
    assert_eq!((before.command, guard.status()), (10.0, Status::On));
}

/// Asks for what it was given, and for no number for ever after one.
struct Poisoned(f64);

impl Compensator for Poisoned {
    fn reset(&mut self) {
        self.0 = 0.0;
    }

    fn correct(&mut self, sample: &Sample) -> Correction {
        self.0 += sample.iq;
        correction(0.0, self.0)
    }
}

/// One sample that is no number trips the guard; switched on again it stays on.
#[test]
fn a_trip_by_one_nan_is_taken_back() {
    let mut law = Guarded::new(Poisoned(0.0), on());
    let sample = |iq: f64| Sample {
        iq,
        ..Sample::default()
    };
    assert_eq!(law.correct(&sample(1.0)).command, 1.0);
    law.correct(&sample(f64::NAN));
    assert_eq!(law.guard().status(), Status::Tripped(Trip::NotFinite));
    law.guard_mut().switch(true);
    for _ in 0..100 {
        assert!(law.correct(&sample(0.0)).command.is_finite());
    }
    assert_eq!(law.guard().status(), Status::On);
}
