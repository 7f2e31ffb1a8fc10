//! The validated law: equations (1) to (4) of the crate page.

use crate::exponential::Exponential;
use crate::parameters::{LugreError, Parameters};

/// A validated friction law: immutable, 13 numbers (52 bytes in `f32`), free to
/// copy.
///
/// The bristle deflection `z` is the caller's, so that snapshots, several
/// contacts and Monte Carlo runs need nothing from this type. No method
/// fails or allocates; a NaN in gives a NaN out, of a law without friction too.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(try_from = "Parameters<T>", into = "Parameters<T>")
)]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: Exponential + serde::Serialize",
        deserialize = "T: Exponential + serde::Deserialize<'de>"
    ))
)]
pub struct LuGre<T = f64> {
    parameters: Parameters<T>,
    /// σ0 of the bristles; 0 if they carry nothing.
    stiffness: T,
    /// 1 / σ0, rad/(N·m).
    compliance: T,
    /// T_S − T_C, N·m.
    rise: T,
    /// 1 / Ω_S, s/rad.
    per_stribeck_speed: T,
    /// |ω| from which the level rounds to T_C, rad/s.
    flat_above: T,
    /// T_C / σ0, rad.
    coulomb_bristle: T,
    /// σ0 / T_C, 1/rad.
    coulomb_decay: T,
}

/// What a step computes with ([`LuGre::constants`]). Units are those of a rotary contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants<T = f64> {
    /// `T_C`, N·m.
    pub coulomb: T,
    /// `T_S`, N·m.
    pub stiction: T,
    /// `σ1`, N·m·s/rad.
    pub damping: T,
    /// `σ2`, N·m·s/rad.
    pub viscous: T,
    /// `σ0` of the bristles, N·m/rad; 0 if they carry nothing.
    pub stiffness: T,
    /// `1/σ0`, rad/(N·m); 0 if they carry nothing.
    pub compliance: T,
    /// `T_S − T_C`, N·m.
    pub rise: T,
    /// `1/Ω_S`, s/rad.
    pub per_stribeck_speed: T,
    /// [`LuGre::flat_above`], rad/s.
    pub flat_above: T,
    /// `T_C/σ0`, rad.
    pub coulomb_bristle: T,
    /// `σ0/T_C`, 1/rad; 0 if the bristles carry nothing.
    pub coulomb_decay: T,
}

impl<T: Exponential> LuGre<T> {
    /// Validates the parameters and prepares what the hot path needs.
    ///
    /// # Errors
    /// [`LugreError`] as by [`Parameters::validate`].
    pub fn new(parameters: Parameters<T>) -> Result<Self, LugreError> {
        parameters.validate()?;
        // Without any level the bristles carry nothing, in the limit
        // T_C → 0: z stays 0 and only σ2 ω is left.
        let null = parameters.stiction == T::ZERO;
        let stiffness = if null { T::ZERO } else { parameters.stiffness };
        let compliance = if null { T::ZERO } else { T::ONE / stiffness };
        Ok(Self {
            parameters,
            stiffness,
            compliance,
            rise: parameters.stiction - parameters.coulomb,
            per_stribeck_speed: T::ONE / parameters.stribeck_speed,
            flat_above: flat_above(&parameters),
            coulomb_bristle: parameters.coulomb * compliance,
            coulomb_decay: if null {
                T::ZERO
            } else {
                stiffness / parameters.coulomb
            },
        })
    }

    /// The parameters that the law was made from.
    #[must_use]
    pub fn parameters(&self) -> Parameters<T> {
        self.parameters
    }

    /// Every number that a step computes with, for code that is generated from a law: the
    /// six parameters' share in it, and what [`LuGre::new`] has made of them.
    #[must_use]
    pub fn constants(&self) -> Constants<T> {
        Constants {
            coulomb: self.parameters.coulomb,
            stiction: self.parameters.stiction,
            damping: self.parameters.damping,
            viscous: self.parameters.viscous,
            stiffness: self.stiffness,
            compliance: self.compliance,
            rise: self.rise,
            per_stribeck_speed: self.per_stribeck_speed,
            flat_above: self.flat_above,
            coulomb_bristle: self.coulomb_bristle,
            coulomb_decay: self.coulomb_decay,
        }
    }

