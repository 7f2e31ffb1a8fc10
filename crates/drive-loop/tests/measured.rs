//! Measured responses: simulated slides with noise, whose machine, friction and current loops the simulator
//! integrates step by step, beside the linear responses.

use axis_log::Log;
use axis_sim::{Axis, ClosedLoop, Measured, Recorder, excitation_channel};
use compensator::NoCompensation;
use drive_loop::{LoopAnalysis, LoopSet, MeasureSettings, MeasuredDrive, TuneSettings, Tuning};
use frequency_response::{Excitation, Prbs};
use trajectories::{Limits, Motion, Program, Step};

use crate::support::example;

/// Normal numbers of a generator of its own (Knuth's MMIX, twelve uniform ones added).
struct Noise(u64);

impl Noise {
    fn normal(&mut self) -> f64 {
        let mut sum = -6.0;
        for _ in 0..12 {
            self.0 = self
                .0
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            sum += (self.0 >> 11) as f64 / (1u64 << 53) as f64;
        }
        sum
    }
}

/// A slide, excited.
#[derive(Clone, Copy)]
struct Slide {
    from: f64,
    speed: f64,
    seconds: f64,
    amplitude: f64,
    register: u32,
}

impl Default for Slide {
    fn default() -> Self {
        Self {
            from: 0.6,
            speed: 0.02,
            seconds: 5.0,
            amplitude: 2.0,
            register: 12,
        }
    }
}

/// Its log, with the noise of good sensors.
fn log(axis: &Axis, slide: Slide) -> Log {
    let limits = Limits::new(slide.speed.max(1e-6), 0.225, 1.2).unwrap();
    let step = match slide.speed > 0.0 {
        true => Step::Move {
            to: slide.from + slide.speed * (slide.seconds + 0.1),
            limits,
        },
        false => Step::Dwell {
            duration: slide.seconds + 0.6,
        },
    };
    let dwell = Step::Dwell { duration: 0.1 };
    let program = Program::new(slide.from, vec![dwell, step, dwell]).unwrap();
    let h = axis.period;
    let start = (0.5 / h) as usize;
    let count = (slide.seconds / h) as usize - (0.5 / h) as usize;
    let prbs = Prbs {
        amplitude: slide.amplitude,
        register: slide.register,
        clock: 2,
        seed: 0,
    };
    let mut samples = vec![0.0; start];
    if slide.amplitude > 0.0 {
        samples.extend(
            Excitation::Prbs(Prbs { ..prbs })
                .samples(1.0 / h, count)
                .unwrap(),
        );
    }
    assert!(samples.len() as f64 * h < program.duration());
    let closed = ClosedLoop::new(axis).unwrap().with_excitation(samples);
    let mut recorder = Recorder::new(axis).with(excitation_channel(axis));
    let mut noise = Noise(7);
    let sense = |seen: &mut Measured| {
        seen.position += 1e-8 * noise.normal();
        seen.motor_angle += 2e-6 * noise.normal();
        seen.motor_speed += 0.01 * noise.normal();
        seen.current.q += 5e-3 * noise.normal();
    };
    let outcome = closed.run_sensed(&program, &mut NoCompensation, sense, |cycle| {
        recorder.push(cycle)
    });
    outcome.completed().unwrap();
    recorder.log().unwrap()
}

fn measured(axis: &Axis, log: &Log) -> MeasuredDrive {
    MeasuredDrive::of(axis, log, &MeasureSettings::default()).unwrap()
}

/// Relative errors of the motor's speed over the lines up to a frequency whose coherence is above 0.9.
fn errors(found: &MeasuredDrive, band: [f64; 2]) -> Vec<f64> {
    let lines = found.motor_speed.iter().zip(&found.motor_speed_model);
    let mut all: Vec<f64> = lines
        .filter(|(line, _)| line.coherence > 0.9 && (band[0]..band[1]).contains(&line.frequency_hz))
        .map(|(line, model)| {
            let error = (line.value[0] - model[0]).hypot(line.value[1] - model[1]);
            error / model[0].hypot(model[1])
        })
        .collect();
    all.sort_by(f64::total_cmp);
    all
}

