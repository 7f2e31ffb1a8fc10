//! The plan of the motion ahead.

use std::fmt::Write;

use axis_scalar::Scalar;
use compensator::{Drive, DriveModel, Planner, PlannerConstants, SECTIONS, StrokeSections};
use lugre::Exponential;

use super::data::{constant, literal, table};
use super::draft::{Draft, State};
use super::{Input, friction, part};

pub(super) fn add<T: Exponential>(draft: &mut Draft, planner: &Planner<T>) {
    let (model, constants) = (planner.model(), planner.constants());
    // Cycles by which a command comes late, a part of one counted as a whole.
    let late = planner.look_ahead() - constants.half - 1;
    draft.data += &format!(
        "#define HALF {}u\n#define WINDOW (2 * HALF + 1)\n#define LATE {late}u\n#define LOOK_AHEAD {}u /* set points beyond the present one */\n",
        constants.half,
        planner.look_ahead()
    );
    friction::law(draft, &model.friction);
    axis(draft, model);
    along(draft, &model.along);
    timing(draft, &constants);
    actuator(draft, model, constants.kept);
    draft.part(&part::PLAN);
    draft.plan = Some((planner.look_ahead(), false));
    let inputs = [
        Input::AheadPosition,
        Input::AheadVelocity,
        Input::AheadAcceleration,
    ];
    draft.inputs.extend(inputs);
    draft.inputs.insert(Input::EffortCommand);
    let window = 2 * constants.half + 1;
    let (whole, part) = sampled_before(model);
    let sampled = whole + 1 + usize::from(part > T::ZERO);
    draft.states.push(State {
        name: "plan",
        declaration: include_str!("runtime/plan.h")
            .replace("@HALF@", &constants.half.to_string())
            .replace("@LATE@", &late.to_string())
            .replace("@SAMPLED@", &sampled.to_string()),
        reals: 6 * (constants.half + 2) + 9 * (late + 2) + 2 * window + 8 + 2 * sampled,
        integers: 5,
    });
}

/// The axis and its drive's loops.
fn axis<T: Exponential>(draft: &mut Draft, model: &DriveModel<T>) {
    let c = &model.cascade;
    draft.data += &[
        constant("PERIOD", model.period, "s"),
        constant("TRAVEL", model.travel, "@L@/rad"),
        constant("LOAD_INERTIA", model.load_inertia, "kg or kg m^2"),
        constant(
            "LEVER",
            model.lever,
            "@L@ per unit of the friction's coordinate",
        ),
        constant("TORQUE_CONSTANT", model.torque_constant(), "N m per @E@"),
        constant(
            "ACTUATOR_LIMIT",
            model.effort_limit,
            "@E@: greatest command",
        ),
        constant("POSITION_GAIN", c.position, "rad/s per @L@"),
        constant(
            "VELOCITY_FEEDFORWARD",
            c.velocity_feedforward,
            "the drive's own",
        ),
        constant(
            "ACCELERATION_FEEDFORWARD",
            c.acceleration_feedforward,
            "the drive's own",
        ),
        format!(
            "#define FROM_MOTOR {} /* whether the position comes from the motor */\n",
            u8::from(c.from_motor)
        ),
    ]
    .concat();
    draft.constants += 9;
}

/// What depends on the position.
fn along<T: Scalar>(draft: &mut Draft, along: &StrokeSections<T>) {
    let [least, per_length] = along.grid();
    let mut rows = String::new();
    for s in along.sections() {
        let values = [s.compliance, s.rotating, s.lagging, s.load].map(literal);
        let _ = writeln!(rows, "    {{{}}},", values.join(", "));
    }
    draft.data += &[
        format!("#define SECTIONS {SECTIONS}u\n"),
        constant("ALONG_LEAST", least, "@L@: position of the first section"),
        constant("ALONG_PER_LENGTH", per_length, "sections per @L@"),
        "typedef struct {\n    real compliance, rotating, lagging, load;\n} section;\n".to_owned(),
        format!(
            "/* Compliance (rad/(N m)), what turns and what of it lags (kg m^2), load (N, N m). */\nstatic const section ALONG[SECTIONS] = {{\n{rows}}};\n"
        ),
    ]
    .concat();
    draft.constants += 2 + 4 * SECTIONS;
}

/// The Gaussian, and the part of a cycle by which commands come late.
fn timing<T: Scalar>(draft: &mut Draft, constants: &PlannerConstants<'_, T>) {
    let [value, rate, second] = constants.weights;
    let part = constants.late_part;
    let share = if part > T::ZERO { part } else { T::ONE };
    draft.data += &[
        constant("LATE_SHARE", share, "of the newest torque"),
        table("VALUE_WEIGHTS", value, "Of the wind-up, oldest first,"),
        table("RATE_WEIGHTS", rate, "of its rate, 1/s,"),
        table("SECOND_WEIGHTS", second, "and of its second rate, 1/s^2."),
    ]
    .concat();
    draft.constants += 1 + 3 * value.len();
}

/// Cycles, whole and part, from the sample that the current controllers go by to the voltage
/// made of it.
fn sampled_before<T: Exponential>(model: &DriveModel<T>) -> (usize, T) {
    let late = model.drive.late();
    (late.floor().to_f64() as usize, late - late.floor())
}

/// The actuator that is inverted.
fn actuator<T: Exponential>(draft: &mut Draft, model: &DriveModel<T>, kept: T) {
    let named = match &model.drive {
        Drive::Lag { gain, .. } => {
            draft.part(&part::LAG);
            vec![
                ("GAIN", *gain, "N m per @E@"),
                ("KEPT", kept, "of the torque over a cycle"),
            ]
        }
        Drive::FieldOriented {
            motor,
            gear,
            d,
            q,
            voltage,
            ..
        } => {
            let (whole, part) = sampled_before(model);
            let between = usize::from(part > T::ZERO);
            draft.data += &format!(
                "#define SAMPLED {}u /* currents from the sampled one to the newest */\n#define SAMPLED_BETWEEN {between} /* whether it lies between two */\n",
                whole + 1 + between
            );
            if part > T::ZERO {
                draft.data += &constant("SAMPLED_PART", part, "of a cycle");
                draft.constants += 1;
            }
            draft.part(&part::FIELD_ORIENTED);
            let p = motor.parameters();
            vec![
                ("POLE_PAIRS", T::of(f64::from(p.pole_pairs)), ""),
                ("RESISTANCE", p.resistance, "Ohm"),
                ("INDUCTANCE_D", p.inductance_d, "H"),
                ("INDUCTANCE_Q", p.inductance_q, "H"),
                ("FLUX_LINKAGE", p.flux_linkage, "V s"),
                (
                    "GEAR",
                    *gear,
                    "radians of the motor per unit of its coordinate",
                ),
                ("D_GAIN", d[0], "V/A"),
                ("D_INTEGRAL", d[1], "V/(A s)"),
                ("Q_GAIN", q[0], "V/A"),
                ("Q_INTEGRAL", q[1], "V/(A s)"),
                ("VOLTAGE", *voltage, "V: greatest length"),
            ]
        }
    };
    for (name, value, meaning) in &named {
        draft.data += &constant(name, *value, meaning);
    }
    draft.constants += named.len();
}
