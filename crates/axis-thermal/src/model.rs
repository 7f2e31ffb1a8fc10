//! The thermal model of an axis: which bodies there are, and a duty that heats them.

use nalgebra::DVector;

use crate::duty::Duty;
use crate::error::ThermalError;
use crate::network::{Assembly, Network};
use crate::parameters::ThermalParameters;
use crate::work::AxisAtWork;

/// A body of one temperature; the segments of the screw stand behind them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum HeatNode {
    /// Winding and its iron.
    Winding,
    /// Motor's housing.
    Housing,
    /// Bearing at the driven end.
    FrontBearing,
    /// Bearing at the other end.
    RearBearing,
    /// Nut.
    Nut,
    /// Table, carriage or slide.
    Table,
    /// Bed.
    Bed,
    /// Scale.
    Scale,
}

impl HeatNode {
    /// All, in their order.
    pub const ALL: [Self; 8] = [
        Self::Winding,
        Self::Housing,
        Self::FrontBearing,
        Self::RearBearing,
        Self::Nut,
        Self::Table,
        Self::Bed,
        Self::Scale,
    ];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Winding => "winding",
            Self::Housing => "motor housing",
            Self::FrontBearing => "front bearing",
            Self::RearBearing => "rear bearing",
            Self::Nut => "nut",
            Self::Table => "table",
            Self::Bed => "bed",
            Self::Scale => "scale",
        }
    }
}

/// Number of bodies before the screw's segments.
pub(crate) const BODIES: usize = HeatNode::ALL.len();

/// The temperatures of an axis at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct ThermalState {
    /// Since its start, s.
    pub time: f64,
    pub(crate) temperatures: DVector<f64>,
}

impl ThermalState {
    /// Temperature of a body, °C.
    pub fn of(&self, node: HeatNode) -> f64 {
        self.temperatures[node as usize]
    }

    /// Temperatures of the screw's segments from the driven end, °C; none without a screw.
    pub fn screw(&self) -> &[f64] {
        &self.temperatures.as_slice()[BODIES..]
    }
}

/// The thermal model of an axis. Immutable; states are the caller's.
#[derive(Clone, Debug)]
pub struct ThermalModel {
    parameters: ThermalParameters,
}

impl ThermalModel {
    /// The model with these numbers.
    ///
    /// # Errors
    /// [`ThermalError::Invalid`] if one is out of its range.
    pub fn new(parameters: ThermalParameters) -> Result<Self, ThermalError> {
        parameters.validate()?;
        Ok(Self { parameters })
    }

    /// Its numbers.
    pub fn parameters(&self) -> &ThermalParameters {
        &self.parameters
    }

    /// The bodies that take part: all, or those of an axis without a screw.
    pub fn nodes(&self) -> Vec<HeatNode> {
        let all = HeatNode::ALL.into_iter();
        let screws = [HeatNode::FrontBearing, HeatNode::RearBearing, HeatNode::Nut];
        let has = |node: &HeatNode| self.parameters.screw.is_some() || !screws.contains(node);
        all.filter(has).collect()
    }

    /// All at one temperature, °C.
    pub fn at_rest(&self, temperature: f64) -> ThermalState {
        ThermalState {
            time: 0.0,
            temperatures: DVector::from_element(BODIES + self.segments(), temperature),
        }
    }

    fn segments(&self) -> usize {
        self.parameters.screw.map_or(0, |screw| screw.segments)
    }

    /// An empty duty, to be filled with the losses of a motion.
    pub fn duty(&self) -> Duty {
        match self.parameters.screw {
            Some(screw) => Duty::new(screw.length, screw.nut_length, screw.segments),
            None => Duty::new(1.0, 0.0, 1),
        }
    }

    /// The axis under a duty.
    ///
    /// # Errors
    /// [`ThermalError`] if the duty is empty or of another screw.
    pub fn under(&self, duty: &Duty) -> Result<AxisAtWork, ThermalError> {
        duty.validate()?;
        let expected = self.duty().places();
        if duty.places() != expected {
            let found = duty.places();
            return Err(ThermalError::OtherPlaces { found, expected });
        }
        Ok(AxisAtWork::new(
            self.network(duty),
            self.parameters.clone(),
            duty.clone(),
        ))
    }

    fn network(&self, duty: &Duty) -> Network {
        use HeatNode::{Bed, FrontBearing, Housing, Nut, RearBearing, Scale, Table, Winding};
        let (bodies, links) = (&self.parameters.bodies, &self.parameters.links);
        let all = [
            bodies.winding,
            bodies.housing,
            bodies.front_bearing,
            bodies.rear_bearing,
            bodies.nut,
            bodies.table,
            bodies.bed,
            bodies.scale,
        ];
        let segments = self.segments();
        let screw = self.parameters.screw.as_ref();
        let capacity = all.iter().map(|body| body.capacity);
        let of_screw = screw.map_or(0.0, |screw| screw.capacity());
        let capacity = capacity.chain(std::iter::repeat_n(of_screw, segments));
        let mut assembly = Assembly::new(capacity.collect());
        for (node, body) in all.iter().enumerate() {
            assembly.air(node, body.to_air);
        }
        let mut link = |a: HeatNode, b: HeatNode, conductance| {
            assembly.link(a as usize, b as usize, conductance);
        };
        link(Winding, Housing, links.winding_to_housing);
        link(Housing, Table, links.housing_to_table);
        link(Housing, Bed, links.housing_to_bed);
        link(Table, Bed, links.table_to_bed);
        link(Scale, Bed, links.scale_to_bed);
        let Some(screw) = screw else {
            return assembly.solve();
        };
        link(Housing, FrontBearing, links.housing_to_front_bearing);
        link(FrontBearing, Bed, links.front_bearing_to_bed);
        link(RearBearing, Bed, links.rear_bearing_to_bed);
        link(Nut, Table, links.nut_to_table);
        let last = BODIES + segments - 1;
        let [front, rear] = [links.front_bearing_to_screw, links.rear_bearing_to_screw]
            .map(|conductance| screw.end_to_middle(conductance));
        assembly.link(FrontBearing as usize, BODIES, front);
        assembly.link(RearBearing as usize, last, rear);
        let to_air = screw.air_conductance(duty.turning());
        for (i, share) in duty.time_shares().into_iter().enumerate() {
            let node = BODIES + i;
            assembly.air(node, to_air);
            assembly.link(node, Nut as usize, share * links.nut_to_screw);
            if i > 0 {
                assembly.link(node - 1, node, screw.conductance());
            }
        }
        assembly.solve()
    }
}