fn quantile(of: &[f64], share: f64) -> f64 {
    of[((of.len() - 1) as f64 * share) as usize]
}

fn margins(found: &MeasuredDrive) -> drive_loop::MeasuredMargins {
    found.margins.unwrap()
}

fn refused(found: &MeasuredDrive) -> Vec<&str> {
    let traps = found.traps.iter().filter(|trap| trap.refused);
    traps.map(|trap| trap.what.as_str()).collect()
}

fn warned(found: &MeasuredDrive) -> Vec<&str> {
    let traps = found.traps.iter().filter(|trap| !trap.refused);
    traps.map(|trap| trap.what.as_str()).collect()
}

/// 5 s of a slide: against the linear model.
#[test]
fn a_slide_shows_the_machine() {
    let axis = example("liu2025");
    let found = measured(
        &axis,
        &log(
            &axis,
            Slide {
                seconds: 5.5,
                ..Slide::default()
            },
        ),
    );
    let bands = [
        [2.0, 10.0],
        [10.0, 40.0],
        [40.0, 160.0],
        [160.0, 500.0],
        [500.0, 1000.0],
    ];
    assert!(
        found.is_usable() && found.traps.is_empty(),
        "{:?}",
        found.traps
    );
    assert!((found.position - 0.655).abs() < 2e-3 && (found.speed - 0.02).abs() < 1e-4);
    // Found: 0.8, 0.5, 0.7 and 2.3 %.
    for (band, most) in bands.into_iter().zip([0.02, 0.012, 0.015, 0.05]) {
        let median = quantile(&errors(&found, band), 0.5);
        assert!(median < most, "{band:?} {median}");
    }
    let m = margins(&found);
    let model = m.model.unwrap();
    assert!((model - 1.51).abs() < 0.01, "{model}");
    // Found: 0.007 too low, both.
    assert!((m.by_response.value - model).abs() < 0.02, "{m:?}");
    assert!((m.sensitivity.value - model).abs() < 0.02, "{m:?}");
    let compared = found.comparison.as_ref().unwrap();
    assert!(compared.delay_s.value.abs() < 3e-6 && (compared.gain - 1.0).abs() < 0.005);
    assert_eq!(compared.modes.len(), 2);
    for mode in &compared.modes {
        let off = mode.measured_hz.value / mode.model_hz.unwrap() - 1.0;
        assert!(off.abs() < 6e-3, "{mode:?}");
    }
    assert!(compared.said.is_empty(), "{:?}", compared.said);
}

/// Friction that sticks is 100 % off and more at a coherence of 1: refused, for tuning too.
#[test]
fn a_standing_load_is_refused() {
    let axis = example("liu2025");
    let slide = Slide {
        speed: 0.0,
        ..Slide::default()
    };
    let still = measured(&axis, &log(&axis, slide));
    let all = errors(&still, [4.0, 40.0]);
    assert!(quantile(&all, 0.5) > 0.5);
    assert!(
        refused(&still)[0].contains("the load stands"),
        "{:?}",
        still.traps
    );
    let settings = LoopSet::default().with_measured(&axis, &[still]);
    let said = settings.unwrap_err().to_string();
    assert!(
        said.contains("measured response 1: the load stands"),
        "{said}"
    );
}

/// A slide that is too slow, excitation that is too strong or not there.
#[test]
fn an_unsuitable_slide_is_named() {
    let axis = example("liu2025");
    let of = |slide| measured(&axis, &log(&axis, slide));
    let slow = of(Slide {
        speed: 0.004,
        ..Slide::default()
    });
    assert!(
        slow.traps
            .iter()
            .any(|t| t.what.contains("below three times the Stribeck speed"))
    );

    let strong = of(Slide {
        amplitude: 16.0,
        ..Slide::default()
    });
    assert!(
        refused(&strong)
            .iter()
            .any(|w| w.contains("the excitation is saturated")),
        "{:?}",
        strong.traps
    );

    let quiet = of(Slide {
        amplitude: 0.0,
        ..Slide::default()
    });
    assert!(
        refused(&quiet)
            .iter()
            .any(|w| w.contains("has no excitation")),
        "{:?}",
        quiet.traps
    );
    assert!(quiet.margins.is_none());
}

