//! Heat of the paper's screw axis, by brute force: the screw as a rod in 5 mm cells, the nut where it
//! is at each instant, losses of each instant, steps of 40 ms.
//!
//! ```text
//! ρ c ∂S/∂t = λ ∂²S/∂x² − (4 h/D)(S − T_air) + (4/πD²) q(x, t)
//! ```
//!
//! What differs on purpose from the library: no averages over a duty, explicit Euler steps instead of
//! modes, the air's heat transfer at each instant's speed, heat of the nut over its length at its
//! place. [`HeatLaws::OTHER`] also has other laws: Vogel's viscosity, preload by Hertz' contact, and
//! free convection that grows with the temperature.

use std::f64::consts::PI;

use crate::motion::Motion;
use crate::parameters::Parameters;

/// Numbers of the axis besides those of [`Parameters`]: capacities in J/K, conductances in W/K.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatNumbers {
    /// Winding, housing, front bearing, rear bearing, nut, table, bed, scale.
    pub capacity: [f64; 8],
    /// Of the same to the air.
    pub air: [f64; 8],
    /// Winding–housing, housing–front, front–bed, rear–bed, front–screw, rear–screw, nut–table, scale–bed.
    pub link: [f64; 8],
    /// Nut–screw.
    pub nut_screw: f64,
    /// Nut's and both bearings' shares of dry and of viscous friction.
    pub nut_share: [f64; 2],
    /// Both bearings' shares.
    pub bearing_share: [f64; 2],
    /// Density, specific heat, conductivity of the screw.
    pub steel: [f64; 3],
    /// Its expansion, 1/K.
    pub expansion: f64,
    /// Shaft between bearing and place 0, m.
    pub shaft: f64,
    /// Length of the nut, m.
    pub nut_length: f64,
    /// Heat transfer at rest, W/(m²·K).
    pub still_air: f64,
}

/// How friction and air follow the temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatLaws {
    /// Viscosity: exp(−c (T − 20)), c in 1/K, or Vogel's exp(B/(T + C) − B/(20 + C)), B and C in K.
    pub viscosity: Viscosity,
    /// Dry friction falls by so much a kelvin.
    pub dry: f64,
    /// The nut's dry friction is (1 + p ΔT)^n, ΔT the screw under the nut less the nut.
    pub preload: [f64; 2],
    /// Whether free convection grows as (ΔT/10 K)^¼.
    pub free_convection: bool,
}

/// A law of viscosity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viscosity {
    /// exp(−c (T − 20)).
    Exponential(f64),
    /// exp(B/(T + C) − B/(20 + C)).
    Vogel(f64, f64),
}

impl HeatLaws {
    /// The laws that the library has.
    pub const SAME: Self = Self {
        viscosity: Viscosity::Exponential(0.025),
        dry: 0.002,
        preload: [0.015, 1.0],
        free_convection: false,
    };

    /// Other laws: Vogel's viscosity of a mineral oil (−3.2 %/K at 20 °C, −2.6 at 30 °C), preload
    /// with the power 2/3, free convection by ΔT^¼.
    pub const OTHER: Self = Self {
        viscosity: Viscosity::Vogel(500.0, 105.0),
        dry: 0.001,
        preload: [0.022, 2.0 / 3.0],
        free_convection: true,
    };
}

/// Cells of the screw.
const CELLS: usize = 300;
/// Step, s.
const STEP: f64 = 0.04;

/// The axis with its temperatures.
#[derive(Clone, Debug)]
pub struct HeatedScrew {
    axis: Parameters,
    numbers: HeatNumbers,
    laws: HeatLaws,
    /// Of the bodies, in the order of [`HeatNumbers::capacity`], °C.
    pub bodies: [f64; 8],
    /// Of the screw's cells, °C.
    pub screw: Vec<f64>,
    /// s.
    pub time: f64,
    /// All heat so far, J.
    pub heat: f64,
    /// That of friction, J.
    pub friction_heat: f64,
}

impl HeatedScrew {
    /// At one temperature, °C.
    pub fn at(axis: Parameters, numbers: HeatNumbers, laws: HeatLaws, temperature: f64) -> Self {
        Self {
            axis,
            numbers,
            laws,
            bodies: [temperature; 8],
            screw: vec![temperature; CELLS],
            time: 0.0,
            heat: 0.0,
            friction_heat: 0.0,
        }
    }

    /// The axis' numbers.
    pub fn axis(&self) -> Parameters {
        self.axis
    }

