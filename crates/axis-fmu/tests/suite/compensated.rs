//! The compensated drive as a unit. Its truth are the strategies as `simulate` and `compensate` run
//! them, which are given the whole motion before it begins.

use std::sync::Arc;

use axis_fmu::{FmiVersion, Unit, UnitCorrection, UnitKind, VariableKind, description};
use axis_pipeline::strategies::{NONE, Predictors, STRATEGIES, StrategyKind, named};
use axis_sim::{Axis, ClosedLoop, Cycle, channels};
use cfnn::{Network, Scaling, Shape};
use compensator::TransferFunctionModel;
use trajectories::{Motion, Setpoint};

use crate::{at, get, set, text};

/// Set points of the first trajectory, one a control period, after a standstill.
#[derive(Clone)]
struct Late {
    rows: Vec<Setpoint>,
    period: f64,
    late: usize,
}

impl Late {
    fn of(axis: &Axis, cycles: usize, late: usize) -> Self {
        let motion = axis.plan(&axis.trajectories[0]).unwrap();
        let rows = (0..cycles).map(|k| motion.at(k as f64 * axis.period));
        Self {
            rows: rows.collect(),
            period: axis.period,
            late,
        }
    }
}

impl Motion for Late {
    fn duration(&self) -> f64 {
        (self.rows.len() + self.late - 1) as f64 * self.period
    }

    fn at(&self, time: f64) -> Setpoint {
        let k = (time / self.period).round() as usize;
        let rest = Setpoint {
            position: self.rows[0].position,
            ..Setpoint::default()
        };
        match k.checked_sub(self.late) {
            None => rest,
            Some(k) => self.rows[k.min(self.rows.len() - 1)],
        }
    }
}

/// What any strategy may need: a network that knows the kinematics and little else, transfer
/// functions, and friction a tenth off.
fn predictors(axis: &Axis) -> Predictors {
    let shape = Shape {
        inputs: 4,
        hidden: vec![5, 3],
        outputs: 1,
    };
    let ranges = [(0.0, 1.5), (-0.333, 0.333), (-5.0, 5.0), (-15.0, 15.0)];
    let most = 0.333 * axis.period;
    let scaling = Scaling::from_ranges(&ranges, &[(-most, most)]).unwrap();
    let output = shape.layers()[2].first_parameter;
    let mut weights: Vec<f64> = (0..shape.parameters())
        .map(|i| 0.3 * (1.7 * i as f64).sin())
        .collect();
    weights[output..].iter_mut().for_each(|w| *w *= 1e-3);
    weights[output + 2] = 1.0;
    let network = Network::new(shape, scaling, weights).unwrap();
    let model = |direct| {
        let coefficients = [3e-6, -2e-6, 1e-6];
        TransferFunctionModel::new(axis.period, direct, &[0.98, 0.95, -0.3], &coefficients)
    };
    let mut friction = axis.friction.law.parameters();
    friction.coulomb *= 1.1;
    friction.stiction = friction.stiction.max(friction.coulomb);
    let friction = lugre::LuGre::new(friction).unwrap();
    let models = [model(2e-6).unwrap(), model(-1e-6).unwrap()];
    Predictors::new(axis, network, models, friction)
}

fn axis(name: &str) -> Axis {
    Axis::parse(name, &text(name)).unwrap()
}

/// A unit, and the strategy in it.
fn unit(name: &str, strategy: &str) -> (Unit, &'static StrategyKind, Predictors) {
    let predictors = predictors(&axis(name));
    let correction = UnitCorrection::of(&predictors, strategy).unwrap();
    let unit = Unit::compensated(name, &text(name), correction.text()).unwrap();
    (unit, named(STRATEGIES, strategy).unwrap(), predictors)
}

fn begin(unit: &mut Unit) {
    unit.enter_initialization(0.0, None).unwrap();
    unit.exit_initialization().unwrap();
}

/// What the closed loop of `machine` does along the motion, corrected.
fn simulated(
    machine: &Axis,
    kind: &StrategyKind,
    predictors: &Predictors,
    motion: &Late,
) -> Vec<Cycle> {
    let shared = Arc::new(motion.clone());
    let mut law = kind.compensator(predictors, shared).unwrap();
    let mut cycles = Vec::new();
    let closed_loop = ClosedLoop::new(machine).unwrap();
    let outcome = closed_loop.run(motion, &mut *law, |cycle| cycles.push(*cycle));
    outcome.completed().unwrap();
    cycles
}

/// Gives the unit the set points one by one; what the drive shows of each cycle, by channels.
fn followed(unit: &mut Unit, rows: &[Setpoint], from: usize, to: usize) -> Vec<Vec<f64>> {
    let axis = unit.axes()[0].clone();
    let names: Vec<u32> = (channels(&axis).iter())
        .map(|channel| at(unit, &format!("drive.{}", channel.name(&axis))))
        .collect();
    let inputs: Vec<u32> = (unit.variables().iter())
        .filter(|v| matches!(v.kind, VariableKind::Input(_)))
        .map(|v| v.reference)
        .collect();
    let cycle = |k: usize| {
        let row = rows[k.min(rows.len() - 1)];
        let values = [row.position, row.velocity, row.acceleration];
        for (input, value) in inputs.iter().zip(values) {
            unit.set(*input, value).unwrap();
        }
        let time = unit.time();
        unit.step(time, axis.period).unwrap();
        names.iter().map(|name| unit.get(*name).unwrap()).collect()
    };
    (from..to).map(cycle).collect()
}

