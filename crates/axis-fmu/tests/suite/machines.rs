//! A machine of several axes as one unit.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use axis_fmu::{FmiVersion, Unit, UnitKind, VariableKind, description};
use axis_machine::{AxisGiven, CoupledMachine, DriveLaw, MachineFile, RunningMachine};
use compensator::NoCompensation;
use toolpath::named::CircleTest;
use toolpath::{FeedLimits, FeedProfile};
use trajectories::{Motion, Setpoint};

use crate::{get, set};

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../data/machines")
        .join(name)
}

fn machine<const D: usize>(name: &str) -> Arc<CoupledMachine<D>> {
    let file = MachineFile::read(&file(name)).unwrap();
    Arc::new(file.machine::<D>().unwrap().unwrap())
}

/// A unit in step mode where its axes begin.
fn ready(name: &str) -> Unit {
    let mut unit = Unit::machine(&file(name)).unwrap();
    unit.enter_initialization(0.0, None).unwrap();
    unit.exit_initialization().unwrap();
    unit
}

const LETTERS: [&str; 3] = ["x", "y", "z"];

/// References that differ between axes, with a force and an added torque.
fn given<const D: usize>(starts: &[f64; D], t: f64) -> [AxisGiven; D] {
    std::array::from_fn(|axis| {
        let (omega, radius) = (20.0 + 3.0 * axis as f64, 2e-4);
        AxisGiven {
            reference: Setpoint {
                position: starts[axis] + radius * (1.0 - (omega * t).cos()),
                velocity: radius * omega * (omega * t).sin(),
                acceleration: radius * omega * omega * (omega * t).cos(),
                jerk: 0.0,
            },
            load: 10.0 * (50.0 * t).sin(),
            torque: 0.0,
        }
    })
}

/// Sets what is given; `offset` is the input of the motor, in its unit.
fn set_all<const D: usize>(unit: &mut Unit, given: &[AxisGiven; D], offset: f64) {
    for (axis, letter) in LETTERS.iter().enumerate().take(D) {
        let reference = &given[axis].reference;
        let motor = [
            format!("{letter}.torque_offset_n_m"),
            format!("{letter}.force_offset_n"),
        ];
        let motor = motor
            .iter()
            .find(|name| unit.variables().named(name).is_some());
        let motor = motor.unwrap().clone();
        set(unit, &motor, offset);
        for (name, value) in [
            ("position_ref_m", reference.position),
            ("velocity_ref_m_s", reference.velocity),
            ("acceleration_ref_m_s2", reference.acceleration),
            ("load_force_n", given[axis].load),
        ] {
            set(unit, &format!("{letter}.{name}"), value);
        }
    }
}

/// Beside axis-machine's own machine under the same references: difference 0.0 in the tool and in what each drive does.
fn beside<const D: usize>(name: &str) {
    let machine = machine::<D>(name);
    let mut unit = Unit::machine(&file(name)).unwrap();
    unit.enter_initialization(0.0, None).unwrap();
    // Off the file's start, so that what is shown at first is seen to be of these references.
    let starts: [f64; D] = std::array::from_fn(|axis| {
        let reference = format!("{}.position_ref_m", LETTERS[axis]);
        let start = get(&mut unit, &reference) + 0.01 * (axis + 1) as f64;
        set(&mut unit, &reference, start);
        start
    });
    unit.exit_initialization().unwrap();
    // What the drives sample first stands there before any step.
    for (axis, letter) in LETTERS.iter().enumerate().take(D) {
        assert_eq!(get(&mut unit, &format!("{letter}.drive.t_s")), 0.0);
        let first = get(&mut unit, &format!("{letter}.drive.position_m"));
        assert!((first - starts[axis]).abs() < 1e-5, "{letter}: {first}");
    }
    let mut running = RunningMachine::begin(machine.clone(), starts).unwrap();
    let period = unit.period();
    assert_eq!(period, running.period());
    let (mut moved, mut apart) = (0.0_f64, 0.0_f64);
    for k in 0..3000_u32 {
        let t = f64::from(k) * period;
        let mut now = given(&starts, t);
        let offset = 0.05 * (30.0 * t).sin();
        for drive in machine.drives() {
            let axis = drive.closed_loop.axis();
            let is_force = unit
                .variables()
                .named(&format!("{}.force_offset_n", LETTERS[drive.axis]));
            now[drive.axis].torque = match is_force {
                Some(_) => offset * axis.travel_per_radian(),
                None => offset,
            };
        }
        set_all(&mut unit, &now, offset);
        let time = unit.time();
        unit.step(time, period).unwrap();
        running.advance(&now).unwrap();
        let tool = running.tool();
        for (axis, letter) in LETTERS.iter().enumerate().take(D) {
            let shown = get(&mut unit, &format!("tool.{letter}_m"));
            assert_eq!(shown - tool[axis], 0.0, "{name}: {letter} at {k}");
            moved = moved.max((shown - starts[axis]).abs());
            apart =
                apart.max((shown - get(&mut unit, &format!("{letter}.machine.position_m"))).abs());
        }
        for (d, drive) in machine.drives().iter().enumerate() {
            let is_second = d > 0 && machine.drives()[d - 1].axis == drive.axis;
            let second = if is_second { "second." } else { "" };
            let prefix = format!("{}.{second}", LETTERS[drive.axis]);
            let (position, speed) = {
                let seen = running.loops()[d].plant().seen();
                (seen.position, seen.speed)
            };
            assert_eq!(
                get(&mut unit, &format!("{prefix}machine.position_m")),
                position
            );
            assert_eq!(get(&mut unit, &format!("{prefix}machine.speed_m_s")), speed);
            let measured = running.cycles()[d].measured.position;
            assert_eq!(
                get(&mut unit, &format!("{prefix}drive.position_m")),
                measured
            );
        }
    }
    println!("{name}: difference 0.0, moved {moved:e}, tool beside the scale {apart:e}");
    assert!(moved > 3e-4 && apart > 1e-9, "{moved} {apart}");
}

