//! A machine with something hidden in it, and the motion that it is asked on.

use serde::{Deserialize, Serialize};

use crate::hidden::Exercise;

/// What kind of question a case asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CaseKind {
    /// Nothing hidden.
    Clean,
    /// One effect of the library.
    Single,
    /// Two.
    Pair,
    /// Three.
    Triple,
    /// One that is outside the library.
    Outside,
    /// One of the library, taken out of it before the search.
    LeftOut,
    /// One of the library, on motion too poor to tell it from others.
    Poor,
}

impl CaseKind {
    /// In file names and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Clean => "clean",
            Self::Single => "single",
            Self::Pair => "pair",
            Self::Triple => "triple",
            Self::Outside => "outside",
            Self::LeftOut => "left-out",
            Self::Poor => "poor",
        }
    }
}

/// A hidden effect: name and values in the order of its parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HiddenEffect {
    /// Name, in the library or in [`crate::hidden::OUTSIDE`].
    pub name: String,
    /// SI.
    pub values: Vec<f64>,
}

/// One machine with something hidden in it, and the motion that it is asked on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Name of the case.
    pub id: String,
    /// What kind.
    pub kind: CaseKind,
    /// What is hidden.
    pub hidden: Vec<HiddenEffect>,
    /// Motion.
    pub exercise: Exercise,
    /// Noise, as a multiple of that of good sensors ([`crate::hidden::Noise::good`]).
    pub noise: f64,
    /// Share by which known parameters may be off.
    pub known_off: f64,
    /// Effects that the search may not name.
    pub rejected: Vec<String>,
    /// Of noise and known parameters.
    pub seed: u64,
    /// Where there is one: sizes are scaled until the expected fall of D is so
    /// many times what naming takes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub visible: Option<f64>,
}

impl Case {
    /// Whether both are one case, sizes scaled or not yet.
    pub fn is_same(&self, other: &Self) -> bool {
        let unscaled = |case: &Self| {
            let mut case = case.clone();
            if case.visible.is_some() {
                case.hidden.iter_mut().for_each(|h| h.values.clear());
            }
            case
        };
        unscaled(self) == unscaled(other)
    }
}