fn assert_same(what: &str, axis: &Axis, seen: &[Vec<f64>], cycles: &[Cycle]) {
    assert_eq!(seen.len(), cycles.len());
    for (k, (seen, cycle)) in seen.iter().zip(cycles).enumerate() {
        for (channel, value) in channels(axis).iter().zip(seen) {
            let expected = (channel.read)(cycle);
            assert!(
                value.to_bits() == expected.to_bits(),
                "{what}: {} in cycle {k}: {value} and {expected}",
                channel.name(axis)
            );
        }
    }
}

/// Greatest tracking error, m or rad.
fn worst(cycles: &[Cycle]) -> f64 {
    cycles.iter().map(|c| c.error().abs()).fold(0.0, f64::max)
}

const CYCLES: usize = 2500;

/// Every strategy that runs cycle by cycle, and those that plan on other axes, too.
#[test]
fn a_unit_is_the_strategy_on_the_closed_loop_to_the_bit() {
    let on_liu = axis_pipeline::strategies::CYCLE_BY_CYCLE.iter();
    let on_liu = on_liu.map(|strategy| ("liu2025.toml", *strategy));
    let elsewhere = [
        ("belt.toml", "plan"),
        ("rotary-table.toml", "plan"),
        ("linear-motor.toml", "plan"),
        ("joint.toml", "plan"),
        ("linear-motor.toml", "feedback"),
    ];
    for (name, strategy) in on_liu.chain(elsewhere) {
        let (mut unit, kind, predictors) = unit(name, strategy);
        let axis = unit.axes()[0].clone();
        let motion = Late::of(&axis, CYCLES, unit.look_ahead());
        let mut cycles = simulated(&axis, kind, &predictors, &motion);
        cycles.truncate(CYCLES);
        begin(&mut unit);
        let seen = followed(&mut unit, &motion.rows, 0, cycles.len());
        assert_same(&format!("{name}, {strategy}"), &axis, &seen, &cycles);
        let none = simulated(&axis, &NONE, &predictors, &motion);
        let [with, without] = [&cycles, &none].map(|cycles| worst(&cycles[..CYCLES]));
        println!("{name}, {strategy}: {with:e} with, {without:e} without");
        assert!(with != without, "{name}, {strategy}: nothing was corrected");
        if matches!(strategy, "plan" | "feedback") {
            assert!(with < 0.2 * without, "{name}, {strategy}: {with} {without}");
        }
    }
}

/// The standstill in which references come lets the plan see the beginning of the motion. More of it
/// changes nothing but rounding; without it, as where `simulate` begins at once, the error is greater.
#[test]
fn the_plan_sees_the_beginning_of_the_motion() {
    for strategy in ["plan", "feedback"] {
        let (axis, predictors) = (axis("liu2025.toml"), Predictors::of(&axis("liu2025.toml")));
        let kind = named(STRATEGIES, strategy).unwrap();
        let look_ahead = UnitCorrection::of(&predictors, strategy)
            .unwrap()
            .look_ahead();
        let after = |late: usize| -> Vec<f64> {
            let cycles = simulated(&axis, kind, &predictors, &Late::of(&axis, CYCLES, late));
            cycles[late..].iter().map(Cycle::error).collect()
        };
        let [exact, longer, at_once] = [look_ahead, look_ahead + 77, 0].map(after);
        let pairs = exact.iter().zip(&longer);
        let off = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let most = |errors: &[f64]| errors.iter().map(|e| e.abs()).fold(0.0, f64::max);
        let [exact, at_once] = [&exact, &at_once].map(|errors| most(errors));
        println!("{strategy}: {exact:e} m, {at_once:e} m at once; more standstill: {off:e} m");
        assert!(off < 1e-13, "{strategy}: {off}");
        assert!(exact < 0.5 * at_once, "{strategy}: {exact} and {at_once}");
    }
}

/// A parameter of the unit is one of the machine: the correction goes on assuming the file's.
#[test]
fn a_parameter_changes_the_machine_and_not_what_the_correction_assumes() {
    let (mut unit, kind, predictors) = unit("liu2025.toml", "feedback");
    let motion = Late::of(&unit.axes()[0], 1500, unit.look_ahead());
    set(&mut unit, "mechanism.table_mass_kg", 150.0);
    begin(&mut unit);
    let file = text("liu2025.toml");
    let line = file
        .lines()
        .find(|l| l.starts_with("table_mass_kg"))
        .unwrap();
    let machine = Axis::parse("machine", &file.replace(line, "table_mass_kg = 150")).unwrap();
    let cycles = simulated(&machine, kind, &predictors, &motion);
    let seen = followed(&mut unit, &motion.rows, 0, cycles.len());
    assert_same("another mass", &machine, &seen, &cycles);
}

