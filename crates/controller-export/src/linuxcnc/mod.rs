//! A LinuxCNC component around a compensator, between motion and PID.
//!
//! Real-time components are compiled from one file, so the C code stands inside of it. Motion
//! knows the command of now only; the component holds it back by one servo period, which makes
//! it the reference of now, and the newest one that of a cycle ahead. The offset of the position
//! is added to the command and, as `offset.comp` does, taken off the feedback for motion; the
//! offset of the command is a pin of its own.

use crate::c::{self, Input, Precision};
use crate::{ExportError, ExportedController, NamedText};

/// A component and an example of its use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Component {
    /// `NAME.comp`, for `halcompile --install NAME.comp`.
    pub component: NamedText,
    /// `NAME.hal`: how its pins are connected.
    pub example: NamedText,
}

/// The component of a compensator, in double precision. Its pins are in machine units: mm or
/// degrees, unless the parameter `units-per-si` says otherwise.
///
/// # Errors
/// As [`c::export`].
pub fn export(controller: &ExportedController) -> Result<Component, ExportError> {
    let source = c::export(controller, Precision::F64, None)?;
    let code = inlined(&source, &controller.name);
    // Beside the law's state seven numbers and two integers.
    let room = (source.memory.state + 7 * 8 + 2 * 4).div_ceil(8) + 1;
    let limits = &controller.limits;
    let per_si: f64 = units_per_si(&controller.units.load).parse().unwrap_or(1.0);
    let (held, reference, velocity) = match source.look_ahead {
        Some(cycles) => (cycles, "out.reference_position", "out.reference_velocity"),
        None => (1, "kept->at[0]", "kept->at[1]"),
    };
    let fill = |text: &str, pins: &Pins| {
        text.replace("@CODE@\n", &code)
            .replace("@ACCELERATION@", pins.acceleration)
            .replace("@MOTOR@", pins.motor)
            .replace("@CURRENT@", pins.current)
            .replace("@COMMAND@", pins.command)
            .replace("@REFERENCE@", reference)
            .replace("@VELOCITY@", velocity)
            .replace("@HELD@", &held.to_string())
            .replace("@NEXT_ACCELERATION@", pins.next_acceleration)
            .replace("@ASSIGN@", &assignments(&source.inputs))
            .replace("@TOP@", &about(controller, &source.hash))
            .replace("@AXIS@", &plain(&controller.axis))
            .replace("@STRATEGY@", &controller.strategy)
            .replace("@ROOM@", &room.to_string())
            .replace(
                "@POSITION_LIMIT@",
                &format!("{:?}", limits.position * per_si),
            )
            .replace("@EFFORT_LIMIT@", &format!("{:?}", limits.effort))
            .replace("@SURPRISE_LIMIT@", &format!("{:?}", limits.surprise))
            .replace("@UNITS@", units_per_si(&controller.units.load))
            .replace("@PERIOD@", &format!("{:?}", controller.period))
            .replace("@X@", &controller.name)
            .replace("@U@", &controller.name.to_uppercase())
            .replace("@L@", &controller.units.load)
            .replace("@E@", &controller.units.effort)
    };
    let named = |ending: &str, text: String| NamedText {
        name: format!("{}.{ending}", controller.name),
        text,
    };
    let (declared, connected) = Pins::of(&source.inputs);
    Ok(Component {
        component: named("comp", fill(include_str!("component.comp"), &declared)),
        example: named("hal", fill(include_str!("example.hal"), &connected)),
    })
}

/// Texts of the pins that not every strategy has.
#[derive(Default)]
struct Pins {
    acceleration: &'static str,
    motor: &'static str,
    current: &'static str,
    command: &'static str,
    next_acceleration: &'static str,
}

impl Pins {
    /// Their declarations, and how they are connected.
    fn of(inputs: &[Input]) -> (Self, Self) {
        let (mut declared, mut connected) = (Self::default(), Self::default());
        declared.next_acceleration = "0.0";
        let accelerations = [Input::NextReferenceAcceleration, Input::AheadAcceleration];
        if accelerations.iter().any(|input| inputs.contains(input)) {
            declared.next_acceleration = "acc_cmd_in * si";
            declared.acceleration = "pin in float acc-cmd-in \"Commanded acceleration, machine units/s^2: joint.N.acc-cmd.\";\n";
            connected.acceleration = "net x-acc joint.0.acc-cmd => comp.x.acc-cmd-in\n";
        }
        if inputs.contains(&Input::MotorSpeed) {
            declared.motor =
                "pin in float motor-speed-in \"Measured speed of the motor, rad/s.\";\n";
            connected.motor = "# From the drive: the motor's speed, rad/s.\nnet x-motor => comp.x.motor-speed-in\n";
        }
        if inputs.contains(&Input::Current) {
            declared.current = "pin in float current-in \"Measured q current, A.\";\n";
            connected.current = "# And its q current, A.\nnet x-current => comp.x.current-in\n";
        }
        if inputs.contains(&Input::EffortCommand) {
            declared.command = "pin in float effort-cmd-in \"Command of the cycle before, offset included, @E@.\";\n";
            connected.command = " => comp.x.effort-cmd-in";
        }
        (declared, connected)
    }
}

/// The C code with everything static, and without what only a file of its own needs.
fn inlined(source: &c::CSource, name: &str) -> String {
    let from = |text: &str, begin: &str, end: &str| {
        let after = text.split_once(begin).map_or("", |(_, after)| after);
        let before = after.split_once(end).map_or(after, |(before, _)| before);
        before.to_owned()
    };
    // Types of the header, up to the functions' declarations.
    let begin = "/* What is known at the start of a control cycle. */";
    let types = from(&source.header.text, begin, "/* Everything forgotten");
    let include = format!("#include \"{name}.h\"\n");
    let functions = from(&source.source.text, &include, "\u{0}");
    let functions = ["void", "int"].iter().fold(functions, |text, kind| {
        let begins = |before: &str| format!("\n{before}{kind} {name}_");
        text.replace(&begins(""), &begins("static "))
    });
    format!("#include <stdint.h>\n\n{begin}{types}{functions}")
}

/// How the inputs come from pins and from the command that is held back.
fn assignments(inputs: &[Input]) -> String {
    let line = |input: &Input| {
        let from = match input {
            Input::ReferenceVelocity => "kept->at[1]",
            Input::ReferenceAcceleration => "kept->at[2]",
            Input::NextReferencePosition => "next[0]",
            Input::NextReferenceAcceleration => "next[2]",
            Input::AheadPosition => "next[0]",
            Input::AheadVelocity => "next[1]",
            Input::AheadAcceleration => "next[2]",
            Input::Position => "pos_fb_in * si",
            Input::MotorSpeed => "motor_speed_in",
            Input::Current => "current_in",
            Input::EffortCommand => "effort_cmd_in",
        };
        format!("    in.{} = {from};\n", input.name())
    };
    inputs.iter().map(line).collect()
}

fn about(controller: &ExportedController, hash: &str) -> String {
    format!(
        "Compensator \"{}\", strategy {}, of the axis \"{}\" ({}).\nControl period {:?} s; inputs {hash}.",
        controller.name,
        controller.strategy,
        plain(&controller.axis),
        plain(&controller.description),
        controller.period,
    )
}

/// A text that ends no string and no comment.
fn plain(text: &str) -> String {
    text.replace(['"', '\\'], "'")
        .replace("*/", "* /")
        .replace(['\n', '\r'], " ")
}

/// mm per m, degrees per radian.
fn units_per_si(load: &str) -> &'static str {
    match load {
        "rad" => "57.29577951308232",
        _ => "1000.0",
    }
}
