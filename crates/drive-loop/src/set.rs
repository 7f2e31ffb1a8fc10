//! The set of corners over which margins must hold.

use axis_sim::Axis;
use compensator::Mode;
use rayon::prelude::*;

use crate::error::LoopError;
use crate::law::LoopGains;
use crate::loops::CornerLoop;
use crate::measured_plant::MeasuredPlant;
use crate::plant::{Corner, LoopModel, modes_at};

/// Ranges over which margins are computed and must hold.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopSet {
    /// Positions of the load, m or rad; none: start, ends and middle of the stroke.
    pub positions: Vec<f64>,
    /// Shares of the load's mass or inertia.
    pub masses: Vec<f64>,
    /// Shares of the friction's stiffness and damping.
    pub frictions: Vec<f64>,
    /// Cycles of delay besides the file's.
    pub delay: f64,
    /// Responses that were measured ([`LoopSet::with_measured`]): limits hold for their loops too.
    pub measured: Vec<MeasuredPlant>,
}

/// Shares of the load's mass by default: 10 % less, as it is, 40 % more.
pub const MASSES: [f64; 3] = [0.9, 1.0, 1.4];

impl Default for LoopSet {
    fn default() -> Self {
        Self {
            positions: Vec::new(),
            masses: MASSES.to_vec(),
            frictions: vec![1.0],
            delay: 0.0,
            measured: Vec::new(),
        }
    }
}

impl LoopSet {
    /// The load's mass as the file says, alone.
    #[must_use]
    pub fn nominal() -> Self {
        Self {
            masses: vec![1.0],
            ..Self::default()
        }
    }

    fn check(&self, axis: &Axis) -> Result<(), LoopError> {
        let refused = |name, value, valid| Err(LoopError::Setting { name, value, valid });
        for (name, shares) in [("mass", &self.masses), ("friction", &self.frictions)] {
            if shares.is_empty() {
                return refused(name, f64::NAN, "one share at least");
            }
            for share in shares {
                if !(1e-3..=1e3).contains(share) {
                    return refused(name, *share, "from 0.001 to 1000, as a share of the file's");
                }
            }
        }
        if !(0.0..=16.0).contains(&self.delay) {
            return refused("delay", self.delay, "from 0 to 16 control cycles");
        }
        for position in &self.positions {
            let [least, most] = [axis.stroke.minimum, axis.stroke.maximum];
            if !(least..=most).contains(position) {
                return Err(LoopError::OutsideStroke {
                    position: *position,
                    least,
                    most,
                });
            }
        }
        Ok(())
    }

    fn positions(&self, axis: &Axis) -> Vec<f64> {
        let mut all = self.positions.clone();
        if all.is_empty() {
            let stroke = &axis.stroke;
            let reach = axis.mechanism.reach();
            let least = reach.map_or(stroke.minimum, |r| r.least.max(stroke.minimum));
            let most = reach.map_or(stroke.maximum, |r| r.most.min(stroke.maximum));
            all = vec![stroke.start, least, 0.5 * (least + most), most];
        }
        let mut once: Vec<f64> = Vec::new();
        for position in all {
            if !once.contains(&position) {
                once.push(position);
            }
        }
        once
    }
}

/// The loops of an axis in all corners of a set.
pub(crate) struct AxisLoops {
    pub model: LoopModel,
    /// The first ones are those of the file's own mass and friction at the first position: sliding,
    /// then stuck.
    pub corners: Vec<CornerLoop>,
    /// Frequencies of the natural modes at the first position, rad/s, the rigid motion left out.
    pub modes: Vec<f64>,
    /// Of all that moves, at the motor, kg·m².
    pub inertia: f64,
}

impl AxisLoops {
    pub fn new(axis: &Axis, set: &LoopSet) -> Result<Self, LoopError> {
        Self::of_model(axis, LoopModel::new(axis)?, set)
    }

    /// Of an axis whose drive is that of another model.
    pub fn of_model(axis: &Axis, mut model: LoopModel, set: &LoopSet) -> Result<Self, LoopError> {
        set.check(axis)?;
        model.model.delay += set.delay * axis.period;
        let places = set.positions(axis);
        let mut modes: Vec<(f64, Vec<Mode>)> = Vec::new();
        for position in places {
            let found = modes_at(axis, position)?;
            // A rigid machine, or one of one stiffness, is the same everywhere.
            if !modes.iter().any(|(_, known)| *known == found) {
                modes.push((position, found));
            }
        }
        let mut all = Vec::new();
        for (position, modes) in &modes {
            for friction in &set.frictions {
                for mass in &set.masses {
                    for stuck in [false, true] {
                        let at = Corner {
                            position: *position,
                            mass: *mass,
                            friction: *friction,
                            stuck,
                        };
                        all.push((at, modes));
                    }
                }
            }
        }
        // The file's own first.
        let own = |at: &Corner| at.position == modes[0].0 && at.mass == 1.0 && at.friction == 1.0;
        all.sort_by_key(|(at, _)| !own(at));
        let mut corners: Vec<CornerLoop> = all
            .par_iter()
            .map(|(at, modes)| CornerLoop::new(&model, modes, at))
            .collect();
        for measured in &set.measured {
            let modes = modes_at(axis, measured.position)?;
            corners.push(CornerLoop::measured(&model, &modes, measured));
        }
        // The rigid motion, normalised: φ² = 1/J.
        let inertia = modes[0].1[0].motor.powi(-2);
        let modes = modes[0].1.iter().map(|mode| mode.frequency);
        Ok(Self {
            corners,
            modes: modes.filter(|w| *w > 0.0).collect(),
            model,
            inertia,
        })
    }

    /// The gains of the axis' file.
    pub fn gains(&self) -> LoopGains {
        let cascade = self.model.cascade();
        LoopGains {
            speed: cascade.speed,
            integral: cascade.speed_integral,
            position: cascade.position,
        }
    }
}
