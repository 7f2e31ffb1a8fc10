//! What a firmware does with the C code beside stepping it: two axes, resets, trips, limits, a
//! state that was never inited.

use std::path::Path;
use std::process::Command;

use crate::support::program::compilers;
use crate::support::{Outcome, laws, samples};
use compensator::GuardLimits;
use controller_export::c::{self, Precision};
use controller_export::{EXPORTED, ExportedController};

const WARNINGS: &[&str] = &[
    "-std=c99",
    "-O1",
    "-g",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wfloat-equal",
    "-Werror",
    "-fsanitize=address,undefined",
    "-fno-sanitize-recover=all",
];

/// Compiles `main` with the code of strategies under names of their own, and runs it: what it
/// prints. Nothing where there is no compiler.
fn run(main: &str, strategies: &[(&str, &str)], limits: GuardLimits) -> Outcome<Option<String>> {
    let Some(compiler) = compilers().into_iter().next() else {
        crate::needs::skipped("program", "gcc|clang");
        return Ok(None);
    };
    let predictors = laws::predictors(&samples::axis()?)?;
    let folder = tempfile::tempdir()?;
    let mut files = vec![];
    for (strategy, name) in strategies {
        let controller = ExportedController::of(&predictors, strategy, limits)?.named(name)?;
        let code = c::export(&controller, Precision::F64, None)?;
        std::fs::write(folder.path().join(&code.header.name), &code.header.text)?;
        std::fs::write(folder.path().join(&code.source.name), &code.source.text)?;
        files.push(code.source.name);
    }
    std::fs::write(folder.path().join("main.c"), main)?;
    files.push("main.c".to_owned());
    compiled(folder.path(), compiler, &files)?;
    let ran = Command::new(folder.path().join("main")).output()?;
    if !ran.status.success() {
        return Err(String::from_utf8_lossy(&ran.stderr).into());
    }
    Ok(Some(String::from_utf8(ran.stdout)?))
}

fn compiled(folder: &Path, compiler: &str, files: &[String]) -> Outcome<()> {
    let made = Command::new(compiler)
        .current_dir(folder)
        .args(WARNINGS)
        .args(files)
        .args(["-o", "main", "-lm"])
        .output()?;
    match made.status.success() {
        true => Ok(()),
        false => Err(String::from_utf8_lossy(&made.stderr).into()),
    }
}

fn numbers(text: &str) -> Vec<f64> {
    text.split_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect()
}

/// Two axes with the same strategy are linked into one firmware, and both headers included at once.
#[test]
fn two_axes_are_one_firmware() -> Outcome<()> {
    let main = r#"
#include "x_plan.h"
#include "y_plan.h"
#include <stdio.h>
static x_plan x;
static y_plan y;
int main(void)
{
    x_plan_input in = {0};
    y_plan_input other = {0};
    x_plan_output out;
    y_plan_output out_other;
    x_plan_init(&x);
    y_plan_init(&y);
    in.ahead_position = 0.6;
    other.ahead_position = 0.7;
    x_plan_step(&x, &in, &out);
    y_plan_step(&y, &other, &out_other);
    printf("%g %g %d\n", out.reference_position, out_other.reference_position, X_PLAN_ON + Y_PLAN_OFF);
    return 0;
}
"#;
    let Some(said) = run(
        main,
        &[("plan", "x_plan"), ("plan", "y_plan")],
        laws::LIMITS,
    )?
    else {
        return Ok(());
    };
    assert_eq!(numbers(&said), [0.6, 0.7, 1.0]);
    Ok(())
}

/// A name that is none in C is refused, and says what is valid.
#[test]
fn a_name_is_one_of_c() -> Outcome<()> {
    let predictors = laws::predictors(&samples::axis()?)?;
    for bad in ["", "1st", "x-plan", "X", "_x", "int", "ü", &"a".repeat(40)] {
        let controller = ExportedController::of(&predictors, "plan", laws::LIMITS)?;
        let refused = controller.named(bad).expect_err(bad).to_string();
        assert!(refused.contains("lower-case letters"), "{refused}");
    }
    Ok(())
}

