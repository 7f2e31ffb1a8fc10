//! Five machines of a second simulator, none as its file says, tuned from their logs: their own loops, swept with
//! sines while they slide, keep the limits. Nothing of the linear model is in that sweep.

use axis_sim::Axis;
use drive_loop::{LoopSet, MeasureSettings, MeasuredDrive, TuneSettings, Tuning};
use independent_axis::{Carriage, Parameters, Transmission};

use crate::machines::{Machine, Slide, belt, linear_motor, rack, screw};
use crate::support::example;

/// A machine, its file, how it is measured, and sizes of the sines at its command and its position.
struct Case {
    name: &'static str,
    file: &'static str,
    machine: Machine,
    slide: Slide,
    sizes: [f64; 2],
}

fn slide(from: f64, speed: f64, amplitude: f64) -> Slide {
    Slide {
        from,
        speed,
        amplitude,
    }
}

fn late(c: Carriage, by: usize) -> Machine {
    Machine::Carriage(c).later(by)
}

fn screws() -> [Case; 2] {
    let paper = Parameters::paper();
    let heavy = Parameters {
        table_mass: 1.4 * paper.table_mass,
        nut_stiffness: 0.5 * paper.nut_stiffness,
        ..paper
    };
    let case = |name, p: &Parameters, late| Case {
        name,
        file: "liu2025",
        machine: screw(p, late),
        slide: slide(0.6, 0.02, 2.0),
        sizes: [0.05, 2e-7],
    };
    [
        case("screw, command 0.3 ms late", &paper, 3),
        case(
            "screw, 40 % more table, half the nut's stiffness, 0.1 ms late",
            &heavy,
            1,
        ),
    ]
}

fn carriages() -> [Case; 3] {
    let soft = Carriage {
        mass: 1.1 * rack().mass,
        transmission: Transmission::Spring(0.6 * 9.184e7),
        ..rack()
    };
    let light = Carriage {
        mass: 0.8 * linear_motor().mass,
        ..linear_motor()
    };
    [
        Case {
            name: "rack, 10 % more mass, 60 % of the stiffness, 0.25 ms late",
            file: "rack",
            machine: late(soft, 2),
            slide: slide(0.5, 0.05, 4.0),
            sizes: [0.1, 5e-7],
        },
        Case {
            name: "linear motor, 20 % less mass, 0.2 ms late",
            file: "linear-motor",
            machine: late(light, 2),
            slide: slide(0.1, 0.08, 0.5),
            sizes: [0.02, 2e-7],
        },
        Case {
            name: "belt, 0.25 ms late",
            file: "belt",
            machine: late(belt(), 2),
            slide: slide(0.85, 0.04, 0.5),
            sizes: [0.02, 2e-6],
        },
    ]
}

/// Whole frequencies from 3 to 600 Hz, 6 % apart and more.
fn swept_at() -> Vec<f64> {
    let mut all = vec![3.0];
    while let Some(last) = all.last().copied().filter(|f| *f < 600.0) {
        all.push((1.06_f64 * last).round().max(last + 1.0));
    }
    all
}

/// Maximum sensitivities of the machine itself with the gains of an axis: at the command, at the position.
fn greatest(case: &Case, tuned: &Axis, late: usize) -> [f64; 2] {
    let travel = tuned.travel_per_radian();
    let gains = tuned.control.cascade(travel, tuned.period).unwrap();
    let speed = [gains.speed, gains.speed_integral];
    let machine = case.machine.with_gains(gains.position * travel, speed);
    let machine = machine.later(late);
    machine.sensitivities(&case.slide, &swept_at(), case.sizes)
}

/// Tunes from the log, and in comparison on the file alone.
fn is_kept(case: &Case, is_compared: bool) {
    let file = example(case.file);
    let log = case.machine.log(&case.slide);
    let found = MeasuredDrive::of(&file, &log, &MeasureSettings::default()).unwrap();
    assert!(found.is_usable(), "{}: {:?}", case.name, found.traps);
    // The second simulator's drives have no notch.
    let settings = |set| TuneSettings {
        set,
        notch: false,
        simulated: false,
        ..TuneSettings::default()
    };
    let set = LoopSet::nominal().with_measured(&file, &[found]).unwrap();
    let seeing = Tuning::of(&file, &settings(set)).unwrap();
    let [now, late] = [0, 1].map(|by| greatest(case, &seeing.axis, by));
    println!("{}: {now:.3?}, one more cycle late {late:.3?}", case.name);
    for [most, limit] in now
        .map(|ms| [ms, 1.6])
        .into_iter()
        .chain(late.map(|ms| [ms, 2.0]))
    {
        assert!(most <= limit, "{}: {most} above {limit}", case.name);
    }
    // Not by being soft: one of the limits is reached.
    let reached = (now[0].max(now[1]) / 1.6).max(late[0].max(late[1]) / 2.0);
    assert!(reached > 0.97, "{}: {reached}", case.name);
    if is_compared {
        let blind = Tuning::of(&file, &settings(LoopSet::nominal())).unwrap();
        let without = greatest(case, &blind.axis, 0);
        println!("{}: tuned on the file {without:.3?}", case.name);
        assert!(without[0] > 1.8, "{}: {without:?}", case.name);
    }
}

/// Found, at the command and at the position: 1.599 and 1.381 (rack), 1.573 and 1.260 (linear motor), 1.598 and 1.587
/// (belt).
#[test]
fn a_carriage_keeps_the_limits_when_tuned_from_its_log() {
    is_kept(&carriages()[0], true);
}

/// Found of the screws: 1.584 and 1.590, with the heavy table 1.594 and 1.599. Tuned on the file alone the five have at
/// the command 1.936, 2.244, 2.744 (rack), 3.602 (linear motor) and 2.737 (belt).
#[test]
#[ignore = "slow: .ci/release.d/05-slow-tests.sh"]
fn five_machines_keep_the_limits_when_tuned_from_their_logs() {
    for case in &screws() {
        is_kept(case, true);
    }
    for case in &carriages() {
        is_kept(case, true);
    }
}
