//! The compliance at the load from measured responses, against forces on the load of machines of a second simulator.

use axis_log::Log;
use axis_sim::{Axis, LoadSensor};
use drive_loop::{ComplianceLine, MeasureSettings, MeasuredDrive};
use independent_axis::{Carriage, Parameters, Transmission};

use crate::machines::{Machine, Slide, belt, linear_motor, rack, screw};
use crate::support::{example, example_text};

/// Frequencies of the force, Hz: whole ones, apart from one another over a second.
const FORCED: [f64; 13] = [
    4.0, 7.0, 11.0, 16.0, 23.0, 33.0, 45.0, 58.0, 75.0, 100.0, 130.0, 160.0, 220.0,
];

const SCREW: Slide = Slide {
    from: 0.6,
    speed: 0.02,
    amplitude: 2.0,
};

fn measured(axis: &Axis, log: &Log) -> MeasuredDrive {
    MeasuredDrive::of(axis, log, &MeasureSettings::default()).unwrap()
}

/// Frequencies of the force on which a line counts, with the relative errors of the measured compliance and of the model's.
fn errors(found: &MeasuredDrive, truth: &[[f64; 2]]) -> Vec<(f64, [f64; 2])> {
    let compliance = found.compliance.as_ref();
    let compliance = compliance.unwrap_or_else(|| panic!("{:?}", found.compliance_missing));
    let one = |(f, [re, im]): (&f64, &[f64; 2])| {
        let is_there = |line: &&ComplianceLine| (line.frequency_hz - f).abs() < 1e-3;
        let line = compliance.lines.iter().find(is_there)?;
        let off = |v: [f64; 2]| (v[0] - re).hypot(v[1] - im) / re.hypot(*im);
        println!(
            "{f:>6} Hz true {:.3e} measured {:.1} % off (deviation {:.1} %), model {:.1} %",
            re.hypot(*im),
            100.0 * off(line.value),
            100.0 * line.deviation / re.hypot(*im),
            100.0 * off(line.model)
        );
        Some((*f, [off(line.value), off(line.model)]))
    };
    FORCED.iter().zip(truth).filter_map(one).collect()
}

fn median(mut of: Vec<f64>) -> f64 {
    of.sort_by(f64::total_cmp);
    of[of.len() / 2]
}

/// What a measurement must show: errors below and from 50 Hz on, of inertia and travel, and elastic modes.
struct Must {
    below: f64,
    above: f64,
    inertia: f64,
    travel: f64,
    modes: usize,
}

/// Measures a machine with an axis file, and compares with forces (N each) on its load. Gives the median of the
/// model's errors.
fn compared(axis: &Axis, machine: &Machine, slide: &Slide, force: f64, must: &Must) -> f64 {
    let found = measured(axis, &machine.log(slide));
    assert!(found.is_usable(), "{:?}", found.traps);
    let all = errors(&found, &machine.answers_to_forces(slide, &FORCED, force));
    let c = found.compliance.as_ref().unwrap();
    let off = |found: f64, true_value: f64| (found / true_value - 1.0).abs();
    println!(
        "inertia {:.2} % off, travel {:.3} % off, {} modes",
        100.0 * off(c.inertia.value, machine.inertia()),
        100.0 * off(c.travel.value, machine.travel()),
        c.modes.len()
    );
    // Of the linear motor two of the lowest have not the coherence.
    assert!(all.len() >= FORCED.len() - 2, "{}", all.len());
    for (f, [measured, _]) in &all {
        let most = if *f < 50.0 { must.below } else { must.above };
        assert!(*measured < most, "{f} Hz: {measured}");
    }
    assert!(off(c.inertia.value, machine.inertia()) < must.inertia);
    assert!(off(c.travel.value, machine.travel()) < must.travel);
    assert_eq!(c.modes.len(), must.modes);
    median(all.iter().map(|(_, e)| e[1]).collect())
}

/// The machine of the file, and one with 40 % more table and half the stiffness of the nut, of which the file
/// knows nothing.
#[test]
fn responses_show_the_compliance_of_forces_on_the_table() {
    let axis = example("liu2025");
    let own = Parameters::paper();
    let other = Parameters {
        table_mass: 1.4 * own.table_mass,
        nut_stiffness: 0.5 * own.nut_stiffness,
        ..own
    };
    // Found: 2.7 % at most, below 10 Hz; below 1 % from 58 Hz on.
    let must = Must {
        below: 0.04,
        above: 0.012,
        inertia: 0.04,
        travel: 2e-3,
        modes: 2,
    };
    for (p, is_known) in [(own, true), (other, false)] {
        let model = compared(&axis, &screw(&p, 0), &SCREW, 15.0, &must);
        // Of the file the model is right (0.1 % found), of the other machine 60 % off.
        assert!(if is_known { model < 0.01 } else { model > 0.3 }, "{model}");
    }
}