#[test]
fn a_unit_moves_as_the_machine_does() {
    beside::<2>("liu2025-xy.toml");
    beside::<3>("gantry-xyz.toml");
}

/// Beside the run of a machine along a path, whose references are known ahead: what each controller sees is the same bits.
#[test]
fn along_a_path_controllers_see_what_they_see_in_a_run() {
    let name = "liu2025-xy.toml";
    let machine = machine::<2>(name);
    let circle = CircleTest::new(5e-3).path().unwrap();
    let limits = FeedLimits::equal(0.05, 1.0, 1.0, 20.0);
    let profile = Arc::new(FeedProfile::plan(&circle.path, &limits).unwrap());
    let origin = circle.path.at(0.0).position;
    let motions = machine.motions(&profile, &origin, None);
    let mut state = machine.start(&motions).unwrap();
    let (mut nothing, mut sense) = ([NoCompensation; 2], [(); 2].map(|()| |_: &mut _| ()));
    let mut laws: Vec<DriveLaw<'_>> = (nothing.iter_mut().zip(&mut sense))
        .map(|(compensator, sense)| DriveLaw { compensator, sense })
        .collect();
    let lap = machine.run(&motions, &mut laws, &mut state).unwrap();
    let mut unit = ready(name);
    let period = unit.period();
    for (k, sample) in lap.records[0].iter().enumerate() {
        let t = k as f64 * period;
        for (motion, letter) in motions.iter().zip(LETTERS) {
            let reference = motion.at(t);
            for (name, value) in [
                ("position_ref_m", reference.position),
                ("velocity_ref_m_s", reference.velocity),
                ("acceleration_ref_m_s2", reference.acceleration),
            ] {
                set(&mut unit, &format!("{letter}.{name}"), value);
            }
        }
        let time = unit.time();
        unit.step(time, period).unwrap();
        for (d, letter) in LETTERS.iter().enumerate().take(2) {
            let seen = get(&mut unit, &format!("{letter}.drive.position_m"));
            assert_eq!(seen - lap.records[d][k].position, 0.0, "{letter} at {k}");
        }
        assert_eq!(sample.position, get(&mut unit, "x.drive.position_m"));
    }
    assert!(lap.records[0].len() > 3000);
}

