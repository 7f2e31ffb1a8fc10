//! What can be known before a search, and searches with a library that is there already.

use std::sync::Arc;

use axis_sim::effects::{ActiveEffect, Effect, Scales};
use axis_sim::{Axis, ClosedLoop, Recorder};
use compensator::NoCompensation;
use discrepancy::{
    Hypothesis, Library, LogSet, Prediction, SearchError, SensorNoise, Settings, search_with,
};
use trajectories::{Limits, Program, Step};

const NOISE: SensorNoise = SensorNoise {
    position: 1e-8,
    angle: 2e-6,
    speed: 0.01,
    current: 5e-3,
};

fn machine() -> Axis {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/rack.toml");
    Axis::read(file.as_ref()).unwrap()
}

/// The machine's own log, without noise, of a way there and back.
fn log_of(machine: &Axis, length: f64) -> LogSet {
    let start = machine.stroke.start;
    let to = |to: f64| Step::Move {
        to,
        limits: Limits::new(0.05, 0.2, 2.0).unwrap(),
    };
    let rest = Step::Dwell { duration: 0.1 };
    let steps = vec![rest, to(start + length), rest, to(start), rest];
    let motion = Program::new(start, steps).unwrap();
    let mut recorder = Recorder::new(machine);
    ClosedLoop::new(machine)
        .unwrap()
        .run(&motion, &mut NoCompensation, |cycle| recorder.push(cycle))
        .completed()
        .unwrap();
    let log = recorder.log().unwrap();
    LogSet::new(vec![("own".to_owned(), log, machine.period)], machine).unwrap()
}

fn supposed(machine: &Axis, name: &str, by: f64) -> Hypothesis {
    let effect = Effect::named(name).unwrap();
    let mut values = effect.typical(&Scales::of(machine));
    for (value, p) in values.iter_mut().zip(effect.parameters) {
        if p.is_size() {
            *value *= by;
        }
    }
    Hypothesis {
        effects: vec![ActiveEffect { effect, values }],
        shares: Vec::new(),
        noise: 1.0,
        of_channels: Vec::new(),
        rejected: Vec::new(),
    }
}

#[test]
fn what_is_foreseen_follows_size_noise_and_what_the_search_has() {
    let machine = machine();
    let set = log_of(&machine, 0.03);
    let prediction = Prediction::new(&machine, &set, NOISE).unwrap();
    let one = |supposed: &Hypothesis| prediction.predict(supposed).remove(0).unwrap();

    let nothing = one(&supposed(&machine, "constant-load", 0.0));
    assert!(
        !nothing.detectable && nothing.gain.abs() < 1e-6,
        "{nothing:?}"
    );

    // With the square of the size, but for what known parameters make up for.
    let load = supposed(&machine, "constant-load", 1.0);
    let (half, full) = (one(&supposed(&machine, "constant-load", 0.5)), one(&load));
    assert!(full.detectable && full.imitation.is_none(), "{full:?}");
    assert!(full.gain > half.gain, "{half:?} {full:?}");

    // The least of |y − Cx|²/ν² + xᵀPx falls with the noise ν, and ν² times it rises.
    let louder = one(&Hypothesis {
        noise: 2.0,
        ..load.clone()
    });
    assert!(louder.gain < full.gain, "{louder:?} {full:?}");
    assert!(
        4.0 * louder.gain >= full.gain * (1.0 - 1e-9),
        "{louder:?} {full:?}"
    );

    // Where a channel's noise is far above what hides it, the evidence is the same, and none
    // of it material.
    let beneath = one(&Hypothesis {
        of_channels: vec![1e6; set.channels.len()],
        ..load.clone()
    });
    assert_eq!(beneath.gain, full.gain);
    assert!(!beneath.detectable);

    // Shares that are missing are 0.
    let shares = vec![0.0; machine.known().len()];
    let told = Hypothesis {
        shares,
        ..load.clone()
    };
    assert_eq!(one(&told), full);

    // What the search may not name is imitated by others, itself not among them.
    let rejected = vec!["constant-load".to_owned()];
    let without = one(&Hypothesis {
        rejected,
        ..load.clone()
    });
    let imitation = without.imitation.unwrap();
    assert!(!imitation.by.contains(&"constant-load".to_owned()) && !imitation.by.is_empty());

    // Beside no noise, or noise that is no number, nothing can be said.
    for noise in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let silent = Hypothesis {
            noise,
            ..load.clone()
        };
        assert_eq!(prediction.predict(&silent), [None], "{noise}");
        assert_eq!(prediction.gain_over_needed(&silent), f64::INFINITY);
    }
}

#[test]
fn a_library_of_other_logs_or_another_machine_is_refused() {
    let machine = machine();
    let (short, long) = (log_of(&machine, 0.01), log_of(&machine, 0.03));
    let of = |machine: &Axis, set: &LogSet| {
        let library = Library::of_effects(machine, set, |e| e.name == "constant-load");
        Arc::new(library.unwrap())
    };
    let tried = |library: Arc<Library>| {
        let settings = Settings::default();
        search_with(&machine, &long, &long, &settings, library, |_| ())
    };
    let found = tried(of(&machine, &long)).unwrap();
    assert!(found.named.is_empty(), "{:?}", found.named);
    let error = tried(of(&machine, &short)).unwrap_err();
    assert!(matches!(error, SearchError::OtherLibrary), "{error}");
    assert!(
        error.to_string().contains("logs that are fitted"),
        "{error}"
    );

    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/emps.toml");
    let other = Axis::read(file.as_ref()).unwrap();
    let library = of(&other, &log_of(&other, 0.01));
    assert!(matches!(tried(library), Err(SearchError::OtherLibrary)));
}
