//! The finished texts: top comment, header, source.

use std::fmt::Write;

use super::draft::Draft;
use super::part::Part;
use super::{CSource, Precision};
use crate::name::check_free;
use crate::{ExportError, ExportedController, NamedText};

/// Puts the texts together.
pub(super) fn finish(
    controller: &ExportedController,
    draft: Draft,
    step_time: Option<&str>,
) -> Result<CSource, ExportError> {
    let code = draft
        .parts
        .iter()
        .map(|part| Part::code(part, draft.precision));
    let body: Vec<&str> = code.collect();
    let declarations = declarations(&draft);
    // The limits are numbers too.
    let limits = format!("/* Limits: {} */\n", draft.limits);
    let body = [
        &*limits,
        &*base(draft.precision),
        &*draft.data,
        &*body.join("\n"),
        "\n",
        &*functions(&draft),
    ];
    let body = body.concat();
    check_free(&controller.name, &body)?;
    let hash = blake3::hash(
        [&*controller.fingerprint, &*controller.name, &*body]
            .concat()
            .as_bytes(),
    );
    let hash = hash.to_hex().to_string();
    let top = top(controller, &draft, &hash, step_time);
    let fill = |text: &str| {
        text.replace("@DECLARATIONS@", &declarations)
            .replace("@TOP@\n", &top)
            .replace("@real@", draft.precision.name())
            .replace("@X@", &controller.name)
            .replace("@U@", &controller.name.to_uppercase())
            .replace("@L@", &controller.units.load)
            .replace("@E@", &controller.units.effort)
    };
    let library = draft.needs_library();
    let library = if library { "#include <math.h>\n" } else { "" };
    let source = format!("@TOP@\n{library}#include \"@X@.h\"\n\n{body}");
    Ok(CSource {
        header: NamedText {
            name: fill("@X@.h"),
            text: fill(include_str!("runtime/header.h")),
        },
        source: NamedText {
            name: fill("@X@.c"),
            text: fill(&source),
        },
        memory: draft.memory(),
        look_ahead: draft.plan.map(|(cycles, _)| cycles),
        inputs: draft.inputs.into_iter().collect(),
        hash,
    })
}

/// Types of the numbers.
fn base(precision: Precision) -> String {
    let (bits, sign, suffix) = match precision {
        Precision::F64 => ("uint64_t", "((bits)1 << 63)", "x"),
        Precision::F32 => ("uint32_t", "((bits)1 << 31)", "x##f"),
    };
    format!(
        "typedef @real@ real;\ntypedef {bits} bits;\n#define R(x) {suffix}\n#define SIGN {sign}\n\n{}\n",
        include_str!("runtime/base.c")
    )
}

fn declarations(draft: &Draft) -> String {
    let (mut inputs, mut states, mut members) = (String::new(), String::new(), String::new());
    for input in &draft.inputs {
        let _ = writeln!(
            inputs,
            "    @real@ {}; /* {} */",
            input.name(),
            input.meaning()
        );
    }
    for state in &draft.states {
        let _ = writeln!(states, "{}", state.declaration);
        let _ = writeln!(members, "    @X@_{} {};", state.name, state.name);
    }
    include_str!("runtime/declarations.h")
        .replace("@INPUTS@", &inputs)
        .replace("@OUTPUTS@", &outputs(draft))
        .replace("@STATES@", &states)
        .replace("@MEMBERS@", &members)
        .replace("@LIMITS@", &draft.limits)
}

fn functions(draft: &Draft) -> String {
    let (init, step) = match draft.plan {
        None => ("", include_str!("runtime/step_sum.c")),
        Some(_) => (
            "    x->plan.own = R(0.0);\n",
            include_str!("runtime/step_plan.c"),
        ),
    };
    let (feedback, surprise) = match draft.plan {
        Some((_, true)) => (
            "            feedback_correct(&x->feedback, in, &p);\n",
            "x->feedback.surprise",
        ),
        _ => ("", "R(0.0)"),
    };
    include_str!("runtime/functions.c")
        .replace("@INIT@", init)
        .replace("@RESET@", &reset(draft))
        .replace("@STEP@", step)
        .replace("@POSITION@", draft.position.unwrap_or("R(0.0)"))
        .replace("@EFFORT@", draft.effort.unwrap_or("R(0.0)"))
        .replace("@FEEDBACK@", feedback)
        .replace("@SURPRISE@", surprise)
}

/// What is forgotten before a motion. A plan writes its whole state as it begins.
fn reset(draft: &Draft) -> String {
    let states = draft.states.iter().map(|state| state.name);
    let mut text = String::new();
    for name in states.filter(|name| *name != "guard") {
        let _ = match name {
            "plan" => writeln!(text, "    x->plan.started = 0;"),
            _ => writeln!(text, "    x->{name} = (@X@_{name}){{0}};"),
        };
    }
    text
}

/// What a plan gives besides.
fn outputs(draft: &Draft) -> String {
    let Some((ahead, _)) = draft.plan else {
        return String::new();
    };
    format!(
        "    @real@ reference_position;     /* @L@: what to follow in this cycle: the set point of {ahead} cycles ago */\n    @real@ reference_velocity;     /* @L@/s */\n    @real@ reference_acceleration; /* @L@/s^2 */\n    int32_t planned; /* 0 in the first {ahead} cycles after a reset, which have no plan yet */\n"
    )
}

/// The comment at the top of both files.
fn top(
    controller: &ExportedController,
    draft: &Draft,
    hash: &str,
    step_time: Option<&str>,
) -> String {
    let memory = draft.memory();
    let precision = draft.precision.name();
    // Two ends of a comment in a text of the user's would let the rest become code.
    let plain = |text: &str| text.replace("*/", "* /").replace(['\n', '\r'], " ");
    format!(
        "/* Compensator \"{name}\", strategy {strategy}, of the axis \"{axis}\" ({description}).\n\
         \x20* Generated: change the axis or the strategy and export anew.\n\
         \x20*\n\
         \x20* precision     {precision}\n\
         \x20* control cycle {period:?} s: call the step once in each\n\
         \x20* memory        state {state} bytes an axis, constants {constants} bytes\n\
         \x20* stack         the compiler's: build with -fstack-usage\n\
         \x20* time a step   {time}\n\
         \x20* inputs        {hash} (BLAKE3 of axis, strategy, precision and numbers)\n\
         \x20*\n\
         \x20* C99; no allocation; {library}.\n\
         \x20* Compile with -std=c99 or -ffp-contract=off: contracted to multiply-add, results are not those\n\
         \x20* of the simulation to the last bit. Never with -ffast-math. Numbers must be IEEE 754 and round\n\
         \x20* after each operation (not x87).\n\
         \x20*/\n",
        name = controller.name,
        strategy = controller.strategy,
        axis = plain(&controller.axis),
        description = plain(&controller.description),
        period = controller.period,
        state = memory.state,
        constants = memory.constants,
        library = match draft.needs_library() {
            true => "of the library only sqrt (and memset, memcpy if a compiler calls them)",
            false => "no library (but memset, memcpy if a compiler calls them)",
        },
        time = plain(step_time.unwrap_or("not measured")),
    )
}
