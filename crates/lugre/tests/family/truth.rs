//! The laws as their papers print them, integrated in small explicit steps: force and
//! deflection as they stand there, no exponential, no normalisation, none of the crate's code.

/// Levels, speed, exponent and viscous terms of `super::CURVE`, by number.
#[derive(Clone, Copy)]
pub struct Curve {
    pub forward: [f64; 2],
    pub backward: [f64; 2],
}

pub const FALLING: Curve = Curve {
    forward: [60.0, 85.0],
    backward: [70.0, 80.0],
};

pub const FLAT: Curve = Curve {
    forward: [60.0, 60.0],
    backward: [70.0, 70.0],
};

impl Curve {
    pub fn coulomb(self, v: f64) -> f64 {
        if v > 0.0 {
            self.forward[0]
        } else {
            self.backward[0]
        }
    }

    pub fn level(self, v: f64) -> f64 {
        let [coulomb, stiction] = if v > 0.0 { self.forward } else { self.backward };
        coulomb + (stiction - coulomb) / (v.abs() / 4e-3).powf(1.4).exp()
    }
}

pub fn motion(t: f64) -> f64 {
    0.012 * (8.2 * t).sin() + 0.007 * (19.5 * t + 0.4).sin()
}

/// Runge and Kutta's method on `dz/dt = f(z, v(t))`; `z` at every `every`-th of `steps`.
pub fn integrate(
    f: impl Fn(f64, f64) -> f64,
    seconds: f64,
    steps: usize,
    every: usize,
) -> Vec<f64> {
    let h = seconds / steps as f64;
    let (mut z, mut out) = (0.0, vec![0.0]);
    for k in 0..steps {
        let t = k as f64 * h;
        let [v0, v1, v2] = [motion(t), motion(t + 0.5 * h), motion(t + h)];
        let a = f(z, v0);
        let b = f(z + 0.5 * h * a, v1);
        let c = f(z + 0.5 * h * b, v1);
        let d = f(z + h * c, v2);
        z += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
        if (k + 1) % every == 0 {
            out.push(z);
        }
    }
    out
}

/// Elasto-plastic, as printed: α by sine between z_ba and z_max.
pub fn elasto_plastic(curve: Curve, stiffness: f64, share: f64) -> impl Fn(f64, f64) -> f64 {
    move |z, v| {
        let greatest = curve.level(v) / stiffness;
        let elastic = share * curve.coulomb(v) / stiffness;
        let alpha = if z * v <= 0.0 || z.abs() <= elastic {
            0.0
        } else if z.abs() >= greatest {
            1.0
        } else {
            let middle = 0.5 * (greatest + elastic);
            0.5 * (std::f64::consts::PI * (z.abs() - middle) / (greatest - elastic)).sin() + 0.5
        };
        v * (1.0 - alpha * v.signum() * z / greatest)
    }
}

/// Bouc and Wen with A = 1, β and γ of each direction and speed.
pub fn bouc_wen(curve: Curve, stiffness: f64, n: f64, share: f64) -> impl Fn(f64, f64) -> f64 {
    move |z, v| {
        let sum = (curve.level(v) / stiffness).powf(-n);
        let (beta, gamma) = (share * sum, (1.0 - share) * sum);
        v - beta * v.abs() * z.abs().powf(n - 1.0) * z - gamma * v * z.abs().powf(n)
    }
}

/// Dahl: dF/dx = σ0 |1 − F sign v/F_C|^i sign(1 − F sign v/F_C).
pub fn dahl(curve: Curve, stiffness: f64, i: f64) -> impl Fn(f64, f64) -> f64 {
    move |z, v| {
        let of = 1.0 - stiffness * z * v.signum() / curve.level(v);
        v * of.abs().powf(i) * of.signum()
    }
}

/// LuGre.
pub fn lugre(curve: Curve, stiffness: f64) -> impl Fn(f64, f64) -> f64 {
    move |z, v| v - stiffness * v.abs() * z / curve.level(v)
}

/// Generalised Maxwell slip by Euler's method, element by element: forces at every `every`-th step.
pub fn maxwell(curve: Curve, seconds: f64, steps: usize, every: usize) -> Vec<f64> {
    let h = seconds / steps as f64;
    let elements = [(0.1, 2e6), (0.2, 1e6), (0.3, 0.5e6), (0.4, 0.25e6)];
    let (mut force, mut slips, mut before) = ([0.0_f64; 4], [false; 4], 0.0_f64);
    let mut out = vec![0.0];
    for k in 0..steps {
        let v = motion((k as f64 + 0.5) * h);
        if v * before < 0.0 {
            slips = [false; 4];
        }
        before = v;
        let s = curve.level(v);
        for (i, (share, stiffness)) in elements.into_iter().enumerate() {
            if !slips[i] {
                let next = force[i] + stiffness * v * h;
                if next * v.signum() >= share * s {
                    slips[i] = true;
                    if force[i] * v.signum() < share * s {
                        force[i] = share * s * v.signum();
                    }
                    continue;
                }
                force[i] = next;
            } else {
                force[i] += h * 4e4 * (share * v.signum() - force[i] / s);
            }
        }
        if (k + 1) % every == 0 {
            out.push(force.iter().sum());
        }
    }
    out
}
