//! Friction at constant speed: what all laws of the family share.

use axis_scalar::Scalar;

use super::error::FrictionError;
use crate::exponential::Exponential;

/// Dry friction in one direction, N or N·m.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FrictionLevel<T = f64> {
    /// `F_C`, the level at high speed.
    pub coulomb: T,
    /// `F_S`, the level at vanishing speed (break-away); at least `F_C`.
    pub stiction: T,
}

/// Friction force or torque over a constant speed, the Stribeck curve:
///
/// ```text
/// g(v)    = F_C + (F_S − F_C) exp(−(|v|/v_S)^δ)
/// F_ss(v) = g(v) sign v + v (k₁ + k₂ |v| + k₃ v²)
/// ```
///
/// with F_C and F_S of the direction of `v`. δ = 2 is Canudas de Wit's et al. curve (1995,
/// doi 10.1109/9.376053, equation (4)), δ = 1 an exponential; other exponents after L. C. Bo
/// and D. Pavelescu, Wear 82(3), 1982, 277–289. The viscous part of higher order is odd.
///
/// # Units
/// N, m, m/s of a linear contact or N·m, rad, rad/s of a rotary one: no equation holds a
/// conversion.
///
/// ```
/// use lugre::{FrictionLevel, SteadyState};
///
/// let curve = SteadyState {
///     forward: FrictionLevel { coulomb: 60.0, stiction: 80.0 }, // N
///     backward: FrictionLevel { coulomb: 70.0, stiction: 85.0 },
///     stribeck_speed: 4e-3, // m/s
///     viscous: 200.0,       // N·s/m
///     ..SteadyState::coulomb(60.0)
/// };
/// curve.validate()?;
/// assert_eq!(curve.force(1.0), 260.0);
/// assert_eq!(curve.force(-1.0), -270.0);
/// # Ok::<(), lugre::FrictionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct SteadyState<T = f64> {
    /// Levels at positive speed.
    pub forward: FrictionLevel<T>,
    /// Levels at negative speed, as positive numbers.
    pub backward: FrictionLevel<T>,
    /// `v_S`, the Stribeck speed, at which 37 % of `F_S − F_C` is left, m/s or rad/s.
    pub stribeck_speed: T,
    /// `δ`, the exponent, 0.1 to 10.
    pub stribeck_exponent: T,
    /// `k₁`, N·s/m or N·m·s/rad.
    pub viscous: T,
    /// `k₂`, N·s²/m² or N·m·s²/rad².
    pub viscous_quadratic: T,
    /// `k₃`, N·s³/m³ or N·m·s³/rad³.
    pub viscous_cubic: T,
}

impl<T: Scalar> SteadyState<T> {
    /// The same Coulomb level in both directions, and nothing else: for the fields that a
    /// curve does not need.
    #[must_use]
    pub fn coulomb(level: T) -> Self {
        let level = FrictionLevel {
            coulomb: level,
            stiction: level,
        };
        Self {
            forward: level,
            backward: level,
            stribeck_speed: T::ONE,
            stribeck_exponent: T::TWO,
            viscous: T::ZERO,
            viscous_quadratic: T::ZERO,
            viscous_cubic: T::ZERO,
        }
    }

    /// The same numbers in another scalar, each rounded to the nearest.
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> SteadyState<U> {
        let cast = |value: T| U::of(value.to_f64());
        let level = |level: FrictionLevel<T>| FrictionLevel {
            coulomb: cast(level.coulomb),
            stiction: cast(level.stiction),
        };
        SteadyState {
            forward: level(self.forward),
            backward: level(self.backward),
            stribeck_speed: cast(self.stribeck_speed),
            stribeck_exponent: cast(self.stribeck_exponent),
            viscous: cast(self.viscous),
            viscous_quadratic: cast(self.viscous_quadratic),
            viscous_cubic: cast(self.viscous_cubic),
        }
    }

