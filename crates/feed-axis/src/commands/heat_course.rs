//! What `heat` keeps of the hours: the same number of times, however long they last.

use axis_thermal::{AxisAtWork, ThermalModel, ThermalState};

use super::heat_words::{Heated, HeatedForce, HeatedPlace};

impl Heated {
    /// Adds the state at a time; growth is counted from the first.
    pub(super) fn push(
        &mut self,
        model: &ThermalModel,
        at_work: &AxisAtWork,
        [cold, now]: [&ThermalState; 2],
    ) {
        self.time_min.push(now.time / 60.0);
        for node in &mut self.nodes {
            node.temperature_c.push(now.of(node.node));
        }
        let screw = now.screw();
        if !screw.is_empty() {
            let mean = screw.iter().sum::<f64>() / screw.len() as f64;
            self.screw_mean_c.push(mean);
        }
        self.loss_w.push(at_work.losses(now).total());
        let [dry, viscous] = at_work.friction_factors(now);
        self.dry_factor.push(dry);
        self.viscous_factor.push(viscous);
        for place in &mut self.places {
            let growth = model.growth(cold, now, 1e-3 * place.position_mm);
            if let Some(screw) = &mut place.screw_um {
                screw.push(1e6 * growth.screw);
            }
            place.scale_um.push(1e6 * growth.scale);
            place.bed_um.push(1e6 * growth.bed);
        }
        if let Some(force) = model.thermal_force(cold, now) {
            let all = self.force.get_or_insert_default();
            let HeatedForce {
                compression_n,
                tension_n,
            } = all;
            compression_n.push(force.compression);
            tension_n.push(force.tension);
        }
    }
}

impl HeatedPlace {
    /// Empty ones at these positions, m.
    pub(super) fn all(positions: &[f64], has_screw: bool) -> Vec<Self> {
        let one = |position: &f64| Self {
            position_mm: 1e3 * position,
            screw_um: has_screw.then(Vec::new),
            scale_um: Vec::new(),
            bed_um: Vec::new(),
        };
        positions.iter().map(one).collect()
    }
}
