//! An axis under a duty: its losses, and the powers of all bodies.

use nalgebra::DVector;

use crate::duty::Duty;
use crate::network::Network;
use crate::parameters::{FrictionShares, HeatShares, ThermalParameters};
use crate::state::{BODIES, HeatNode, ThermalState};

/// Where the heat of an axis arises, W.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct HeatLosses {
    /// In the winding.
    pub winding: f64,
    /// In the front bearing.
    pub front_bearing: f64,
    /// In the rear bearing.
    pub rear_bearing: f64,
    /// Between nut and screw.
    pub nut: f64,
    /// In the guides.
    pub guides: f64,
}

impl HeatLosses {
    /// All together, W.
    pub fn total(&self) -> f64 {
        self.winding + self.front_bearing + self.rear_bearing + self.nut + self.guides
    }
}

/// An axis under a duty that repeats itself.
#[derive(Clone, Debug)]
pub struct AxisAtWork {
    pub(crate) network: Network,
    parameters: ThermalParameters,
    duty: Duty,
    travel: Vec<f64>,
    by_segment: Vec<[f64; 2]>,
}

/// Factors on the friction of each part against the reference temperature: dry and viscous.
struct Factors {
    nut: [f64; 2],
    front: [f64; 2],
    rear: [f64; 2],
    guides: [f64; 2],
}

impl AxisAtWork {
    pub(crate) fn new(network: Network, parameters: ThermalParameters, duty: Duty) -> Self {
        Self {
            network,
            parameters,
            travel: duty.travel_shares(),
            by_segment: duty.by_segment().collect(),
            duty,
        }
    }

    /// The losses of the duty at these temperatures, W.
    pub fn losses(&self, state: &ThermalState) -> HeatLosses {
        self.losses_at(&state.temperatures, &self.factors(&state.temperatures))
    }

    /// Dry and viscous friction of the whole axis at these temperatures, as multiples of what they
    /// are at the reference temperature.
    pub fn friction_factors(&self, state: &ThermalState) -> [f64; 2] {
        self.whole(&self.factors(&state.temperatures))
    }

    fn factors(&self, temperatures: &DVector<f64>) -> Factors {
        let laws = &self.parameters.friction;
        let above =
            |node: HeatNode| temperatures[node as usize] - self.parameters.reference_temperature;
        let of = |node| {
            [
                laws.dry.factor(above(node)),
                laws.viscous.factor(above(node)),
            ]
        };
        let mut nut = of(HeatNode::Nut);
        if self.parameters.screw.is_some() {
            let screw = temperatures.iter().skip(BODIES).zip(&self.travel);
            let under: f64 = screw.map(|(t, share)| t * share).sum();
            let warmer = under - temperatures[HeatNode::Nut as usize];
            nut[0] *= (1.0 + laws.preload_per_kelvin * warmer).max(0.0);
        }
        Factors {
            nut,
            front: of(HeatNode::FrontBearing),
            rear: of(HeatNode::RearBearing),
            guides: of(HeatNode::Table),
        }
    }

    fn whole(&self, factors: &Factors) -> [f64; 2] {
        let HeatShares {
            nut,
            bearings,
            front_of_bearings: front,
            ..
        } = self.parameters.shares;
        let guide = self.parameters.shares.guide();
        let of = |i: usize, nut: f64, bearings: f64, guide: f64| {
            let both = front * factors.front[i] + (1.0 - front) * factors.rear[i];
            nut * factors.nut[i] + bearings * both + guide * factors.guides[i]
        };
        [
            of(0, nut.dry, bearings.dry, guide.dry),
            of(1, nut.viscous, bearings.viscous, guide.viscous),
        ]
    }

    fn losses_at(&self, temperatures: &DVector<f64>, factors: &Factors) -> HeatLosses {
        let shares = &self.parameters.shares;
        let (nut, bearings, guide) = (shares.nut, shares.bearings, shares.guide());
        let [dry, viscous] = self.duty.friction_power();
        let of = |share: FrictionShares, factor: [f64; 2]| {
            share.dry * dry * factor[0] + share.viscous * viscous * factor[1]
        };
        let winding = &self.parameters.winding;
        let above =
            temperatures[HeatNode::Winding as usize] - self.parameters.reference_temperature;
        let resistance = (1.0 + winding.resistance_per_kelvin * above).max(0.0);
        let squared = self.duty.torque_squared(self.whole(factors));
        let front = shares.front_of_bearings;
        HeatLosses {
            winding: winding.per_torque_squared * squared * resistance,
            front_bearing: front * of(bearings, factors.front),
            rear_bearing: (1.0 - front) * of(bearings, factors.rear),
            nut: of(nut, factors.nut),
            guides: of(guide, factors.guides),
        }
    }

    /// Powers of all nodes without the air's, W.
    pub(crate) fn powers(&self, temperatures: &DVector<f64>) -> DVector<f64> {
        let factors = self.factors(temperatures);
        let losses = self.losses_at(temperatures, &factors);
        let shares = &self.parameters.shares;
        let mut powers = DVector::zeros(temperatures.len());
        let mut add = |node: HeatNode, power| powers[node as usize] += power;
        add(HeatNode::Winding, losses.winding);
        add(HeatNode::FrontBearing, losses.front_bearing);
        add(HeatNode::RearBearing, losses.rear_bearing);
        add(HeatNode::Nut, (1.0 - shares.nut_into_screw) * losses.nut);
        add(HeatNode::Table, shares.guide_into_table * losses.guides);
        add(
            HeatNode::Bed,
            (1.0 - shares.guide_into_table) * losses.guides,
        );
        let into = shares.nut_into_screw;
        let [dry, viscous] = [
            into * shares.nut.dry * factors.nut[0],
            into * shares.nut.viscous * factors.nut[1],
        ];
        for (power, [d, v]) in powers.iter_mut().skip(BODIES).zip(&self.by_segment) {
            *power += dry * d + viscous * v;
        }
        powers
    }
}
