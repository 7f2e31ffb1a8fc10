//! What a unit of one axis is made of.

use axis_sim::{Axis, ClosedLoop};

use crate::correction::UnitCorrection;
use crate::digest::digest;
use crate::error::UnitError;
use crate::given::Inputs;
use crate::kind::UnitKind;
use crate::parameters::{self, Changed};
use crate::plant::PlantRun;
use crate::run::{Corrected, Run};
use crate::simulated::Simulated;
use crate::subject::{AXIS_FILE, CORRECTION_FILE, Resource, Subject};
use crate::variables::Variables;

/// An axis file, and the correction of a compensated unit.
#[derive(Debug)]
pub(crate) struct OneAxis {
    kind: UnitKind,
    name: String,
    text: String,
    axis: Axis,
    correction: Option<UnitCorrection>,
}

impl OneAxis {
    /// Of the text of an axis file, which `name` stands for.
    pub fn of(
        kind: UnitKind,
        name: &str,
        text: &str,
        correction: impl FnOnce(&Axis) -> Result<Option<UnitCorrection>, UnitError>,
    ) -> Result<Self, UnitError> {
        let axis = Axis::parse(name, text)?;
        ClosedLoop::new(&axis)?;
        Ok(Self {
            kind,
            name: name.to_owned(),
            text: text.to_owned(),
            correction: correction(&axis)?,
            axis,
        })
    }
}

impl Subject for OneAxis {
    fn name(&self) -> &str {
        &self.axis.name
    }

    fn description(&self) -> String {
        let (axis, words) = (&self.axis, self.kind.words());
        match &self.correction {
            Some(correction) => format!(
                "{} ({words}, {}; references are followed {} control periods late)",
                axis.description,
                correction.strategy(),
                correction.look_ahead(),
            ),
            None if self.kind == UnitKind::Plant => format!("{} ({words})", axis.description),
            None => axis.description.clone(),
        }
    }

    fn fingerprint(&self) -> String {
        self.axis.fingerprint.clone()
    }

    fn mark(&self) -> String {
        let correction = self.correction().map_or("", UnitCorrection::text);
        self.kind.mark(digest(correction.as_bytes()))
    }

    fn axes(&self) -> &[Axis] {
        std::slice::from_ref(&self.axis)
    }

    fn period(&self) -> f64 {
        self.axis.period
    }

    fn correction(&self) -> Option<&UnitCorrection> {
        self.correction.as_ref()
    }

    fn resources(&self) -> Vec<Resource<'_>> {
        let axis = (AXIS_FILE.to_owned(), &*self.text);
        let correction = self.correction.as_ref();
        let correction = correction.map(|c| (CORRECTION_FILE.to_owned(), c.text()));
        [Some(axis), correction].into_iter().flatten().collect()
    }

    fn variables(&self) -> Result<Variables, UnitError> {
        Variables::of(self.kind, &self.axis, &self.name, &self.text)
    }

    fn begin(
        &self,
        changed: &[Changed<'_>],
        given: &Inputs,
        is_compensated: bool,
    ) -> Result<Simulated, UnitError> {
        let axis = parameters::changed(&self.axis, &self.name, &self.text, changed)?;
        if self.kind == UnitKind::Plant {
            return Ok(Simulated(Box::new(PlantRun::begin(&axis, given)?)));
        }
        let correction = self.correction.as_ref();
        let corrected = Corrected {
            law: correction
                .filter(|_| is_compensated)
                .map(UnitCorrection::law),
            look_ahead: correction.map_or(0, UnitCorrection::look_ahead),
        };
        Ok(Simulated(Box::new(Run::begin(&axis, given, corrected)?)))
    }
}
