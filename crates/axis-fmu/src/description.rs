//! `modelDescription.xml` (FMI 3.0.2, Section 2.4).

use std::fmt::Write;

use axis_sim::Axis;
use trajectories::Motion;

use crate::measure::{BASE, UnitDefinition};
use crate::package::MODEL_IDENTIFIER;
use crate::unit::token;
use crate::variables::{Variable, VariableKind, Variables};

/// What of FMI this offers and what not, as attributes of the co-simulation.
const CAPABILITIES: &str = "needsExecutionTool=\"false\" canBeInstantiatedOnlyOncePerProcess=\"false\" \
     canGetAndSetFMUState=\"true\" canSerializeFMUState=\"false\" \
     providesDirectionalDerivatives=\"false\" providesAdjointDerivatives=\"false\" \
     providesPerElementDependencies=\"false\" canHandleVariableCommunicationStepSize=\"true\" \
     maxOutputDerivativeOrder=\"0\" providesIntermediateUpdate=\"false\" \
     mightReturnEarlyFromDoStep=\"false\" canReturnEarlyAfterIntermediateUpdate=\"false\" \
     hasEventMode=\"false\" providesEvaluateDiscreteStates=\"false\"";

/// The description of an axis with these variables. The same inputs give the same text: it has no
/// date.
pub fn description(axis: &Axis, variables: &Variables) -> String {
    let period = axis.period;
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <fmiModelDescription fmiVersion=\"3.0\" modelName=\"{}\" description=\"{}\" \
         instantiationToken=\"{}\" generationTool=\"feed-axis {}\" variableNamingConvention=\"structured\">\n\
         <CoSimulation modelIdentifier=\"{MODEL_IDENTIFIER}\" {CAPABILITIES} fixedInternalStepSize=\"{period}\"/>\n",
        escaped(&axis.name),
        escaped(&axis.description),
        token(axis),
        env!("CARGO_PKG_VERSION"),
    );
    text += "<UnitDefinitions>\n";
    for measure in measures(variables) {
        text += &unit(measure);
    }
    text += "</UnitDefinitions>\n\
             <LogCategories><Category name=\"logStatusError\" description=\"what is refused, and why\"/></LogCategories>\n";
    text += &format!(
        "<DefaultExperiment startTime=\"0\" stopTime=\"{}\" stepSize=\"{period}\"/>\n<ModelVariables>\n",
        stop_time(axis)
    );
    for variable in variables.iter() {
        text += &float64(variable);
    }
    text += "</ModelVariables>\n<ModelStructure>\n";
    // What an output shows is past when it is read, so that no input reaches it at once; at the
    // start it depends on all that is set.
    for (element, depends) in [("Output", " dependencies=\"\""), ("InitialUnknown", "")] {
        for output in variables.iter().filter(|v| is_output(v)) {
            let reference = output.reference;
            text += &format!("<{element} valueReference=\"{reference}\"{depends}/>\n");
        }
    }
    text += "</ModelStructure>\n</fmiModelDescription>\n";
    text
}

/// When an importer stops that was not told: after the axis' first trajectory, on a control cycle;
/// after 1 s where it has none.
fn stop_time(axis: &Axis) -> f64 {
    let first = axis.trajectories.first();
    let planned = first.and_then(|spec| axis.plan(spec).ok());
    let duration = planned.map_or(1.0, |motion| motion.duration());
    // Whole periods per second and not seconds per period, so that the number is a short one.
    let frequency = (1.0 / axis.period).round();
    let cycles = (duration / axis.period * (1.0 - 1e-9)).ceil().max(1.0);
    match (frequency * axis.period - 1.0).abs() < 1e-12 {
        true => cycles / frequency,
        false => cycles * axis.period,
    }
}

fn is_output(variable: &Variable) -> bool {
    matches!(variable.kind, VariableKind::Output(_))
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

fn unit(measure: &UnitDefinition) -> String {
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

fn float64(variable: &Variable) -> String {
    let role = match &variable.kind {
        VariableKind::Time => "causality=\"independent\" variability=\"continuous\"",
        VariableKind::Input(_) => "causality=\"input\" variability=\"continuous\"",
        VariableKind::Output(output) if output.is_sampled() => {
            "causality=\"output\" variability=\"discrete\" initial=\"calculated\""
        }
        VariableKind::Output(_) => {
            "causality=\"output\" variability=\"continuous\" initial=\"calculated\""
        }
        VariableKind::Parameter { .. } | VariableKind::ExactBetween => {
            "causality=\"parameter\" variability=\"fixed\" initial=\"exact\""
        }
    };
    let mut text = format!(
        "<Float64 name=\"{}\" valueReference=\"{}\" {role}",
        escaped(&variable.name),
        variable.reference
    );
    if !variable.description.is_empty() {
        let _ = write!(text, " description=\"{}\"", escaped(&variable.description));
    }
    if let Some(measure) = &variable.measure {
        let _ = write!(text, " unit=\"{}\"", escaped(&measure.name));
    }
    if let Some(start) = variable.start {
        let _ = write!(text, " start=\"{start}\"");
    }
    text + "/>\n"
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_cannot_end_an_attribute() {
        assert_eq!(escaped("a\"<b>&\u{1}"), "a&quot;&lt;b&gt;&amp; ");
    }
}