/// Lines that are too coarse, and a log that is too slow.
#[test]
fn a_coarse_response_is_named() {
    let axis = example("liu2025");
    let log = log(&axis, Slide::default());
    let settings = MeasureSettings {
        step_hz: Some(5.0),
        ..MeasureSettings::default()
    };
    let coarse = MeasuredDrive::of(&axis, &log, &settings).unwrap();
    assert!(
        warned(&coarse)
            .iter()
            .any(|w| w.contains("coarser than a fortieth")),
        "{:?}",
        coarse.traps
    );
    let m = margins(&coarse);
    assert!(m.by_response.value < m.model.unwrap() - 0.05, "{m:?}");

    let every = log_every(&log, 2);
    let thin = measured(&axis, &every);
    assert!(
        refused(&thin)
            .iter()
            .any(|w| w.contains("a log of every control cycle"))
    );
}

/// A stretch over which modes move, and voltages at their limit.
#[test]
fn a_drive_beyond_its_range_is_named() {
    let belt = example("belt");
    let slide = Slide {
        from: 0.2,
        speed: 0.2,
        ..Slide::default()
    };
    let long = measured(&belt, &log(&belt, slide));
    assert!(
        warned(&long)
            .iter()
            .any(|w| w.contains("what is measured is a mean")),
        "{:?}",
        long.traps
    );

    let motor = example("linear-motor");
    let quick = Slide {
        from: 0.1,
        speed: 0.08,
        amplitude: 3.0,
        ..Slide::default()
    };
    let quick = measured(&motor, &log(&motor, quick));
    assert!(
        refused(&quick)
            .iter()
            .any(|w| w.contains("the voltage is at its limit of 311.769 V")),
        "{:?}",
        quick.traps
    );
}

fn log_every(log: &Log, every: usize) -> Log {
    log.decimate(every).unwrap()
}

fn with_delay(axis: &Axis, seconds: f64) -> Axis {
    let mut late = axis.clone();
    let key = match late.actuator.kind().name {
        "torque-source" => "delay",
        _ => "command_delay",
    };
    let own = late.actuator.values().optional(key).unwrap_or(0.0);
    late.actuator
        .change(|values| values.set(key, own + seconds))
        .unwrap();
    late
}

/// A delay of 0.3 ms that the file does not have: measured, said, and gains that were tuned on the
/// measurement are safe on the machine, where the model's are not.
fn hidden_delay(name: &str, places: &[f64], slide: Slide) -> [Option<f64>; 2] {
    let file = example(name);
    let machine = with_delay(&file, 3e-4);
    let one = |from: &f64| {
        let slide = Slide {
            from: *from,
            ..slide
        };
        measured(&file, &log(&machine, slide))
    };
    let all: Vec<MeasuredDrive> = places.iter().map(one).collect();
    for found in &all {
        assert!(found.is_usable(), "{name}: {:?}", found.traps);
        let compared = found.comparison.as_ref().unwrap();
        let late = compared.delay_s.value;
        assert!((late - 3e-4).abs() < 9e-6, "{name}: {late:e}");
        assert!(
            compared.said.iter().any(|s| s.contains("command_delay")),
            "{name}"
        );
    }
    // The file's mass alone, sliding and stuck.
    let settings = |set| TuneSettings {
        set,
        notch: false,
        simulated: false,
        ..TuneSettings::default()
    };
    let greatest = |gains: &Axis| {
        let mut tuned = machine.clone();
        let values = gains.control.values().clone();
        tuned.control.change(|own| *own = values).unwrap();
        let set = LoopSet::nominal();
        LoopAnalysis::of(&tuned, &set).unwrap().worst.sensitivity
    };
    let blind = Tuning::of(&file, &settings(LoopSet::nominal())).unwrap();
    let set = LoopSet::nominal().with_measured(&file, &all).unwrap();
    let seeing = Tuning::of(&file, &settings(set)).unwrap();
    let both = [blind, seeing].map(|t| greatest(&t.axis));
    println!("{name}: {both:.3?}");
    both
}

