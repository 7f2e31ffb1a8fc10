//! The numbers of the axis.

use crate::random::Random;

/// rad/s of one turn a minute.
const RPM: f64 = std::f64::consts::PI / 30.0;

/// The parameters of the axis, SI. [`Parameters::paper`] says where each comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// Length of the screw, m.
    pub screw_length: f64,
    /// Its diameter, m; solid.
    pub screw_diameter: f64,
    /// Travel per turn, m.
    pub lead: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poisson_ratio: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// Motor's inertia, kg·m².
    pub motor_inertia: f64,
    /// Torque sensor's inertia, kg·m².
    pub sensor_inertia: f64,
    /// Coupling between motor and sensor, N·m/rad.
    pub motor_coupling: f64,
    /// Coupling between sensor and screw, N·m/rad.
    pub screw_coupling: f64,
    /// Nut, N/m.
    pub nut_stiffness: f64,
    /// Table, kg.
    pub table_mass: f64,
    /// Damping by stiffness β, s.
    pub stiffness_damping: f64,
    /// Coulomb level T_C at the screw, N·m.
    pub coulomb: f64,
    /// Break-away level T_S, N·m.
    pub stiction: f64,
    /// Stribeck speed, rad/s.
    pub stribeck_speed: f64,
    /// Bristle stiffness σ0, N·m/rad.
    pub bristle_stiffness: f64,
    /// Bristle damping σ1, N·m·s/rad.
    pub bristle_damping: f64,
    /// Viscous friction σ2, N·m·s/rad.
    pub viscous: f64,
    /// Pole pairs p.
    pub pole_pairs: f64,
    /// Torque per q current K_t, N·m/A.
    pub torque_constant: f64,
    /// Resistance, Ω.
    pub resistance: f64,
    /// L_d, H.
    pub inductance_d: f64,
    /// L_q, H.
    pub inductance_q: f64,
    /// DC link, V.
    pub dc_link: f64,
    /// Control period, s.
    pub period: f64,
    /// Position controller, rad/s per m.
    pub position_gain: f64,
    /// Share of the reference velocity that is fed forward.
    pub velocity_feedforward: f64,
    /// Speed controller, A·s/rad.
    pub speed_p: f64,
    /// Its integral, A/rad.
    pub speed_i: f64,
    /// Controller of the d current, V/A.
    pub d_p: f64,
    /// Its integral, V/(A·s).
    pub d_i: f64,
    /// Controller of the q current, V/A.
    pub q_p: f64,
    /// Its integral, V/(A·s).
    pub q_i: f64,
    /// Greatest q current reference, A.
    pub current_limit: f64,
}

impl Parameters {
    /// Tables 1 to 5 of the paper with units that make sense of them; what it does not
    /// print is assumed (screw's material, sensor's inertia, pole pairs, DC link, damping).
    pub fn paper() -> Self {
        Self {
            screw_length: 1.5,
            screw_diameter: 0.04,
            lead: 0.01,
            youngs_modulus: 206e9,
            poisson_ratio: 0.3,
            density: 7850.0,
            motor_inertia: 0.0053,
            sensor_inertia: 1e-4,
            motor_coupling: 2800.0,
            screw_coupling: 2800.0,
            nut_stiffness: 7.45e7,
            table_mass: 515.0,
            stiffness_damping: 1e-5,
            coulomb: 0.6757,
            stiction: 0.7653,
            stribeck_speed: 25.9147 * RPM,
            bristle_stiffness: 1.5875 / RPM,
            bristle_damping: 0.1593 / RPM,
            viscous: 0.0003 / RPM,
            pole_pairs: 4.0,
            torque_constant: 1.641,
            resistance: 0.75,
            inductance_d: 4.11e-3,
            inductance_q: 13.2e-3,
            dc_link: 540.0,
            period: 1e-4,
            position_gain: 280.2 * RPM / 1e-3,
            velocity_feedforward: 1.0,
            speed_p: 0.0678 / RPM,
            speed_i: 0.7122 / RPM,
            d_p: 2.776,
            d_i: 626.2,
            q_p: 8.805,
            q_i: 1003.3,
            current_limit: 15.0,
        }
    }

    /// Travel of the table per radian, r, m/rad.
    pub fn travel(&self) -> f64 {
        self.lead / std::f64::consts::TAU
    }

    /// Flux linkage ψ, Wb: K_t = 1.5 p ψ where i_d = 0.
    pub fn flux(&self) -> f64 {
        self.torque_constant / (1.5 * self.pole_pairs)
    }

    /// Names and shares by which each physical parameter is put off, uniformly by up to
    /// `share` of its value. Lengths, pole pairs, DC link and the drive's settings are
    /// exact: they are read off, not measured. Meant for the paper's values.
    pub fn put_off(&mut self, share: f64, random: &mut Random) -> Vec<(&'static str, f64)> {
        let mut by = Vec::new();
        for (name, value) in self.uncertain() {
            let off = share * (2.0 * random.uniform() - 1.0);
            *value *= 1.0 + off;
            by.push((name, off));
        }
        // Friction does not begin below its sliding level.
        if self.stiction < self.coulomb {
            let off = self.coulomb / Self::paper().stiction - 1.0;
            self.stiction = self.coulomb;
            for (name, told) in &mut by {
                if *name == "stiction" {
                    *told = off;
                }
            }
        }
        by
    }

    fn uncertain(&mut self) -> [(&'static str, &mut f64); 19] {
        [
            ("youngs-modulus", &mut self.youngs_modulus),
            ("density", &mut self.density),
            ("motor-inertia", &mut self.motor_inertia),
            ("torque-sensor-inertia", &mut self.sensor_inertia),
            ("motor-coupling", &mut self.motor_coupling),
            ("screw-coupling", &mut self.screw_coupling),
            ("nut-stiffness", &mut self.nut_stiffness),
            ("table-mass", &mut self.table_mass),
            ("stiffness-damping", &mut self.stiffness_damping),
            ("coulomb", &mut self.coulomb),
            ("stiction", &mut self.stiction),
            ("stribeck-speed", &mut self.stribeck_speed),
            ("bristle-stiffness", &mut self.bristle_stiffness),
            ("bristle-damping", &mut self.bristle_damping),
            ("viscous", &mut self.viscous),
            ("torque-constant", &mut self.torque_constant),
            ("resistance", &mut self.resistance),
            ("inductance-d", &mut self.inductance_d),
            ("inductance-q", &mut self.inductance_q),
        ]
    }
}
