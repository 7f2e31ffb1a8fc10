//! The numbers of a law of the family, as a fit moves them.

use crate::family::{
    BoucWenOnset, Bristle, BristleParameters, DahlOnset, ElastoPlasticOnset, FrictionLaw,
    FrictionLevel, LinearOnset, MaxwellSlip, MaxwellSlipParameters, Onset, StaticFriction,
    StaticFrictionParameters, SteadyState,
};

/// What of a law is unknown besides its level and stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UnknownNumbers {
    /// Levels of each direction for itself; otherwise those forward are those backward.
    pub directions: bool,
    /// Break-away level and Stribeck speed; of [`MaxwellSlip`] the attraction too.
    pub stribeck: bool,
    /// The exponent of the Stribeck curve.
    pub stribeck_exponent: bool,
    /// How many terms of the viscous friction, linear, quadratic, cubic: 0 to 3.
    pub viscous_terms: usize,
    /// Damping of the bristle.
    pub damping: bool,
    /// Numbers of the onset: exponents and shares.
    pub shape: bool,
    /// A force that does not change with the direction (sensor offset, gravity).
    pub offset: bool,
}

impl Default for UnknownNumbers {
    /// Stribeck curve, linear viscous friction and shape; the rest known.
    fn default() -> Self {
        Self {
            directions: false,
            stribeck: true,
            stribeck_exponent: false,
            viscous_terms: 1,
            damping: false,
            shape: true,
            offset: false,
        }
    }
}

/// How a number enters a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NumberKind {
    /// By its logarithm.
    Positive,
    /// As what it exceeds the number before by, over that one; not negative.
    Above,
    /// As it is, over a typical size, and not below a bound.
    AtLeast {
        /// The bound.
        least: f64,
        /// The typical size.
        size: f64,
    },
}

/// A number of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number {
    /// As the parameters call it.
    pub name: &'static str,
    /// Which of several of that name; 0 of one.
    pub element: usize,
    /// Its value.
    pub value: f64,
    /// How it enters.
    pub kind: NumberKind,
    /// Whether it is fitted.
    pub free: bool,
}

impl Number {
    /// As a coordinate, `before` the value of the number before.
    pub(super) fn coordinate(&self, before: f64) -> f64 {
        match self.kind {
            NumberKind::Positive => self.value.ln(),
            NumberKind::Above => self.value / before - 1.0,
            NumberKind::AtLeast { size, .. } => self.value / size,
        }
    }

    /// The value of a coordinate.
    pub(super) fn at(&self, coordinate: f64, before: f64) -> f64 {
        match self.kind {
            NumberKind::Positive => coordinate.exp(),
            NumberKind::Above => before * (1.0 + coordinate.max(0.0)),
            NumberKind::AtLeast { least, size } => (coordinate * size).max(least),
        }
    }

    /// The least coordinate.
    pub(super) fn lower(&self) -> f64 {
        match self.kind {
            NumberKind::Positive => f64::NEG_INFINITY,
            NumberKind::Above => 0.0,
            NumberKind::AtLeast { least, size } => least / size,
        }
    }
}

/// A law of the family that [`identify_law`](super::identify_law) can fit.
pub trait Identifiable: FrictionLaw<f64> + Sized {
    /// All numbers of the law; those of the backward direction are not free where the
    /// directions are alike. `fastest` is the greatest speed of the records, m/s or rad/s.
    #[must_use]
    fn numbers(&self, unknown: &UnknownNumbers, fastest: f64) -> Vec<Number>;

    /// The law with other values, in the order of [`numbers`](Self::numbers); `None` if they
    /// make none.
    #[must_use]
    fn with(&self, unknown: &UnknownNumbers, values: &[f64]) -> Option<Self>;
}

/// Numbers of a Stribeck curve.
const CURVE: usize = 9;

fn of_curve(steady: &SteadyState, unknown: &UnknownNumbers, fastest: f64) -> Vec<Number> {
    let number = |name, value, kind, free| Number {
        name,
        element: 0,
        value,
        kind,
        free,
    };
    let level = steady.forward.coulomb;
    let viscous = |name, value, term: usize| {
        let kind = NumberKind::AtLeast {
            least: 0.0,
            size: level / fastest.powi(term as i32),
        };
        number(name, value, kind, unknown.viscous_terms >= term)
    };
    let (directions, stribeck) = (unknown.directions, unknown.stribeck);
    let (forward, backward) = (steady.forward, steady.backward);
    vec![
        number("forward.coulomb", level, NumberKind::Positive, true),
        number(
            "forward.stiction",
            forward.stiction,
            NumberKind::Above,
            stribeck,
        ),
        number(
            "backward.coulomb",
            backward.coulomb,
            NumberKind::Positive,
            directions,
        ),
        number(
            "backward.stiction",
            backward.stiction,
            NumberKind::Above,
            directions && stribeck,
        ),
        number(
            "stribeck_speed",
            steady.stribeck_speed,
            NumberKind::Positive,
            stribeck,
        ),
        number(
            "stribeck_exponent",
            steady.stribeck_exponent,
            NumberKind::Positive,
            unknown.stribeck_exponent,
        ),
        viscous("viscous", steady.viscous, 1),
        viscous("viscous_quadratic", steady.viscous_quadratic, 2),
        viscous("viscous_cubic", steady.viscous_cubic, 3),
    ]
}

fn curve_of(values: &[f64], unknown: &UnknownNumbers) -> Option<SteadyState> {
    let &[
        fc,
        fs,
        bc,
        bs,
        stribeck_speed,
        stribeck_exponent,
        k1,
        k2,
        k3,
    ] = values.first_chunk::<CURVE>()?;
    let level = |coulomb, stiction| FrictionLevel { coulomb, stiction };
    let forward = level(fc, fs);
    Some(SteadyState {
        forward,
        backward: if unknown.directions {
            level(bc, bs)
        } else {
            forward
        },
        stribeck_speed,
        stribeck_exponent,
        viscous: k1,
        viscous_quadratic: k2,
        viscous_cubic: k3,
    })
}

