//! The simulated side of the pre-sliding fit.

use nalgebra::{Matrix2, Vector2};

use super::least_squares::central_difference;
use super::static_fit::StaticParameters;
use crate::law::LuGre;

/// (`ln σ0`, `σ1`, `σ0 z` at the start, torque offset). The logarithm keeps
/// `σ0` positive, and lets one step scale serve all orders of magnitude.
pub(super) type Unknowns = [f64; 4];

/// What a trial simulation needs of the record.
pub(super) struct Trial<'a> {
    pub time_step: f64,
    pub speeds: &'a [f64],
    pub torque: &'a [f64],
    pub statics: StaticParameters,
    /// Weight of the observation that the initial bristle torque is 0 ± `T_S`:
    /// noise of the torque over `T_S`.
    pub prior: f64,
}

impl Trial<'_> {
    /// Calls `visit(k, z, dz/dt, steady z)` for every sample; `false` if the
    /// parameters make no law (a trial far off may overflow).
    fn walk(
        &self,
        statics: &StaticParameters,
        x: &Unknowns,
        mut visit: impl FnMut(usize, f64, f64, f64),
    ) -> bool {
        let stiffness = x[0].exp();
        let ordered = StaticParameters {
            // Differences with respect to T_C and T_S may reverse their order
            // by the width of the difference, where both are equal, and σ2,
            // which the bristle does not feel, may become negative.
            stiction: statics.stiction.max(statics.coulomb),
            viscous: 0.0,
            ..*statics
        };
        let Ok(law) = LuGre::new(ordered.with_bristles(stiffness, 0.0)) else {
            return false;
        };
        let mut z = x[2] / stiffness;
        for (k, &w) in self.speeds.iter().enumerate() {
            if k > 0 {
                z = law.step(z, self.speeds[k - 1], w, self.time_step);
            }
            visit(k, z, law.rate(z, w), law.steady_bristle(w));
        }
        true
    }

    /// Simulated less measured torque, and the prior in the last place.
    pub fn residuals(&self, statics: &StaticParameters, x: &Unknowns, out: &mut [f64]) {
        let n = self.speeds.len();
        let stiffness = x[0].exp();
        let valid = self.walk(statics, x, |k, z, rate, _| {
            let viscous = statics.viscous * self.speeds[k];
            out[k] = stiffness * z + x[1] * rate + viscous + x[3] - self.torque[k];
        });
        if !valid {
            out.fill(f64::MAX.sqrt());
        }
        out[n] = self.prior * x[2];
    }

    /// Typical magnitudes of the unknowns.
    pub fn scale(&self, x: &Unknowns) -> Unknowns {
        let fastest = self.speeds.iter().fold(0.0, |a: f64, w| a.max(w.abs()));
        let level = self.statics.stiction;
        [1.0, x[1].max(level / fastest), level, level]
    }

    /// The best of a grid; `None` if nothing moves.
    pub fn search(&self) -> Option<Unknowns> {
        let (mut low, mut high, mut position) = (0.0_f64, 0.0_f64, 0.0);
        for pair in self.speeds.windows(2) {
            position += 0.5 * (pair[0] + pair[1]) * self.time_step;
            low = low.min(position);
            high = high.max(position);
        }
        let range = high - low;
        if range <= 0.0 || !range.is_finite() {
            return None;
        }
        // A break-away deflection from 10 ranges down to a 3000th of one.
        let softest = (0.1 * self.statics.coulomb / range).ln();
        let span = 3e4_f64.ln();
        let level = self.statics.stiction;
        (0..=24)
            .flat_map(|i| {
                let log_stiffness = softest + span * f64::from(i) / 24.0;
                [-0.8, 0.0, 0.8].map(|share| [log_stiffness, 0.0, share * level, 0.0])
            })
            .filter_map(|x| self.linear(x))
            .filter(|(_, cost)| cost.is_finite())
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(x, _)| x)
    }

    /// `σ1` (not negative) and the offset by linear least squares, in one walk.
    fn linear(&self, mut x: Unknowns) -> Option<(Unknowns, f64)> {
        let stiffness = x[0].exp();
        let n = self.speeds.len() as f64;
        // Sums over e (misfit without σ1 and offset) and r (dz/dt).
        let (mut e1, mut ee, mut r1, mut rr, mut re) = (0.0, 0.0, 0.0, 0.0, 0.0);
        let valid = self.walk(&self.statics, &x, |k, z, r, _| {
            let e = stiffness * z + self.statics.viscous * self.speeds[k] - self.torque[k];
            e1 += e;
            ee += e * e;
            r1 += r;
            rr += r * r;
            re += r * e;
        });
        if !valid {
            return None;
        }
        let normal = Matrix2::new(rr, r1, r1, n);
        let solution = normal.try_inverse()? * Vector2::new(-re, -e1);
        let damping = solution[0].max(0.0);
        let offset = -(e1 + damping * r1) / n;
        (x[1], x[3]) = (damping, offset);
        let cost = ee
            + damping * (2.0 * re + damping * rr)
            + offset * (2.0 * (e1 + damping * r1) + offset * n);
        let prior = self.prior * x[2];
        Some((x, cost + prior * prior))
    }

    /// Samples in motion whose bristles are more than a tenth of their steady
    /// deflection away from it.
    pub fn presliding_samples(&self, x: &Unknowns) -> usize {
        let mut found = 0;
        self.walk(&self.statics, x, |_, z, _, steady| {
            found += usize::from((z - steady).abs() > 0.1 * steady.abs() && steady != 0.0);
        });
        found
    }

    /// `∂residuals/∂(T_C, T_S, Ω_S, σ2)`.
    pub fn static_sensitivities(&self, x: &Unknowns) -> [Vec<f64>; 4] {
        let s = self.statics;
        let values = [s.coulomb, s.stiction, s.stribeck_speed, s.viscous];
        let residuals = |v: &[f64; 4], out: &mut [f64]| {
            let statics = StaticParameters {
                coulomb: v[0],
                stiction: v[1],
                stribeck_speed: v[2],
                viscous: v[3],
            };
            self.residuals(&statics, x, out);
        };
        let fastest = self.speeds.iter().fold(0.0, |a: f64, w| a.max(w.abs()));
        let scale = [
            s.coulomb,
            s.stiction,
            s.stribeck_speed,
            s.stiction / fastest,
        ];
        core::array::from_fn(|i| {
            central_difference(
                &residuals,
                &values,
                i,
                1e-5 * scale[i],
                self.speeds.len() + 1,
            )
        })
    }
}
