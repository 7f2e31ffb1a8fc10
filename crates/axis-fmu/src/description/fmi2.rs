//! What is FMI 2.0's alone (FMI 2.0.5, Sections 2.2 and 4.3.1).

use super::{MODEL_IDENTIFIER, naming, numbers, outputs};
use crate::variables::Variables;

/// What of FMI this offers and what not, as attributes of the co-simulation; spelled as there.
const CAPABILITIES: &str = "needsExecutionTool=\"false\" canBeInstantiatedOnlyOncePerProcess=\"false\" \
     canHandleVariableCommunicationStepSize=\"true\" canInterpolateInputs=\"false\" \
     maxOutputDerivativeOrder=\"0\" canRunAsynchronuously=\"false\" \
     canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" \
     canSerializeFMUstate=\"true\" providesDirectionalDerivative=\"false\"";

/// The co-simulation, the variables, the structure.
pub(super) fn parts(variables: &Variables) -> [String; 3] {
    let list = (variables.iter())
        .map(|variable| {
            let (naming, numbers) = (naming(variable), numbers(variable));
            format!("<ScalarVariable {naming}><Real{numbers}/></ScalarVariable>\n")
        })
        .collect();
    // Places in the list of variables, from 1 on. What an output shows is past when it is read, so
    // that no input reaches it at once; at the start it depends on all that is set.
    let unknowns = |depends: &str| -> String {
        outputs(variables)
            .map(|output| format!("<Unknown index=\"{}\"{depends}/>\n", output.reference + 1))
            .collect()
    };
    [
        format!("<CoSimulation modelIdentifier=\"{MODEL_IDENTIFIER}\" {CAPABILITIES}/>\n"),
        list,
        format!(
            "<Outputs>\n{}</Outputs>\n<InitialUnknowns>\n{}</InitialUnknowns>\n",
            unknowns(" dependencies=\"\""),
            unknowns("")
        ),
    ]
}