fn positive(name: &'static str, element: usize, value: f64, free: bool) -> Number {
    Number {
        name,
        element,
        value,
        kind: NumberKind::Positive,
        free,
    }
}

/// The numbers of an onset.
pub trait IdentifiableOnset: Onset<f64> {
    /// Name, value and least value of each.
    #[must_use]
    fn shape(&self) -> Vec<(&'static str, f64, f64)>;

    /// The onset with other values, each not above its greatest.
    #[must_use]
    fn reshaped(&self, values: &[f64]) -> Option<Self>;
}

impl IdentifiableOnset for LinearOnset {
    fn shape(&self) -> Vec<(&'static str, f64, f64)> {
        Vec::new()
    }

    fn reshaped(&self, _: &[f64]) -> Option<Self> {
        Some(*self)
    }
}

impl IdentifiableOnset for DahlOnset {
    fn shape(&self) -> Vec<(&'static str, f64, f64)> {
        vec![("exponent", self.exponent, 0.0)]
    }

    fn reshaped(&self, values: &[f64]) -> Option<Self> {
        let exponent = values.first()?.min(10.0);
        Some(Self { exponent })
    }
}

impl IdentifiableOnset for ElastoPlasticOnset {
    fn shape(&self) -> Vec<(&'static str, f64, f64)> {
        vec![("elastic_share", self.elastic_share, 0.0)]
    }

    fn reshaped(&self, values: &[f64]) -> Option<Self> {
        let elastic_share = values.first()?.min(0.99);
        Some(Self { elastic_share })
    }
}

impl IdentifiableOnset for BoucWenOnset {
    fn shape(&self) -> Vec<(&'static str, f64, f64)> {
        vec![
            ("exponent", self.exponent, 1.0),
            ("loading_share", self.loading_share, 0.5),
        ]
    }

    fn reshaped(&self, values: &[f64]) -> Option<Self> {
        Some(Self {
            exponent: values.first()?.min(16.0),
            loading_share: values.get(1)?.min(10.0),
        })
    }
}

impl<O: IdentifiableOnset> Identifiable for Bristle<f64, O> {
    fn numbers(&self, unknown: &UnknownNumbers, fastest: f64) -> Vec<Number> {
        let p = self.parameters();
        let mut numbers = of_curve(&p.steady, unknown, fastest);
        numbers.push(positive("stiffness", 0, p.stiffness, true));
        numbers.push(Number {
            name: "damping",
            element: 0,
            value: p.damping,
            kind: NumberKind::AtLeast {
                least: 0.0,
                size: p.steady.forward.coulomb / fastest,
            },
            free: unknown.damping,
        });
        numbers.extend(
            p.onset
                .shape()
                .into_iter()
                .map(|(name, value, least)| Number {
                    name,
                    element: 0,
                    value,
                    kind: NumberKind::AtLeast { least, size: 1.0 },
                    free: unknown.shape,
                }),
        );
        numbers
    }

    fn with(&self, unknown: &UnknownNumbers, values: &[f64]) -> Option<Self> {
        let steady = curve_of(values, unknown)?;
        let [stiffness, damping] = *values.get(CURVE..)?.first_chunk()?;
        let onset = self.parameters().onset.reshaped(&values[CURVE + 2..])?;
        Self::new(BristleParameters {
            steady,
            stiffness,
            damping,
            onset,
        })
        .ok()
    }
}

impl<const N: usize> Identifiable for MaxwellSlip<f64, N> {
    /// The last share is what the others leave.
    fn numbers(&self, unknown: &UnknownNumbers, fastest: f64) -> Vec<Number> {
        let p = self.parameters();
        let mut numbers = of_curve(&p.steady, unknown, fastest);
        for (i, share) in p.shares.into_iter().enumerate() {
            let free = unknown.shape && i + 1 < N;
            numbers.push(positive("shares", i, share, free));
        }
        for (i, stiffness) in p.stiffness.into_iter().enumerate() {
            numbers.push(positive("stiffness", i, stiffness, true));
        }
        numbers.push(positive("attraction", 0, p.attraction, unknown.stribeck));
        numbers
    }

    fn with(&self, unknown: &UnknownNumbers, values: &[f64]) -> Option<Self> {
        let steady = curve_of(values, unknown)?;
        let rest = values.get(CURVE..)?;
        let shares: [f64; N] = *rest.first_chunk()?;
        let stiffness: [f64; N] = *rest.get(N..)?.first_chunk()?;
        let sum: f64 = shares.iter().sum();
        Self::new(MaxwellSlipParameters {
            steady,
            shares: shares.map(|share| share / sum),
            stiffness,
            attraction: *rest.get(2 * N)?,
        })
        .ok()
    }
}

impl Identifiable for StaticFriction {
    fn numbers(&self, unknown: &UnknownNumbers, fastest: f64) -> Vec<Number> {
        let p = self.parameters();
        let mut numbers = of_curve(&p.steady, unknown, fastest);
        let speed = p.transition_speed;
        numbers.push(positive("transition_speed", 0, speed, unknown.shape));
        numbers
    }

    fn with(&self, unknown: &UnknownNumbers, values: &[f64]) -> Option<Self> {
        Self::new(StaticFrictionParameters {
            steady: curve_of(values, unknown)?,
            transition_speed: *values.get(CURVE)?,
            ..self.parameters()
        })
        .ok()
    }
}
