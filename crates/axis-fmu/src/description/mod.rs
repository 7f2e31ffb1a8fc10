//! `modelDescription.xml`: what both versions have in common.

mod fmi2;
mod fmi3;

use std::fmt::Write;

use trajectories::Motion;

use crate::measure::{BASE, UnitDefinition};
use crate::unit::Unit;
use crate::variables::{Variable, VariableKind, Variables};
use crate::version::FmiVersion;

/// Categories of messages, and what they are.
const CATEGORIES: &str = "<LogCategories>\
     <Category name=\"logStatusError\" description=\"what is refused, and why\"/>\
     <Category name=\"logStatusDiscard\" description=\"what is asked for and not known\"/>\
     </LogCategories>\n";

/// The description of a unit. The same inputs give the same text: it has no
/// date.
pub fn description(unit: &Unit, version: FmiVersion) -> String {
    let (period, variables) = (unit.period(), unit.variables());
    let [co_simulation, list, structure] = match version {
        FmiVersion::V2 => fmi2::parts(variables),
        FmiVersion::V3 => fmi3::parts(period, variables),
    };
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <fmiModelDescription fmiVersion=\"{version}\" modelName=\"{}\" description=\"{}\" \
         {}=\"{}\" generationTool=\"feed-axis {}\" variableNamingConvention=\"structured\">\n\
         {co_simulation}<UnitDefinitions>\n",
        escaped(unit.name()),
        escaped(&unit.description()),
        match version {
            FmiVersion::V2 => "guid",
            FmiVersion::V3 => "instantiationToken",
        },
        unit.token(),
        env!("CARGO_PKG_VERSION"),
    );
    for measure in measures(variables) {
        text += &unit_definition(measure);
    }
    text + "</UnitDefinitions>\n"
        + CATEGORIES
        + &format!(
            "<DefaultExperiment startTime=\"0\" stopTime=\"{}\" stepSize=\"{}\"/>\n\
             <ModelVariables>\n{list}</ModelVariables>\n\
             <ModelStructure>\n{structure}</ModelStructure>\n</fmiModelDescription>\n",
            stop_time(unit),
            period
        )
}

/// When an importer stops that was not told: after the first trajectory of its axes, the longest of
/// several, which is followed late by what a correction looks ahead, on a control cycle; after 1 s
/// where there is none.
fn stop_time(unit: &Unit) -> f64 {
    let (period, late) = (unit.period(), unit.look_ahead());
    let planned = unit.axes().iter().filter_map(|axis| {
        let motion = axis.plan(axis.trajectories.first()?).ok()?;
        Some(motion.duration())
    });
    let duration = planned.reduce(f64::max).unwrap_or(1.0);
    // Whole periods per second and not seconds per period, so that the number is a short one.
    let frequency = (1.0 / period).round();
    let cycles = (duration / period * (1.0 - 1e-9)).ceil().max(1.0) + late as f64;
    match (frequency * period - 1.0).abs() < 1e-12 {
        true => cycles / frequency,
        false => cycles * period,
    }
}

/// Outputs, in the order of the table.
fn outputs(variables: &Variables) -> impl Iterator<Item = &Variable> {
    (variables.iter()).filter(|variable| matches!(variable.kind, VariableKind::Output(_)))
}

/// The units of variables, each once, in the order in which they come.
fn measures(variables: &Variables) -> Vec<&UnitDefinition> {
    let mut all: Vec<&UnitDefinition> = Vec::new();
    for measure in variables.iter().filter_map(|v| v.measure.as_ref()) {
        if !all.iter().any(|known| known.name == measure.name) {
            all.push(measure);
        }
    }
    all
}

/// A unit, spelled the same in both versions.
fn unit_definition(measure: &UnitDefinition) -> String {
    let mut text = format!("<Unit name=\"{}\"><BaseUnit", escaped(&measure.name));
    for (symbol, power) in BASE.iter().zip(measure.powers) {
        if power != 0 {
            // Into a string it cannot fail.
            let _ = write!(text, " {symbol}=\"{power}\"");
        }
    }
    if measure.factor != 1.0 {
        let _ = write!(text, " factor=\"{}\"", measure.factor);
    }
    text + "/></Unit>\n"
}

/// Name, value reference, causality, variability, meaning.
fn naming(variable: &Variable) -> String {
    let role = match &variable.kind {
        VariableKind::Time => "causality=\"independent\" variability=\"continuous\"",
        VariableKind::Input(_) => "causality=\"input\" variability=\"continuous\"",
        VariableKind::Output(output) if output.is_sampled() => {
            "causality=\"output\" variability=\"discrete\" initial=\"calculated\""
        }
        VariableKind::Output(_) => {
            "causality=\"output\" variability=\"continuous\" initial=\"calculated\""
        }
        VariableKind::Parameter { .. }
        | VariableKind::MachineNumber(_)
        | VariableKind::ExactBetween
        | VariableKind::Compensation
        | VariableKind::StartPosition => {
            "causality=\"parameter\" variability=\"fixed\" initial=\"exact\""
        }
    };
    let mut text = format!(
        "name=\"{}\" valueReference=\"{}\" {role}",
        escaped(&variable.name),
        variable.reference
    );
    if !variable.description.is_empty() {
        let _ = write!(text, " description=\"{}\"", escaped(&variable.description));
    }
    text
}

/// Unit, limits, start value.
fn numbers(variable: &Variable) -> String {
    let mut text = String::new();
    if let Some(measure) = &variable.measure {
        let _ = write!(text, " unit=\"{}\"", escaped(&measure.name));
    }
    if let Some([least, most]) = variable.limits {
        let _ = write!(text, " min=\"{least}\" max=\"{most}\"");
    }
    if let Some(start) = variable.start {
        let _ = write!(text, " start=\"{start}\"");
    }
    text
}

/// Text for an attribute; what XML cannot hold becomes a space.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// Name of the library's file in the archive, without its end.
pub const MODEL_IDENTIFIER: &str = "feed_axis";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_cannot_end_an_attribute() {
        assert_eq!(escaped("a\"<b>&\u{1}"), "a&quot;&lt;b&gt;&amp; ");
    }
}
