//! One line of the check.

use axis_rating::{Bound, Rating};

/// What is known of an item.
#[derive(Clone, Debug, PartialEq)]
pub enum ItemState {
    /// Value and limit.
    Rated(Rating),
    /// Not all that it takes.
    NotKnown {
        /// The value, if that much is known.
        value: Option<f64>,
        /// Its unit; empty if there is none.
        unit: &'static str,
        /// Keys that would make it known, each with a unit that it may have: of `[rating]`, or with their table.
        keys: Vec<String>,
    },
}

/// What becomes of an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ItemVerdict {
    /// The limit is kept.
    Ok,
    /// It is not.
    Over,
    /// The axis file does not say enough.
    NotKnown,
}

/// One item of the check of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckedItem {
    /// Its name in results: `motor_rms_torque`.
    pub name: &'static str,
    /// What it is, in words.
    pub title: &'static str,
    /// Value, limit, or what is missing.
    pub state: ItemState,
}

impl CheckedItem {
    pub(super) fn rated(name: &'static str, title: &'static str, rating: Rating) -> Self {
        let state = ItemState::Rated(rating);
        Self { name, title, state }
    }

    /// Of `[rating]`'s keys.
    pub(super) fn missing(
        name: &'static str,
        title: &'static str,
        known: Option<(f64, &'static str)>,
        keys: &[&str],
    ) -> Self {
        let (value, unit) = known.map_or((None, ""), |(value, unit)| (Some(value), unit));
        let keys = keys.iter().map(|key| (*key).to_owned()).collect();
        let state = ItemState::NotKnown { value, unit, keys };
        Self { name, title, state }
    }

    /// Its verdict.
    pub fn verdict(&self) -> ItemVerdict {
        match &self.state {
            ItemState::Rated(rating) if rating.holds() => ItemVerdict::Ok,
            ItemState::Rated(_) => ItemVerdict::Over,
            ItemState::NotKnown { .. } => ItemVerdict::NotKnown,
        }
    }

    /// The rating, if it is known.
    pub fn rating(&self) -> Option<&Rating> {
        match &self.state {
            ItemState::Rated(rating) => Some(rating),
            ItemState::NotKnown { .. } => None,
        }
    }

    /// Whether the value must be at least the limit.
    pub fn is_at_least(&self) -> bool {
        self.rating().is_some_and(|r| r.bound == Bound::AtLeast)
    }
}

impl ItemVerdict {
    /// In a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Over => "over",
            Self::NotKnown => "not known",
        }
    }
}