    /// Runs on for `duration` s, the motion without end, in its phase at each time since the start (or
    /// standing still), in air of a temperature that follows that time (s).
    pub fn run(&mut self, motion: Option<&Motion>, duration: f64, air: impl Fn(f64) -> f64) {
        let steps = (duration / STEP).round() as u64;
        let begun = self.time;
        let whole = motion.map_or(1.0, Motion::duration);
        for k in 0..steps {
            // A stretch goes on where the last one ended.
            let now = begun + k as f64 * STEP;
            let at = |t: f64| motion.map(|m| m.at(t.rem_euclid(whole)));
            let [x, v, a] = match (at(now + 0.5 * STEP), at(now), at(now + STEP)) {
                (Some(middle), Some(from), Some(to)) => {
                    let a = (to.velocity - from.velocity) / STEP;
                    [middle.position, middle.velocity, a]
                }
                _ => [0.5 * self.axis.screw_length, 0.0, 0.0],
            };
            self.step(x, v, a, air(now));
            self.time = begun + (k + 1) as f64 * STEP;
        }
    }

    fn step(&mut self, x: f64, v: f64, a: f64, air: f64) {
        let (p, n) = (self.axis, self.numbers);
        let w = v.abs() / p.travel();
        let level = p.coulomb + (p.stiction - p.coulomb) * (-(w / p.stribeck_speed).powi(2)).exp();
        let viscous = p.viscous * w;
        let [of_nut, of_front, of_rear, of_guide] = self.factors(x);
        let guide_share = [0, 1].map(|i| 1.0 - n.nut_share[i] - n.bearing_share[i]);
        let torque = |share: [f64; 2], factor: [f64; 2]| {
            share[0] * factor[0] * level + share[1] * factor[1] * viscous
        };
        let nut = torque(n.nut_share, of_nut);
        let front = 0.6 * torque(n.bearing_share, of_front);
        let rear = 0.4 * torque(n.bearing_share, of_rear);
        let guide = torque(guide_share, of_guide);
        let moves = if w > 0.0 { v.signum() } else { 0.0 };
        let inertia = p.motor_inertia + p.sensor_inertia + self.screw_inertia();
        let inertia = inertia + p.table_mass * p.travel().powi(2);
        let motor = inertia * a / p.travel() + moves * (nut + front + rear + guide);
        let current = motor / p.torque_constant;
        let copper =
            1.5 * p.resistance * current * current * (1.0 + 0.00393 * (self.bodies[0] - 20.0));
        let heats = [copper, w * front, w * rear, w * nut, w * guide];
        self.heat += STEP * heats.iter().sum::<f64>();
        self.friction_heat += STEP * heats[1..].iter().sum::<f64>();
        self.conduct(x, w, heats, air);
    }

    fn screw_inertia(&self) -> f64 {
        let p = &self.axis;
        p.density * PI * p.screw_diameter.powi(4) / 32.0 * p.screw_length
    }

    /// Factors on dry and viscous friction of nut, front and rear bearing, guides.
    fn factors(&self, x: f64) -> [[f64; 2]; 4] {
        let laws = self.laws;
        let of = |t: f64| {
            let viscous = match laws.viscosity {
                Viscosity::Exponential(c) => (-c * (t - 20.0)).exp(),
                Viscosity::Vogel(b, c) => (b / (t + c) - b / (20.0 + c)).exp(),
            };
            [1.0 - laws.dry * (t - 20.0), viscous]
        };
        let cell = self.axis.screw_length / CELLS as f64;
        let here = self.screw[((x / cell) as usize).min(CELLS - 1)];
        let [_, _, front, rear, nut, table, ..] = self.bodies;
        let mut nut_factors = of(nut);
        let pressed = 1.0 + laws.preload[0] * (here - nut);
        nut_factors[0] *= pressed.max(0.0).powf(laws.preload[1]);
        [nut_factors, of(front), of(rear), of(table)]
    }

    /// Dry and viscous friction of the whole axis, the nut at `x` (m), as multiples of those at 20 °C.
    pub fn friction_factors(&self, x: f64) -> [f64; 2] {
        let n = &self.numbers;
        let [nut, front, rear, guide] = self.factors(x);
        [0, 1].map(|i| {
            let bearings = 0.6 * front[i] + 0.4 * rear[i];
            let guides = 1.0 - n.nut_share[i] - n.bearing_share[i];
            n.nut_share[i] * nut[i] + n.bearing_share[i] * bearings + guides * guide[i]
        })
    }