/// Parameters of axis files and of the machine file have limits, and count.
#[test]
fn parameters_of_axes_and_machine_count() {
    let fresh = Unit::machine(&file("liu2025-xy.toml")).unwrap();
    assert_eq!(fresh.kind(), UnitKind::Machine);
    let squareness = "coupling.x_by_y.squareness_um_per_m";
    let variable = fresh.variables().named(squareness).unwrap();
    assert_eq!(
        (variable.start, variable.limits),
        (Some(20.0), Some([-1e4, 1e4]))
    );
    let all = fresh.variables().iter();
    for variable in all.filter(|v| v.kind.is_of_file()) {
        let (start, limits) = (variable.start.unwrap(), variable.limits);
        assert!(
            limits.is_none_or(|[least, most]| least <= start && start <= most),
            "{variable:?}"
        );
    }
    // The squareness alone, at a standstill: φ y of a travel of Y.
    let tool_at = |squareness_um_per_m: f64| {
        let mut unit = fresh.clone();
        set(&mut unit, squareness, squareness_um_per_m);
        unit.enter_initialization(0.0, None).unwrap();
        unit.exit_initialization().unwrap();
        let start = get(&mut unit, "y.position_ref_m");
        for k in 0..4000_u32 {
            set(
                &mut unit,
                "y.position_ref_m",
                start + 1e-3 * f64::from(k) / 4000.0,
            );
            let time = unit.time();
            let period = unit.period();
            unit.step(time, period).unwrap();
        }
        let time = unit.time();
        unit.step(time, 1.0).unwrap();
        let moved = get(&mut unit, "y.machine.position_m") - start;
        (
            get(&mut unit, "tool.x_m") - get(&mut unit, "x.machine.position_m"),
            moved,
        )
    };
    let (with, moved) = tool_at(1000.0);
    assert!((moved - 1e-3).abs() < 1e-5);
    assert!((with - 1e-3 * moved).abs() < 1e-9, "{with}");
    assert!(tool_at(0.0).0.abs() < 1e-9);
}

/// Parameters outside their limits are refused, and one of an axis file changes that axis alone.
#[test]
fn parameters_are_checked_and_keep_to_their_axis() {
    let fresh = Unit::machine(&file("liu2025-xy.toml")).unwrap();
    let squareness = "coupling.x_by_y.squareness_um_per_m";
    let refused = |name: &str, value: f64| {
        let mut unit = fresh.clone();
        set(&mut unit, name, value);
        unit.enter_initialization(0.0, None).unwrap();
        unit.exit_initialization().unwrap_err().to_string()
    };
    let said = refused(squareness, 2e4);
    assert!(
        said.contains("squareness") && said.contains("valid:"),
        "{said}"
    );
    let mass = fresh
        .variables()
        .iter()
        .find(|v| v.name.starts_with("y.") && v.name.contains("mass"));
    let mass = mass.unwrap();
    let said = refused(&mass.name, -1.0);
    assert!(
        said.contains("liu2025-y.toml") && said.contains("valid:"),
        "{said}"
    );
    // One axis alone is changed by its parameter.
    let position_with = |value: f64| {
        let mut unit = fresh.clone();
        set(&mut unit, &mass.name, value);
        unit.enter_initialization(0.0, None).unwrap();
        unit.exit_initialization().unwrap();
        for letter in ["x", "y"] {
            let start = get(&mut unit, &format!("{letter}.position_ref_m"));
            set(&mut unit, &format!("{letter}.position_ref_m"), start + 1e-4);
        }
        unit.step(0.0, 0.02).unwrap();
        ["x", "y"].map(|letter| get(&mut unit, &format!("{letter}.machine.position_m")))
    };
    let start = mass.start.unwrap();
    let [nominal, lighter] = [start, 0.5 * start].map(position_with);
    assert_eq!(nominal[0], lighter[0]);
    assert_ne!(nominal[1], lighter[1]);
}

/// Steps of mixed lengths under inputs that change.
fn go_on(unit: &mut Unit, from: u32, to: u32) {
    let period = unit.period();
    let inputs: Vec<_> = (unit.variables().iter())
        .filter(|v| matches!(v.kind, VariableKind::Input(_)))
        .map(|v| (v.reference, v.start.unwrap()))
        .collect();
    for k in from..to {
        for (i, (reference, start)) in inputs.iter().enumerate() {
            let wave = f64::from(k / 3 % 50) * 1e-6 * (1 + i) as f64;
            unit.set(*reference, start + wave).unwrap();
        }
        let time = unit.time();
        let step = [1.0, 0.4, 1.0, 2.6][(k % 4) as usize];
        unit.step(time, step * period).unwrap();
    }
}

fn shown(unit: &mut Unit) -> Vec<u64> {
    let all = unit.variables().clone();
    all.iter()
        .map(|v| unit.get(v.reference).unwrap().to_bits())
        .collect()
}

/// A state of bytes, in an instance made of the unit's own resources, goes on to the bit.
#[test]
fn a_state_of_bytes_goes_on_to_the_bit() {
    for name in ["liu2025-xy.toml", "gantry-xyz.toml"] {
        let fresh = Unit::machine(&file(name)).unwrap();
        let mut one = fresh.clone();
        set(&mut one, "unit.exact_between_samples", 1.0);
        one.enter_initialization(1.0, Some(100.0)).unwrap();
        one.exit_initialization().unwrap();
        go_on(&mut one, 0, 500);
        let bytes = one.to_bytes().unwrap();
        let mut other = fresh.from_bytes(&bytes).unwrap();
        assert_eq!(other.to_bytes().unwrap(), bytes);
        assert_eq!(shown(&mut other), shown(&mut one), "{name}");
        let start = shown(&mut one);
        for unit in [&mut one, &mut other] {
            go_on(unit, 500, 700);
        }
        assert_eq!(shown(&mut other), shown(&mut one), "{name}");
        assert_ne!(shown(&mut one), start);
    }
}

