//! What is FMI 3.0's alone (FMI 3.0.2, Section 2.4).

use super::{MODEL_IDENTIFIER, naming, numbers, outputs};
use crate::variables::Variables;

/// What of FMI this offers and what not, as attributes of the co-simulation.
const CAPABILITIES: &str = "needsExecutionTool=\"false\" canBeInstantiatedOnlyOncePerProcess=\"false\" \
     canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\" \
     providesDirectionalDerivatives=\"false\" providesAdjointDerivatives=\"false\" \
     providesPerElementDependencies=\"false\" canHandleVariableCommunicationStepSize=\"true\" \
     maxOutputDerivativeOrder=\"0\" providesIntermediateUpdate=\"false\" \
     mightReturnEarlyFromDoStep=\"false\" canReturnEarlyAfterIntermediateUpdate=\"false\" \
     hasEventMode=\"false\" providesEvaluateDiscreteStates=\"false\"";

/// The co-simulation, the variables, the structure.
pub(super) fn parts(period: f64, variables: &Variables) -> [String; 3] {
    let list = (variables.iter())
        .map(|variable| format!("<Float64 {}{}/>\n", naming(variable), numbers(variable)))
        .collect();
    // What an output shows is past when it is read, so that no input reaches it at once; at the
    // start it depends on all that is set.
    let mut structure = String::new();
    for (element, depends) in [("Output", " dependencies=\"\""), ("InitialUnknown", "")] {
        for output in outputs(variables) {
            let reference = output.reference;
            structure += &format!("<{element} valueReference=\"{reference}\"{depends}/>\n");
        }
    }
    [
        format!(
            "<CoSimulation modelIdentifier=\"{MODEL_IDENTIFIER}\" {CAPABILITIES} fixedInternalStepSize=\"{}\"/>\n",
            period
        ),
        list,
        structure,
    ]
}