/// Switched off, it is the closed loop that follows equally late.
#[test]
fn without_its_correction_a_unit_is_the_plain_loop() {
    let (mut unit, _, predictors) = unit("liu2025.toml", "feedback");
    let motion = Late::of(&unit.axes()[0], 1000, unit.look_ahead());
    set(&mut unit, "unit.compensation", 0.0);
    begin(&mut unit);
    let axis = unit.axes()[0].clone();
    let cycles = simulated(&axis, &NONE, &predictors, &motion);
    let seen = followed(&mut unit, &motion.rows, 0, cycles.len());
    assert_same("off", &axis, &seen, &cycles);
    let mut refused = self::unit("liu2025.toml", "plan").0;
    let switch = at(&refused, "unit.compensation");
    let said = refused.set(switch, 0.5).unwrap_err().to_string();
    assert!(said.contains("valid: 0 or 1"), "{said}");
}

/// Saved in memory and as bytes in the middle of a cycle of a motion, looked at between samples.
#[test]
fn states_go_on_to_the_bit() {
    for strategy in ["feedback", "network_lugre", "transfer_function_lugre"] {
        let (mut one, _, _) = unit("liu2025.toml", strategy);
        set(&mut one, "unit.exact_between_samples", 1.0);
        let fresh = one.clone();
        begin(&mut one);
        let period = one.axes()[0].period;
        let rows = Late::of(&one.axes()[0], 1200, 0).rows;
        followed(&mut one, &rows, 0, 500);
        let mut looked_at = one.clone();
        one.step(one.time(), 0.4 * period).unwrap();
        let bytes = one.to_bytes().unwrap();
        let mut states = [one.clone(), fresh.from_bytes(&bytes).unwrap()];
        one.step(one.time(), 0.6 * period).unwrap();
        let ran = followed(&mut one, &rows, 500, 1000);
        for state in &mut states {
            state.step(state.time(), 0.6 * period).unwrap();
            assert!(followed(state, &rows, 500, 1000) == ran, "{strategy}");
        }
        // To look at it between two samples changes nothing.
        looked_at.step(looked_at.time(), period).unwrap();
        let last = followed(&mut looked_at, &rows, 500, 1000);
        assert_eq!(last.last().unwrap()[1..], ran.last().unwrap()[1..]);
        one.reset();
        assert_eq!(get(&mut one, "unit.compensation"), 1.0);
    }
}

#[test]
fn what_cannot_correct_in_a_unit_is_refused() {
    let (axis, file) = (axis("liu2025.toml"), text("liu2025.toml"));
    let said = |made: Result<UnitCorrection, axis_fmu::UnitError>| made.unwrap_err().to_string();
    let none = Predictors::of(&axis);
    for (strategy, words) in [
        ("adaptive", "valid: network, network_lugre"),
        ("nothing", "valid: network, network_lugre"),
        ("network", "needs the trained network"),
        ("lugre", "needs the identified friction"),
        ("transfer_function_lugre", "needs the transfer functions"),
    ] {
        let said = said(UnitCorrection::of(&none, strategy));
        assert!(said.contains(words) && said.contains("valid:"), "{said}");
    }
    let correction = UnitCorrection::of(&predictors(&axis), "network").unwrap();
    for text in [
        "",
        "{}",
        &correction.text()[..200],
        &correction.text().replace("0.98", "1.98"),
    ] {
        let said = said(UnitCorrection::parse(&axis, text));
        assert!(
            said.contains("cannot be read") && said.contains("valid:"),
            "{said}"
        );
    }
    let said = Unit::of(UnitKind::Compensated, "liu2025.toml", &file).unwrap_err();
    assert!(said.to_string().contains("valid: both"), "{said}");
}

/// The token belongs to the correction, and the description says how late references are.
#[test]
fn token_and_description_are_those_of_the_correction() {
    let (plan, _, predictors) = unit("liu2025.toml", "plan");
    let (feedback, ..) = unit("liu2025.toml", "feedback");
    let mut other = predictors.clone();
    other.identified = Some(predictors.axis.friction.law);
    let other = UnitCorrection::of(&other, "plan").unwrap();
    let file = text("liu2025.toml");
    let other = Unit::compensated("liu2025.toml", &file, other.text()).unwrap();
    let tokens = [&plan, &feedback, &other].map(Unit::token);
    assert!(tokens[0] != tokens[1] && tokens[0] != tokens[2] && tokens[1] != tokens[2]);
    for token in &tokens {
        assert_eq!(UnitKind::of_token(token), UnitKind::Compensated);
    }
    for version in [FmiVersion::V2, FmiVersion::V3] {
        let text = description(&feedback, version);
        for part in [
            "(compensated closed loop, feedback; references are followed 82 control periods late)",
            // The trajectory ends within 36320 periods.
            "stopTime=\"3.6402\"",
            "name=\"drive.position_ref_m\"",
            "name=\"unit.compensation\"",
        ] {
            assert!(text.contains(part), "{part}");
        }
    }
}