    /// Checks every field. Levels may be 0; a Coulomb level of 0 only with a break-away level
    /// of 0 in the same direction.
    ///
    /// # Errors
    /// [`FrictionError`] names the first field that is not acceptable.
    pub fn validate(&self) -> Result<(), FrictionError> {
        const NOT_NEGATIVE: &str = "finite and at least 0";
        const LEVEL: &str = "finite and greater than 0 (or 0 together with `stiction`)";
        for (level, names, direction) in [
            (
                self.forward,
                ["forward.coulomb", "forward.stiction"],
                "forward",
            ),
            (
                self.backward,
                ["backward.coulomb", "backward.stiction"],
                "backward",
            ),
        ] {
            let null = level.coulomb == T::ZERO && level.stiction == T::ZERO;
            check(names[0], level.coulomb, LEVEL, null)?;
            check(names[1], level.stiction, NOT_NEGATIVE, true)?;
            if level.stiction < level.coulomb {
                return Err(FrictionError::StictionBelowCoulomb {
                    direction,
                    stiction: level.stiction.to_f64(),
                    coulomb: level.coulomb.to_f64(),
                });
            }
        }
        const POSITIVE: &str = "finite and greater than 0";
        check("stribeck_speed", self.stribeck_speed, POSITIVE, false)?;
        let exponents = [T::of(0.1), T::of(10.0)];
        check_range(
            "stribeck_exponent",
            self.stribeck_exponent,
            "between 0.1 and 10",
            exponents,
        )?;
        check("viscous", self.viscous, NOT_NEGATIVE, true)?;
        check(
            "viscous_quadratic",
            self.viscous_quadratic,
            NOT_NEGATIVE,
            true,
        )?;
        check("viscous_cubic", self.viscous_cubic, NOT_NEGATIVE, true)
    }

    /// Whether the dry friction is the same at all speeds of a direction.
    #[must_use]
    pub fn is_level(&self) -> bool {
        self.forward.coulomb == self.forward.stiction
            && self.backward.coulomb == self.backward.stiction
    }

    /// The levels of the direction of `speed`; forward at 0.
    #[inline]
    pub(super) fn of_direction(&self, speed: T) -> FrictionLevel<T> {
        if speed < T::ZERO {
            self.backward
        } else {
            self.forward
        }
    }

    /// `v (k₁ + k₂ |v| + k₃ v²)`, N or N·m.
    #[must_use]
    #[inline]
    pub fn viscous_force(&self, speed: T) -> T {
        let size = speed.abs();
        speed * (self.viscous + size * (self.viscous_quadratic + size * self.viscous_cubic))
    }
}

impl<T: Exponential> SteadyState<T> {
    /// `g(v)`, N or N·m; between `F_C` and `F_S` of the direction.
    #[must_use]
    #[inline]
    pub fn level(&self, speed: T) -> T {
        let FrictionLevel { coulomb, stiction } = self.of_direction(speed);
        let u = power(speed.abs() / self.stribeck_speed, self.stribeck_exponent);
        let level = coulomb + (stiction - coulomb) * u.exp_minus();
        // May round to above F_S. Written so that NaN stays.
        if level > stiction { stiction } else { level }
    }

    /// `F_ss(v)`, N or N·m; 0 at rest.
    #[must_use]
    pub fn force(&self, speed: T) -> T {
        if speed == T::ZERO {
            return T::ZERO;
        }
        self.level(speed).copysign(speed) + self.viscous_force(speed)
    }
}

/// `x^n` of `x ≥ 0`, `n > 0`; NaN for NaN.
#[inline]
pub(super) fn power<T: Scalar>(x: T, n: T) -> T {
    if n == T::TWO {
        x * x
    } else if n == T::ONE || x == T::ZERO {
        x
    } else {
        (n * x.ln()).exp()
    }
}

/// Refuses what is not finite and positive, or 0 where that is allowed. Subnormal numbers are
/// refused: their reciprocals overflow.
pub(super) fn check<T: Scalar>(
    field: &'static str,
    value: T,
    valid: &'static str,
    zero_allowed: bool,
) -> Result<(), FrictionError> {
    let positive = value >= T::MIN_POSITIVE && value.is_finite();
    if positive || (zero_allowed && value == T::ZERO) {
        return Ok(());
    }
    Err(FrictionError::Invalid {
        field,
        value: value.to_f64(),
        valid,
    })
}

/// Refuses what does not lie in a closed range.
pub(super) fn check_range<T: Scalar>(
    field: &'static str,
    value: T,
    valid: &'static str,
    [least, greatest]: [T; 2],
) -> Result<(), FrictionError> {
    if value >= least && value <= greatest {
        return Ok(());
    }
    Err(FrictionError::Invalid {
        field,
        value: value.to_f64(),
        valid,
    })
}