/// An axis that moved forward, stands and holds its friction's current: a reset lets it be.
#[test]
fn a_reset_while_on_is_no_bump() -> Outcome<()> {
    let main = r#"
#include "plan.h"
#include <math.h>
#include <stdio.h>
static plan x;
int main(void)
{
    plan_input in = {0};
    plan_output out = {0};
    double before = 0.0, held = 0.0, jump = 0.0, least = 1e9;
    int k, switched_off = 0;
    plan_init(&x);
    plan_switch(&x, 1);
    for (k = 0; k < 20000; k++) {
        /* 0.1 s to 0.05 m/s, even motion, 0.1 s to rest; then it stands. */
        const double t = 1e-4 * k, v = 0.05;
        in.ahead_velocity = t < 0.1 ? v * t / 0.1 : t < 0.4 ? v : t < 0.5 ? v * (0.5 - t) / 0.1 : 0.0;
        in.ahead_acceleration = t < 0.1 ? v / 0.1 : t < 0.4 ? 0.0 : t < 0.5 ? -v / 0.1 : 0.0;
        in.ahead_position = k == 0 ? 0.6 : in.ahead_position + 1e-4 * in.ahead_velocity;
        in.effort_command = out.effort; /* the drive's own loops ask for nothing */
        if (k == 10000) {
            held = out.effort;
            plan_reset(&x);
        }
        if (k == 15000) {
            plan_reset(&x);
            plan_switch(&x, 0);
            switched_off = 1;
        }
        plan_step(&x, &in, &out);
        if (k >= 10000) {
            jump = fmax(jump, fabs(out.effort - before));
        }
        if (k >= 10000 && !switched_off) {
            least = fmin(least, out.effort);
        }
        before = out.effort;
    }
    printf("%.17g %.17g %.17g %.17g %d\n", held, least, jump, before, out.status);
    return 0;
}
"#;
    let Some(said) = run(main, &[("plan", "plan")], laws::LIMITS)? else {
        return Ok(());
    };
    let [held, least, jump, end, status] = numbers(&said)[..] else {
        return Err(said.into());
    };
    println!("held {held} A, at least {least} A, at most {jump} A from cycle to cycle");
    assert!(held > 0.1, "{held} A");
    // The new plan begins at what the friction holds, within what is rounded and relaxed.
    assert!(least > 0.95 * held, "{least} of {held} A");
    // The steepest of s^2 (3 - 2 s) is 1.5, over 1000 cycles of fading; twice, as both a fade out
    // and a going over act after the last reset.
    assert!(jump < 2.0 * 1.5 / 1000.0 * held, "{jump} A");
    assert_eq!((end, status), (0.0, 0.0));
    Ok(())
}

/// After a cycle in which an input was no number the trip can be taken back, in every strategy and
/// for every input.
#[test]
fn a_trip_by_one_nan_is_taken_back() -> Outcome<()> {
    let predictors = laws::predictors(&samples::axis()?)?;
    for &name in EXPORTED {
        let controller = ExportedController::of(&predictors, name, laws::LIMITS)?;
        let inputs = c::export(&controller, Precision::F64, None)?.inputs;
        let members: Vec<&str> = inputs.iter().map(|input| input.name()).collect();
        let main = r#"
#include "law.h"
#include <math.h>
#include <stdio.h>
static law x;
static void spoil(law_input *in, int which)
{
    switch (which) {
@CASES@
    }
}
int main(void)
{
    int which, k;
    for (which = 0; which < @COUNT@; which++) {
        law_output out = {0};
        int on = 0, finite = 1, tripped = 0;
        law_init(&x);
        law_switch(&x, 1);
        for (k = 0; k < 6000; k++) {
            law_input in = {0};
            if (k == 2000) {
                spoil(&in, which);
            }
            if (k == 3000) {
                tripped = out.status >= 2;
                law_switch(&x, 1);
            }
            law_step(&x, &in, &out);
            finite = finite && isfinite(out.position) && isfinite(out.effort);
            on += k >= 3000 && out.status == LAW_ON;
        }
        printf("%d %d %d\n", on, finite, tripped);
    }
    return 0;
}
"#;
        let case = |(which, member)| format!("    case {which}: in->{member} = NAN; break;\n");
        let cases: String = members.iter().enumerate().map(case).collect();
        let main = main.replace("@CASES@", &cases);
        let main = main.replace("@COUNT@", &members.len().to_string());
        let Some(said) = run(&main, &[(name, "law")], laws::LIMITS)? else {
            return Ok(());
        };
        assert_eq!(said.lines().count(), members.len(), "{said}");
        for (&member, line) in members.iter().zip(said.lines()) {
            let [on, finite, tripped] = numbers(line)[..] else {
                return Err(said.into());
            };
            assert_eq!((on, finite), (3000.0, 1.0), "{name}, {member}: {line}");
            // A plan reads the command, and a filter the acceleration of now, at their beginning alone;
            // a feedback goes on without a sample.
            let noticed = match name {
                "plan" | "feedback" => member.starts_with("ahead"),
                _ => member != "reference_acceleration",
            };
            assert_eq!(tripped == 1.0, noticed, "{name}, {member}: {line}");
        }
    }
    Ok(())
}