    /// `G(ω)`, equation (2), N·m; between `T_C` and `T_S`.
    #[must_use]
    #[inline]
    pub fn level(&self, speed: T) -> T {
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
    pub fn flat_above(&self) -> T {
        self.flat_above
    }

    /// `T_ss(ω) = G(ω) sign ω + σ2 ω`, equation (4), N·m; 0 at rest.
    #[must_use]
    #[inline]
    pub fn steady_state(&self, speed: T) -> T {
        if speed == T::ZERO {
            return T::ZERO;
        }
        self.level(speed).copysign(speed) + self.parameters.viscous * speed
    }

    /// The deflection at constant speed, `z = G(ω) sign ω / σ0`, rad; 0 at
    /// rest, where every deflection within
    /// [`bristle_limit`](Self::bristle_limit) is steady.
    #[must_use]
    #[inline]
    pub fn steady_bristle(&self, speed: T) -> T {
        if speed == T::ZERO {
            return T::ZERO;
        }
        self.curve(speed.abs()).0.copysign(speed)
    }

    /// `T_S / σ0`, rad: no motion drives |z| beyond it from inside.
    #[must_use]
    pub fn bristle_limit(&self) -> T {
        self.parameters.stiction * self.compliance
    }

    /// Share of the Coulomb level that the bristles hold at the deflection `z`, from −1 to
    /// 1; 0 if they carry nothing.
    #[must_use]
    #[inline]
    pub fn coulomb_share(&self, z: T) -> T {
        if self.coulomb_bristle == T::ZERO {
            // Not 0 itself, so that NaN stays; ∞ · 0 would not be 0.
            return if z.is_nan() { z } else { T::ZERO };
        }
        // Comparisons, as `max` and `min` would hide NaN.
        let share = z / self.coulomb_bristle;
        if share.abs() > T::ONE {
            T::ONE.copysign(share)
        } else {
            share
        }
    }

    /// `dz/dt`, equation (1), rad/s.
    #[must_use]
    #[inline]
    pub fn rate(&self, z: T, speed: T) -> T {
        let (bristle, decay) = self.curve(speed.abs());
        decay * speed.abs() * (bristle.copysign(speed) - z)
    }

    /// `T_f`, equation (3), N·m.
    #[must_use]
    #[inline]
    pub fn torque(&self, z: T, speed: T) -> T {
        self.stiffness * z
            + self.parameters.damping * self.rate(z, speed)
            + self.parameters.viscous * speed
    }

    /// `σ0`, or 0 if the bristles carry nothing.
    #[inline]
    pub(crate) fn bristle_stiffness(&self) -> T {
        self.stiffness
    }

    /// `(G/σ0, σ0/G)` at a speed |ω|: the steady deflection in rad, and the
    /// relaxation per rad of sliding. Written with these two, equation (1)
    /// reads `dz/dt = |ω| σ0/G · (G/σ0 sign ω − z)`.
    #[inline(always)]
    pub(crate) fn curve(&self, speed: T) -> (T, T) {
        if speed >= self.flat_above {
            (self.coulomb_bristle, self.coulomb_decay)
        } else {
            let level = self.falling_level(speed);
            (level * self.compliance, self.stiffness / level)
        }
    }

    #[inline(always)]
    fn falling_level(&self, speed: T) -> T {
        let x = speed * self.per_stribeck_speed;
        let level = self.parameters.coulomb + self.rise * (x * x).exp_minus();
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
/// above `T_C`, which is more than `ε/4 T_C` (`2^{−54} T_C` in `f64`). So it is
/// lost from `u = ln((T_S − T_C)/T_C) + ln(4/ε)` on. [`Exponential::MARGIN`]
/// pays for the rounding of this function, of `u` and of the exponential.
fn flat_above<T: Exponential>(p: &Parameters<T>) -> T {
    let rise = p.stiction - p.coulomb;
    if rise <= T::ZERO {
        return T::ZERO;
    }
    let u = (rise / p.coulomb).ln() + T::LOST + T::MARGIN;
    if u <= T::ZERO {
        T::ZERO
    } else {
        p.stribeck_speed * u.sqrt()
    }
}

impl<T: Exponential> TryFrom<Parameters<T>> for LuGre<T> {
    type Error = LugreError;

    fn try_from(parameters: Parameters<T>) -> Result<Self, LugreError> {
        Self::new(parameters)
    }
}

impl<T> From<LuGre<T>> for Parameters<T> {
    fn from(law: LuGre<T>) -> Self {
        law.parameters
    }
}
