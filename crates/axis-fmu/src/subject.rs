//! What a unit is made of, whatever its kind.

use std::fmt;

use axis_sim::Axis;

use crate::correction::UnitCorrection;
use crate::error::UnitError;
use crate::given::Inputs;
use crate::parameters::Changed;
use crate::simulated::Simulated;
use crate::variables::Variables;

/// The axis file among the resources of a unit of one axis.
pub const AXIS_FILE: &str = "axis.toml";

/// The correction of a compensated unit, among them.
pub const CORRECTION_FILE: &str = "correction.json";

/// The machine file among the resources of a unit of a machine; it names those of its axes.
pub const MACHINE_FILE: &str = "machine.toml";

/// Name and text of a file among the unit's resources.
pub(crate) type Resource<'a> = (String, &'a str);

/// What all instances of a unit have in common.
pub(crate) trait Subject: fmt::Debug + Send + Sync {
    /// Short name.
    fn name(&self) -> &str;

    /// For people.
    fn description(&self) -> String;

    /// Of what it computes with.
    fn fingerprint(&self) -> String;

    /// How its token ends.
    fn mark(&self) -> String;

    /// Of each drive, as its file has it.
    fn axes(&self) -> &[Axis];

    /// Control period, of a machine that which all drives have in common, s.
    fn period(&self) -> f64;

    /// The correction of a compensated one.
    fn correction(&self) -> Option<&UnitCorrection> {
        None
    }

    /// The files that it is made of again.
    fn resources(&self) -> Vec<Resource<'_>>;

    /// Its variables.
    fn variables(&self) -> Result<Variables, UnitError>;

    /// At rest where the inputs say, with these parameters that are not as the files have them.
    fn begin(
        &self,
        changed: &[Changed<'_>],
        given: &Inputs,
        is_compensated: bool,
    ) -> Result<Simulated, UnitError>;
}
