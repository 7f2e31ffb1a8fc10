//! LinuxCNC components: texts that halcompile can take, whether it is here or not.

use std::collections::BTreeSet;

use crate::support::{Outcome, laws, samples};
use controller_export::{EXPORTED, ExportedController, linuxcnc};

fn words(text: &str) -> BTreeSet<&str> {
    let parts = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
    parts.filter(|word| !word.is_empty()).collect()
}

/// Pins are macros in the component's C code: none may be a word of the evaluator's.
#[test]
fn pins_are_no_words_of_the_code() -> Outcome<()> {
    let predictors = laws::predictors(&samples::axis()?)?;
    for &name in EXPORTED {
        let controller = ExportedController::of(&predictors, name, laws::LIMITS)?;
        let made = linuxcnc::export(&controller)?;
        let (declared, code) = made.component.text.split_once(";;").ok_or("no ;;")?;
        let code = code.split("FUNCTION").next().ok_or("no code")?;
        let pins: Vec<String> = declared
            .lines()
            .filter(|line| ["pin ", "param "].iter().any(|kind| line.starts_with(kind)))
            .filter_map(|line| line.split_whitespace().nth(3))
            .map(|pin| pin.replace('-', "_"))
            .collect();
        assert!(pins.len() > 8, "{pins:?}");
        for pin in &pins {
            assert!(!words(code).contains(pin.as_str()), "{name}: {pin}");
        }
        let known: BTreeSet<String> = pins.into_iter().collect();
        let used = made.example.text.split("comp.x.").skip(1);
        for pin in used.filter_map(|rest| rest.split_whitespace().next()) {
            let function = ["update", "update-feedback"].contains(&pin);
            assert!(function || known.contains(&pin.replace('-', "_")), "{pin}");
        }
    }
    Ok(())
}

/// No placeholder is left anywhere.
#[test]
fn texts_are_filled() -> Outcome<()> {
    let predictors = laws::predictors(&samples::axis()?)?;
    for &name in EXPORTED {
        let controller = ExportedController::of(&predictors, name, laws::LIMITS)?;
        let made = linuxcnc::export(&controller)?;
        for text in [&made.component, &made.example] {
            assert!(!text.text.contains('@'), "{}", text.name);
        }
    }
    Ok(())
}

/// Functions without `fp` or `nofp`, which LinuxCNC 2.9 takes as `fp` and its successor refuses.
#[test]
fn functions_have_no_options() -> Outcome<()> {
    let predictors = laws::predictors(&samples::axis()?)?;
    for &name in EXPORTED {
        let controller = ExportedController::of(&predictors, name, laws::LIMITS)?;
        let made = linuxcnc::export(&controller)?;
        let lines = made.component.text.lines();
        let functions: Vec<&str> = lines.filter(|l| l.starts_with("function ")).collect();
        assert_eq!(functions, ["function update_feedback;", "function update;"]);
    }
    Ok(())
}