    /// An explicit step of all temperatures.
    fn conduct(&mut self, x: f64, w: f64, heats: [f64; 5], air: f64) {
        let n = self.numbers;
        let [copper, front, rear, nut, guide] = heats;
        let t = self.bodies;
        let mut power = [
            copper,
            0.0,
            front,
            rear,
            0.5 * nut,
            0.5 * guide,
            0.5 * guide,
            0.0,
        ];
        for ((power, conductance), t) in power.iter_mut().zip(n.air).zip(t) {
            *power += conductance * (air - t);
        }
        let pairs = [(0, 1), (1, 2), (2, 6), (3, 6)].into_iter().zip(n.link);
        let others = [(4, 5), (7, 6)].into_iter().zip([n.link[6], n.link[7]]);
        for ((i, j), conductance) in pairs.chain(others) {
            let flow = conductance * (t[i] - t[j]);
            power[i] -= flow;
            power[j] += flow;
        }
        // Temperatures of the rod's faces, from half a cell inside.
        let half = self.half_cell();
        let through = |link: f64| 1.0 / (1.0 / link + half);
        let ends = [
            through(n.link[4]) * (t[2] - self.screw[0]),
            through(n.link[5]) * (t[3] - self.screw[CELLS - 1]),
        ];
        power[2] -= ends[0];
        power[3] -= ends[1];
        power[4] -= self.rod([x, w], 0.5 * nut, ends, air);
        for ((body, power), capacity) in self.bodies.iter_mut().zip(power).zip(n.capacity) {
            *body += STEP * power / capacity;
        }
    }

    /// Thermal resistance of half a cell, K/W.
    fn half_cell(&self) -> f64 {
        let d = self.axis.screw_diameter;
        let area = PI * d * d / 4.0;
        0.5 * self.axis.screw_length / CELLS as f64 / (self.numbers.steel[2] * area)
    }

    /// A step of the rod; the heat that it took from the nut, W, besides the `loss` there.
    fn rod(&mut self, [x, w]: [f64; 2], loss: f64, ends: [f64; 2], air: f64) -> f64 {
        let (n, d) = (self.numbers, self.axis.screw_diameter);
        let cell = self.axis.screw_length / CELLS as f64;
        let area = PI * d * d / 4.0;
        let [density, heat, conductivity] = n.steel;
        let reynolds = w * d * d / (2.0 * 15.3e-6);
        let turning = 0.133 * reynolds.powf(2.0 / 3.0) * 0.71_f64.powf(1.0 / 3.0) * 0.0257 / d;
        let before = self.screw.clone();
        let [from, to] = [x - 0.5 * n.nut_length, x + 0.5 * n.nut_length];
        let mut taken = 0.0;
        for i in 0..CELLS {
            let here = before[i];
            let mut flow = 0.0;
            if i > 0 {
                flow += conductivity * area / cell * (before[i - 1] - here);
            }
            if i + 1 < CELLS {
                flow += conductivity * area / cell * (before[i + 1] - here);
            }
            let free = match self.laws.free_convection {
                true => ((here - air).abs() / 10.0).sqrt().sqrt(),
                false => 1.0,
            };
            let film = n.still_air * free + turning;
            flow += film * PI * d * cell * (air - here);
            let [left, right] = [i as f64 * cell, (i + 1) as f64 * cell];
            let left = if i == 0 { f64::NEG_INFINITY } else { left };
            let right = if i + 1 == CELLS { f64::INFINITY } else { right };
            let over = (to.min(right) - from.max(left)).max(0.0) / n.nut_length;
            let from_nut = n.nut_screw * over * (self.bodies[4] - here);
            taken += from_nut;
            flow += from_nut + over * loss;
            flow += if i == 0 { ends[0] } else { 0.0 };
            flow += if i + 1 == CELLS { ends[1] } else { 0.0 };
            self.screw[i] = here + STEP * flow / (density * heat * area * cell);
        }
        taken
    }

    /// Growth at `x` (m) since all was at `cold` °C, m; the screw is fixed at the driven end.
    pub fn growth(&self, cold: f64, x: f64) -> f64 {
        let cell = self.axis.screw_length / CELLS as f64;
        let part = |i: usize| (x - i as f64 * cell).clamp(0.0, cell) * (self.screw[i] - cold);
        let along: f64 = (0..CELLS).map(part).sum();
        self.numbers.expansion * (self.numbers.shaft * (self.bodies[2] - cold) + along)
    }
}