/// Found: 2.32 and 1.60 (liu2025), 2.87 and 1.60 (rack), 4.81 and 1.60 (linear motor), 3.53 and 1.60 (belt).
#[test]
fn gains_of_a_measured_response_are_safe_under_a_hidden_delay() {
    let slide = Slide {
        seconds: 5.5,
        ..Slide::default()
    };
    let [blind, seeing] = hidden_delay("liu2025", &[0.1, 1.35], slide);
    assert!(blind.is_none_or(|s| s > 2.0) && seeing.unwrap() < 1.7);
    let [blind, seeing] = hidden_delay(
        "rack",
        &[0.5],
        Slide {
            speed: 0.05,
            amplitude: 4.0,
            ..slide
        },
    );
    assert!(blind.is_none_or(|s| s > 2.0) && seeing.unwrap() < 1.7);
    let [blind, seeing] = hidden_delay(
        "linear-motor",
        &[0.1],
        Slide {
            speed: 0.08,
            amplitude: 0.5,
            ..slide
        },
    );
    assert!(blind.is_none_or(|s| s > 2.0) && seeing.unwrap() < 1.7);
    let [blind, seeing] = hidden_delay(
        "belt",
        &[0.6],
        Slide {
            speed: 0.1,
            amplitude: 1.5,
            ..slide
        },
    );
    assert!(blind.is_none_or(|s| s > 2.0) && seeing.unwrap() < 1.7);
}

/// A body of 150 kg on the table that oscillates at 30 Hz by itself, which the file does not have: its mode
/// with table and motor is near that. Found: 29.5 Hz.
#[test]
fn a_body_on_the_table_is_said() {
    let file = example("liu2025");
    let text = std::fs::read_to_string(format!(
        "{}/../../data/axes/liu2025.toml",
        env!("CARGO_MANIFEST_DIR")
    ));
    let body = "\n[[effects]]\nname = \"structural-resonance\"\nmass = 150\nfrequency = 30\ndamping_ratio = 0.02\n";
    let machine = Axis::parse("liu2025.toml", &(text.unwrap() + body)).unwrap();
    let slide = Slide {
        seconds: 5.5,
        ..Slide::default()
    };
    let found = measured(&file, &log(&machine, slide));
    let compared = found.comparison.as_ref().unwrap();
    let new = compared.modes.iter().find(|mode| mode.model_hz.is_none());
    let at = new.unwrap().measured_hz.value;
    assert!((29.0..31.0).contains(&at), "{at}");
    let said = &compared.said;
    assert!(
        said.iter().any(|s| s.contains("the model has no mode at")),
        "{said:?}"
    );
}

#[test]
fn settings_that_are_none_are_refused() {
    let axis = example("liu2025");
    let log = log(
        &axis,
        Slide {
            seconds: 1.5,
            ..Slide::default()
        },
    );
    let said = |settings| {
        let found = MeasuredDrive::of(&axis, &log, &settings);
        found.map(|found| found.method).unwrap_err().to_string()
    };
    let own = MeasureSettings::default();
    let coherence = f64::NAN;
    assert!(said(MeasureSettings { coherence, ..own }).contains("valid: from 0 to 1"));
    let most_poles = 0;
    assert!(said(MeasureSettings { most_poles, ..own }).contains("from 1 to 16"));
    for step in [0.0, -1.0, f64::INFINITY] {
        let step_hz = Some(step);
        assert!(said(MeasureSettings { step_hz, ..own }).contains("above 0 Hz"));
    }
    let step_hz = Some(0.1);
    assert!(said(MeasureSettings { step_hz, ..own }).contains("valid: a longer record"));
}