/// A carriage on a rack with 20 % more mass and 60 % of the stiffness that its file has.
#[test]
fn a_rack_shows_its_compliance() {
    let own = rack();
    let other = Carriage {
        mass: 1.2 * own.mass,
        transmission: Transmission::Spring(0.6 * 9.184e7),
        ..own
    };
    let slide = Slide {
        from: 0.5,
        speed: 0.05,
        amplitude: 4.0,
    };
    // Found: 0.3 % at most.
    let must = Must {
        below: 0.004,
        above: 0.006,
        inertia: 0.004,
        travel: 2e-3,
        modes: 1,
    };
    let axis = example("rack");
    for (machine, is_known) in [(own, true), (other, false)] {
        let model = compared(&axis, &Machine::Carriage(machine), &slide, 15.0, &must);
        assert!(if is_known { model < 0.02 } else { model > 0.1 }, "{model}");
    }
}

/// A linear motor has one sensor, which shows motor and load at once; here 30 % more mass than its file.
#[test]
fn a_linear_motor_shows_its_compliance() {
    let own = linear_motor();
    let other = Carriage {
        mass: 1.3 * own.mass,
        ..own
    };
    let slide = Slide {
        from: 0.1,
        speed: 0.08,
        amplitude: 1.5,
    };
    // Found: 1.8 % at most below 50 Hz, 0.1 % from there on.
    let must = Must {
        below: 0.03,
        above: 0.005,
        inertia: 0.002,
        travel: 1e-4,
        modes: 0,
    };
    let axis = example("linear-motor");
    for (machine, is_known) in [(own, true), (other, false)] {
        let model = compared(&axis, &Machine::Carriage(machine), &slide, 5.0, &must);
        assert!(
            if is_known { model < 0.02 } else { model > 0.05 },
            "{model}"
        );
    }
}

/// A belt whose load has no sensor says so; with a scale on it for the measurement it shows the compliance, here
/// with 30 % more load and 70 % of the belt's stiffness.
#[test]
fn a_belt_with_a_scale_shows_its_compliance() {
    let own = belt();
    let Transmission::Belt {
        specific,
        at_zero,
        together,
    } = own.transmission
    else {
        unreachable!()
    };
    let other = Carriage {
        mass: 1.3 * own.mass,
        transmission: Transmission::Belt {
            specific: 0.7 * specific,
            at_zero,
            together,
        },
        ..own
    };
    // Over the middle, where the stiffness is nearly even.
    let slide = Slide {
        from: 0.875,
        speed: 0.032,
        amplitude: 1.0,
    };
    let said = measured(&example("belt"), &Machine::Carriage(own).log(&slide));
    let said = said.compliance_missing.unwrap();
    assert!(said.contains("no sensor at the load"), "{said}");
    let text = example_text("belt")
        + "\n[sensors.load]\nkind = \"scale\"\nresolution_um = 0.1\nsignal_period_um = 20\nperiodic_error_um = 0\n";
    let axis = Axis::parse("belt.toml", &text).unwrap();
    // Found: 1 % at most, 2.1 % near the mode, which the stiffness along the way moves by 0.3 %.
    let must = Must {
        below: 0.02,
        above: 0.03,
        inertia: 0.002,
        travel: 3e-3,
        modes: 1,
    };
    for (machine, is_known) in [(own, true), (other, false)] {
        let model = compared(&axis, &Machine::Carriage(machine), &slide, 1.5, &must);
        assert!(if is_known { model < 0.02 } else { model > 0.1 }, "{model}");
    }
}

/// What is missing is said.
#[test]
fn a_log_without_the_current_shows_no_compliance() {
    let axis = example("liu2025");
    let whole = screw(&Parameters::paper(), 0).log(&SCREW);
    let without = |name: &str| {
        let channels = whole.channels().iter().filter(|c| c.name != name);
        let log = Log::new(channels.cloned().collect()).unwrap();
        let found = MeasuredDrive::of(&axis, &log, &MeasureSettings::default()).unwrap();
        assert!(found.is_usable() && found.compliance.is_none());
        found.compliance_missing.unwrap()
    };
    let said = without("iq_a");
    assert!(
        said.contains("both the command and the actual current"),
        "{said}"
    );
    let mut still = axis.clone();
    still.sensors.load = LoadSensor::Missing;
    let found = MeasuredDrive::of(&still, &whole, &MeasureSettings::default()).unwrap();
    let said = found.compliance_missing.unwrap();
    assert!(said.contains("no sensor at the load"), "{said}");
}