/// A faster move than the limits were made for: they are set while it runs, and the guard lets it pass.
#[test]
fn limits_are_set_at_run_time() -> Outcome<()> {
    let main = r#"
#include "lugre.h"
#include <math.h>
#include <stdio.h>
static lugre x;
int main(void)
{
    const lugre_limits exported = LUGRE_LIMITS;
    lugre_limits limits = exported, none = exported;
    lugre_input in = {0};
    lugre_output out = {0};
    double before = 0.0, jump = 0.0;
    int k, tripped = 0, refused;
    lugre_init(&x);
    none.effort = 0.0;
    refused = lugre_limit(&x, &none) == 0;
    none.effort = NAN;
    refused = refused && lugre_limit(&x, &none) == 0;
    lugre_switch(&x, 1);
    for (k = 0; k < 6000; k++) {
        in.reference_velocity = 0.3;
        if (k == 3000) {
            tripped = out.status;
            limits.effort = 100.0;
            if (!lugre_limit(&x, &limits)) {
                return 1;
            }
            lugre_switch(&x, 1);
        }
        lugre_step(&x, &in, &out);
        if (k > 0) {
            jump = fmax(jump, fabs(out.effort - before));
        }
        before = out.effort;
    }
    printf("%d %d %d %.17g %.17g\n", refused, tripped, out.status, out.effort, jump);
    return 0;
}
"#;
    let limits = GuardLimits {
        effort: 0.1,
        ..laws::LIMITS
    };
    let Some(said) = run(main, &[("lugre", "lugre")], limits)? else {
        return Ok(());
    };
    let [refused, tripped, status, effort, jump] = numbers(&said)[..] else {
        return Err(said.into());
    };
    assert_eq!((refused, tripped, status), (1.0, 4.0, 1.0), "{said}");
    // The friction of the paper's axis, several times what the exported limit lets through.
    assert!(effort > 0.5, "{effort} A");
    assert!(jump < 2.0 * 1.5 / 1000.0 * effort, "{jump} of {effort} A");
    Ok(())
}

/// A state that was never inited, whatever its memory holds: a step is one after init. The
/// sanitizer watches where it writes.
#[test]
fn a_state_that_was_never_inited_is_switched_off() -> Outcome<()> {
    for &name in EXPORTED {
        let main = r#"
#include "law.h"
#include <stdio.h>
#include <string.h>
int main(void)
{
    static const int fills[3] = {0x00, 0xA5, 0xFF};
    int i, k, off = 0;
    for (i = 0; i < 12; i++) {
        static law x;
        law_input in;
        law_output out;
        memset(&in, 0, sizeof in);
        memset(&x, fills[i % 3], sizeof x);
        if (i / 3 == 1) {
            law_reset(&x);
        } else if (i / 3 == 2) {
            law_switch(&x, 0);
        } else if (i / 3 == 3) {
            const law_limits limits = LAW_LIMITS;
            (void)law_limit(&x, &limits);
        }
        for (k = 0; k < 500; k++) {
            law_step(&x, &in, &out);
            off += out.status == LAW_OFF && out.position <= 0.0 && out.position >= 0.0 && out.effort <= 0.0 && out.effort >= 0.0;
        }
    }
    printf("%d\n", off);
    return 0;
}
"#;
        let Some(said) = run(main, &[(name, "law")], laws::LIMITS)? else {
            return Ok(());
        };
        assert_eq!(numbers(&said), [6000.0], "{name}");
    }
    Ok(())
}
