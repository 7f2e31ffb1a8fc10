//! The elastic drive by the slow, obvious integration: classical Runge–Kutta of
//! fourth order on the angles and speeds of motor and load.

use feed_dynamics::{ElasticDrive, ElasticDriveParameters, Stiffness};
use std::sync::Arc;

use crate::reference::{Acts, Seen, nut_force};

/// Numbers of a drive of two inertias.
#[derive(Clone, Copy)]
pub struct TwoInertias {
    pub motor: f64,
    pub load: f64,
    pub ratio: f64,
    pub beta: f64,
    /// k at the load's position.
    pub stiffness: fn(f64) -> f64,
    pub origin: f64,
}

/// θ, y and their rates.
type State = [f64; 4];

impl TwoInertias {
    /// The crate's drive of the same numbers.
    pub fn drive(&self, stiffness: Arc<dyn Stiffness>) -> ElasticDrive {
        ElasticDrive::new(ElasticDriveParameters {
            motor_inertia: self.motor,
            load_inertia: self.load,
            travel_per_radian: self.ratio,
            stiffness,
            stiffness_damping: self.beta,
        })
        .unwrap()
    }

    /// Rates of the state, and the force on the load.
    fn rate(&self, s: &State, t: f64, acts: &Acts) -> (State, f64) {
        let [offset, offset_rate] = (acts.offset)(t);
        let delta = self.ratio * s[0] + offset - s[1];
        let closing = self.ratio * s[2] + offset_rate - s[3];
        let k = (self.stiffness)(self.origin + s[1]);
        let force = nut_force(k, delta, closing, self.beta, acts.gap);
        let motor = ((acts.torque)(t) - self.ratio * force) / self.motor;
        let load = (force - (acts.load)(t, s[3])) / self.load;
        ([s[2], s[3], motor, load], force)
    }

    /// From rest: what is seen at the ends of `count` equal parts of `duration`, in
    /// steps of `h`.
    pub fn run(&self, acts: &Acts, duration: f64, count: usize, h: f64) -> Vec<Seen> {
        let part = (duration / count as f64 / h).round() as usize;
        let (mut s, mut seen) = ([0.0; 4], Vec::new());
        for i in 1..=count * part {
            let t = (i - 1) as f64 * h;
            let to = |rate: &State, h: f64| std::array::from_fn(|i| s[i] + h * rate[i]);
            let a = self.rate(&s, t, acts).0;
            let b = self.rate(&to(&a, 0.5 * h), t + 0.5 * h, acts).0;
            let c = self.rate(&to(&b, 0.5 * h), t + 0.5 * h, acts).0;
            let d = self.rate(&to(&c, h), t + h, acts).0;
            for (i, s) in s.iter_mut().enumerate() {
                *s += h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
            }
            if i % part == 0 {
                let force = self.rate(&s, i as f64 * h, acts).1;
                seen.push([s[2], s[1], s[3], force]);
            }
        }
        seen
    }
}
