//! The slow, obvious integration: classical Runge–Kutta of fourth order on
//! the full matrices, shape functions, built anew from x at every stage.

use feed_dynamics::{FeedDrive, NutCoupling};
use nalgebra::{DMatrix, DVector};

/// Motor speed, table displacement, table speed, nut force.
pub type Seen = [f64; 4];

pub struct Reference<'a> {
    drive: &'a FeedDrive,
    origin: f64,
    mass_inverse: DMatrix<f64>,
    pub q: DVector<f64>,
    pub v: DVector<f64>,
}

impl<'a> Reference<'a> {
    /// At rest, relaxed, the table at `origin`.
    pub fn at_rest(drive: &'a FeedDrive, origin: f64) -> Self {
        let n = drive.coordinates();
        let m = drive.matrices(origin, NutCoupling::ShapeFunctions).unwrap();
        Self {
            drive,
            origin,
            mass_inverse: m.mass.try_inverse().unwrap(),
            q: DVector::zeros(n),
            v: DVector::zeros(n),
        }
    }

    fn acceleration(
        &self,
        q: &DVector<f64>,
        v: &DVector<f64>,
        torque: f64,
        load: f64,
    ) -> DVector<f64> {
        let last = q.len() - 1;
        let x = self.origin + q[last];
        let m = self.drive.matrices(x, NutCoupling::ShapeFunctions).unwrap();
        let mut force = -(&m.stiffness * q) - &m.damping * v;
        force[0] += torque;
        force[last] -= load;
        &self.mass_inverse * force
    }

    /// One step from `t` to `t + h`; the load may depend on time and table speed.
    pub fn step(
        &mut self,
        t: f64,
        h: f64,
        torque: impl Fn(f64) -> f64,
        load: impl Fn(f64, f64) -> f64,
    ) {
        let last = self.q.len() - 1;
        let rate = |t: f64, q: &DVector<f64>, v: &DVector<f64>| {
            self.acceleration(q, v, torque(t), load(t, v[last]))
        };
        let (q, v) = (&self.q, &self.v);
        let a1 = rate(t, q, v);
        let v2 = v + &a1 * (0.5 * h);
        let a2 = rate(t + 0.5 * h, &(q + v * (0.5 * h)), &v2);
        let v3 = v + &a2 * (0.5 * h);
        let a3 = rate(t + 0.5 * h, &(q + &v2 * (0.5 * h)), &v3);
        let v4 = v + &a3 * h;
        let a4 = rate(t + h, &(q + &v3 * h), &v4);
        let next_q = q + (v + (&v2 + &v3) * 2.0 + v4) * (h / 6.0);
        let next_v = v + (a1 + (a2 + a3) * 2.0 + a4) * (h / 6.0);
        (self.q, self.v) = (next_q, next_v);
    }

    pub fn seen(&self) -> Seen {
        let last = self.q.len() - 1;
        let x = self.origin + self.q[last];
        let m = self.drive.matrices(x, NutCoupling::ShapeFunctions).unwrap();
        // The table's row of K q + C q̇ is minus the force of the nut on it.
        let force = -(m.stiffness.row(last) * &self.q + m.damping.row(last) * &self.v)[0];
        [self.v[0], self.q[last], self.v[last], force]
    }
}
