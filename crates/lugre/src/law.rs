//! The validated law: equations (1) to (4) of the crate page.

use crate::exponential::exp_minus;
use crate::parameters::{LugreError, Parameters};

/// A validated friction law: immutable, 104 bytes, free to copy.
///
/// The bristle deflection `z` is the caller's, so that snapshots, several
/// contacts and Monte Carlo runs need nothing from this type. No method
/// fails or allocates; a NaN in gives a NaN out.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Parameters", into = "Parameters"))]
pub struct LuGre {
    parameters: Parameters,
    /// σ0 of the bristles; 0 where they carry nothing.
    stiffness: f64,
    /// 1 / σ0, rad/(N·m).
    compliance: f64,
    /// T_S − T_C, N·m.
    rise: f64,
    /// 1 / Ω_S, s/rad.
    per_stribeck_speed: f64,
    /// |ω| from which the level rounds to T_C, rad/s.
    flat_above: f64,
    /// T_C / σ0, rad.
    coulomb_bristle: f64,
    /// σ0 / T_C, 1/rad.
    coulomb_decay: f64,
}

impl LuGre {
    /// Validates the parameters and prepares what the hot path needs.
    ///
    /// # Errors
    /// [`LugreError`] as by [`Parameters::validate`].
    pub fn new(parameters: Parameters) -> Result<Self, LugreError> {
        parameters.validate()?;
        // Without any level the bristles carry nothing, in the limit
        // T_C → 0: z stays 0 and only σ2 ω is left.
        let null = parameters.stiction == 0.0;
        let stiffness = if null { 0.0 } else { parameters.stiffness };
        let compliance = if null { 0.0 } else { 1.0 / stiffness };
        Ok(Self {
            parameters,
            stiffness,
            compliance,
            rise: parameters.stiction - parameters.coulomb,
            per_stribeck_speed: 1.0 / parameters.stribeck_speed,
            flat_above: flat_above(&parameters),
            coulomb_bristle: parameters.coulomb * compliance,
            coulomb_decay: if null {
                0.0
            } else {
                stiffness / parameters.coulomb
            },
        })
    }

    /// The parameters that the law was made from.
    #[must_use]
    pub fn parameters(&self) -> Parameters {
        self.parameters
    }

    /// `G(ω)`, equation (2), N·m; between `T_C` and `T_S`.
    #[must_use]
    #[inline]
    pub fn level(&self, speed: f64) -> f64 {
        let speed = speed.abs();
        if speed >= self.flat_above {
            self.parameters.coulomb
        } else {
            self.falling_level(speed)
        }
    }

    /// The speed |ω| in rad/s from which [`level`](Self::level) is `T_C` to
    /// the last bit, so that no exponential is computed.
    #[must_use]
    pub fn flat_above(&self) -> f64 {
        self.flat_above
    }

    /// `T_ss(ω) = G(ω) sign ω + σ2 ω`, equation (4), N·m; 0 at rest.
    #[must_use]
    #[inline]
    pub fn steady_state(&self, speed: f64) -> f64 {
        if speed == 0.0 {
            return 0.0;
        }
        self.level(speed).copysign(speed) + self.parameters.viscous * speed
    }

    /// The deflection at constant speed, `z = G(ω) sign ω / σ0`, rad; 0 at
    /// rest, where every deflection within
    /// [`bristle_limit`](Self::bristle_limit) is steady.
    #[must_use]
    #[inline]
    pub fn steady_bristle(&self, speed: f64) -> f64 {
        if speed == 0.0 {
            return 0.0;
        }
        self.curve(speed.abs()).0.copysign(speed)
    }

    /// `T_S / σ0`, rad: no motion drives |z| beyond it from inside.
    #[must_use]
    pub fn bristle_limit(&self) -> f64 {
        self.parameters.stiction * self.compliance
    }

    /// `dz/dt`, equation (1), rad/s.
    #[must_use]
    #[inline]
    pub fn rate(&self, z: f64, speed: f64) -> f64 {
        let (bristle, decay) = self.curve(speed.abs());
        decay * speed.abs() * (bristle.copysign(speed) - z)
    }

    /// `T_f`, equation (3), N·m.
    #[must_use]
    #[inline]
    pub fn torque(&self, z: f64, speed: f64) -> f64 {
        self.stiffness * z
            + self.parameters.damping * self.rate(z, speed)
            + self.parameters.viscous * speed
    }

    /// `σ0`, or 0 where the bristles carry nothing.
    #[inline]
    pub(crate) fn bristle_stiffness(&self) -> f64 {
        self.stiffness
    }

    /// `(G/σ0, σ0/G)` at a speed |ω|: the steady deflection in rad, and the
    /// relaxation per rad of sliding. Written with these two, equation (1)
    /// reads `dz/dt = |ω| σ0/G · (G/σ0 sign ω − z)`.
    #[inline(always)]
    pub(crate) fn curve(&self, speed: f64) -> (f64, f64) {
        if speed >= self.flat_above {
            (self.coulomb_bristle, self.coulomb_decay)
        } else {
            let level = self.falling_level(speed);
            (level * self.compliance, self.stiffness / level)
        }
    }

    #[inline(always)]
    fn falling_level(&self, speed: f64) -> f64 {
        let x = speed * self.per_stribeck_speed;
        let level = self.parameters.coulomb + self.rise * exp_minus(x * x);
        // T_C + (T_S − T_C) may round to above T_S. Written so that NaN stays.
        if level > self.parameters.stiction {
            self.parameters.stiction
        } else {
            level
        }
    }
}

/// The speed from which `T_C + (T_S − T_C) e^{−u}`, `u = (ω/Ω_S)²`, rounds
/// to `T_C`.
///
/// A positive addend is lost when it is below half the spacing of the numbers
/// above `T_C`, which is more than `2^{−54} T_C`. So it is lost from
/// `u = ln((T_S − T_C)/T_C) + 54 ln 2` on. The margin of 1e-6 pays for the
/// rounding of this function, of `u` (2 ulp of at most 750) and of the
/// exponential.
fn flat_above(p: &Parameters) -> f64 {
    let rise = p.stiction - p.coulomb;
    if rise <= 0.0 {
        return 0.0;
    }
    let u = libm::log(rise / p.coulomb) + 54.0 * core::f64::consts::LN_2 + 1e-6;
    if u <= 0.0 {
        0.0
    } else {
        p.stribeck_speed * libm::sqrt(u)
    }
}

impl TryFrom<Parameters> for LuGre {
    type Error = LugreError;

    fn try_from(parameters: Parameters) -> Result<Self, LugreError> {
        Self::new(parameters)
    }
}

impl From<LuGre> for Parameters {
    fn from(law: LuGre) -> Self {
        law.parameters
    }
}