/// Steps that no period divides give the same samples; what is shown between them is on the way from one to the next.
#[test]
fn steps_of_any_length_give_the_same_samples() {
    let name = "gantry-xyz.toml";
    let tool = |parts: u32, exact: f64| {
        let mut unit = Unit::machine(&file(name)).unwrap();
        set(&mut unit, "unit.exact_between_samples", exact);
        unit.enter_initialization(0.0, None).unwrap();
        unit.exit_initialization().unwrap();
        let start = get(&mut unit, "y.position_ref_m");
        set(&mut unit, "y.position_ref_m", start + 1e-4);
        let step = unit.period() / f64::from(parts);
        let mut rows = Vec::new();
        for k in 0..200 * parts {
            unit.step(f64::from(k) * step, step).unwrap();
            rows.push(get(&mut unit, "tool.y_m"));
        }
        rows
    };
    let whole = tool(1, 0.0);
    let [held, exact] = [0.0, 1.0].map(|exact| tool(4, exact));
    let mut between = 0;
    for k in 0..199 {
        let parts = [&held, &exact].map(|rows| &rows[4 * k + 3..4 * k + 8]);
        assert_eq!(
            parts.map(|rows| (rows[0], rows[4])),
            [(whole[k], whole[k + 1]); 2],
            "{k}"
        );
        assert!(parts[0][..4].iter().all(|value| *value == whole[k]));
        let along = parts[1].windows(2).all(|pair| pair[0] < pair[1]);
        between += u32::from(along);
    }
    assert!(between > 100, "{between}");
}

/// Its resources make it again, whatever folders the files came from; both descriptions name all variables once.
#[test]
fn resources_make_the_unit_again() {
    for (name, axes) in [("liu2025-xy.toml", 2), ("gantry-xyz.toml", 4)] {
        let unit = Unit::machine(&file(name)).unwrap();
        assert_eq!(UnitKind::of_token(&unit.token()), UnitKind::Machine);
        assert_eq!(unit.axes().len(), axes);
        let folder = tempfile::tempdir().unwrap();
        let library = crate::package::library();
        let library = axis_fmu::UnitLibrary::of(&library).unwrap();
        let bytes = axis_fmu::package(&unit, &[library], FmiVersion::V3).unwrap();
        let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
        archive.extract(folder.path()).unwrap();
        let made = folder.path().join("resources").join(axis_fmu::MACHINE_FILE);
        assert_eq!(Unit::machine(&made).unwrap().token(), unit.token());
        MachineFile::read(&made).unwrap();
        for version in [FmiVersion::V2, FmiVersion::V3] {
            let text = description(&unit, version);
            for variable in unit.variables().iter() {
                let named = format!(" name=\"{}\"", variable.name);
                assert_eq!(text.matches(&named).count(), 1, "{named}");
            }
            assert!(text.contains("<DefaultExperiment startTime=\"0\" stopTime="));
        }
    }
}

#[test]
fn what_makes_no_machine_is_said() {
    let said = |path: &Path| Unit::machine(path).unwrap_err().to_string();
    let missing = said(Path::new("no-such.toml"));
    assert!(
        missing.contains("no-such.toml") && missing.contains("valid:"),
        "{missing}"
    );
    let axis = said(&crate::file("belt.toml"));
    assert!(axis.contains("belt.toml"), "{axis}");
    let folder = tempfile::tempdir().unwrap();
    let machine = folder.path().join("machine.toml");
    let text = "schema = 1\nname = \"m\"\n[axes]\nx = \"a.toml\"\ny = \"b.toml\"\n";
    std::fs::write(&machine, text).unwrap();
    let said = said(&machine);
    assert!(said.contains("a.toml"), "{said}");
    let one = Unit::of(UnitKind::Machine, "belt.toml", &crate::text("belt.toml"));
    assert!(one.unwrap_err().to_string().contains("machine file"));
    // A drive that stops ends the run, and the axis is named.
    let mut unit = ready("liu2025-xy.toml");
    set(&mut unit, "y.position_ref_m", 5.0);
    let said = unit.step(0.0, 1.0).unwrap_err().to_string();
    assert!(
        said.contains("axis 2") && said.contains("reset the unit"),
        "{said}"
    );
}
