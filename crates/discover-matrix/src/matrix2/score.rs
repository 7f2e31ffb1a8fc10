//! Counting: targets and groups, a line each.

use super::outcome::CaseOutcome;
use crate::matrix::{CaseKind, Rate, covered};

/// Cases below which nothing is decided: Wilson's interval of one or two is too narrow near
/// 0 and 1.
const FEW: usize = 10;

/// What is asked of a rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// At most this share.
    Most(f64),
    /// At least this share.
    Least(f64),
    /// Between these.
    Within(f64, f64),
    /// Nothing: it is told to be known.
    Told,
}

impl Limit {
    /// In tables.
    pub fn words(self) -> String {
        match self {
            Self::Most(most) => format!("≤ {:.0} %", 100.0 * most),
            Self::Least(least) => format!("≥ {:.0} %", 100.0 * least),
            Self::Within(low, high) => format!("{:.0} to {:.0} %", 100.0 * low, 100.0 * high),
            Self::Told => String::new(),
        }
    }

    /// What a rate with its 95 % interval says of it.
    pub fn met(self, rate: &Rate) -> &'static str {
        match rate.of {
            _ if self == Self::Told => return "",
            0 => return "not asked",
            1..FEW => return "open",
            _ => {}
        }
        let [low, high] = rate.interval();
        let (inside, outside) = match self {
            Self::Most(most) => (high <= most, low > most),
            Self::Least(least) => (low >= least, high < least),
            Self::Within(least, most) => (low >= least && high <= most, high < least || low > most),
            Self::Told => (false, false),
        };
        match (inside, outside) {
            (true, _) => "met",
            (_, true) => "missed",
            _ => "open",
        }
    }

    /// Whether a case's own share counts against it.
    fn is_hurt(self, rate: &Rate) -> bool {
        match self {
            Self::Most(_) => rate.hits > 0,
            Self::Least(_) | Self::Within(..) => rate.hits < rate.of,
            Self::Told => false,
        }
    }
}

/// A figure of the matrix.
#[derive(Clone, Copy)]
pub struct ScoreTarget {
    /// In tables.
    pub name: &'static str,
    /// What is asked of it.
    pub limit: Limit,
    /// What a case counts for.
    count: fn(&CaseOutcome) -> Rate,
}

impl ScoreTarget {
    /// Over these outcomes.
    pub fn rate<'a>(&self, outcomes: impl IntoIterator<Item = &'a CaseOutcome>) -> Rate {
        let of = outcomes.into_iter().map(self.count);
        of.fold(Rate::default(), Rate::and)
    }

    /// Whether a case counts against it.
    pub fn is_hurt_by(&self, outcome: &CaseOutcome) -> bool {
        self.limit.is_hurt(&(self.count)(outcome))
    }
}

const fn target(name: &'static str, limit: Limit, count: fn(&CaseOutcome) -> Rate) -> ScoreTarget {
    ScoreTarget { name, limit, count }
}

fn is(o: &CaseOutcome, kind: CaseKind) -> bool {
    o.case.kind == kind && o.failed.is_none()
}

/// Laws outside the library that can be seen and that it cannot imitate.
fn is_law(o: &CaseOutcome) -> bool {
    is(o, CaseKind::Outside) && o.is_seen() && !o.is_imitated()
}

/// Effects taken out of it, likewise.
fn is_taken_out(o: &CaseOutcome) -> bool {
    is(o, CaseKind::LeftOut) && o.is_seen() && !o.is_imitated()
}

/// All figures; those with a limit first.
#[rustfmt::skip]
pub const TARGETS: &[ScoreTarget] = &[
    target("clean machines: false alarms", Limit::Most(0.01),
        |o| Rate::one(is(o, CaseKind::Clean), o.is_false_alarm())),
    target("all cases: a wrong name", Limit::Most(0.02),
        |o| Rate::one(o.failed.is_none(), !o.wrong_names().is_empty())),
    target("one hidden, seen and distinguishable: named first", Limit::Least(0.95),
        |o| Rate::one(is(o, CaseKind::Single) && o.is_seen() && o.is_told_apart(), o.is_first())),
    target("law outside the library, seen, not imitated: unknown, right variable", Limit::Least(0.8),
        |o| Rate::one(is_law(o), o.is_unknown_of_right_variable())),
    target("95 % intervals that hold the truth", Limit::Within(0.92, 0.98),
        |o| covered(&o.estimates.iter().filter(|_| o.is_of_library()).collect::<Vec<_>>())),
    target("cases in which the library does not imitate what it lacks: a wrong name", Limit::Told,
        |o| Rate::one(o.failed.is_none() && !o.is_imitated(), !o.wrong_names().is_empty())),
    target("all cases: a wrong name, and the truth explains the fitted logs better", Limit::Told,
        |o| Rate::one(o.failed.is_none(), !o.wrong_names().is_empty() && o.is_truth_better())),
    target("one hidden: seen", Limit::Told,
        |o| Rate::one(is(o, CaseKind::Single), o.is_seen())),
    target("of these, distinguishable", Limit::Told,
        |o| Rate::one(is(o, CaseKind::Single) && o.is_seen(), o.is_told_apart())),
    target("one hidden, seen: named first", Limit::Told,
        |o| Rate::one(is(o, CaseKind::Single) && o.is_seen(), o.is_first())),
    target("two hidden, seen and distinguishable: both named", Limit::Told,
        |o| Rate::one(is(o, CaseKind::Pair) && o.is_seen() && o.is_told_apart(), o.are_all_named())),
    target("law, seen: imitated by the library", Limit::Told,
        |o| Rate::one(is(o, CaseKind::Outside) && o.is_seen(), o.is_imitated())),
    target("law, seen, not imitated: right variable, whatever the verdict", Limit::Told,
        |o| Rate::one(is_law(o), o.has_right_variable())),
    target("law, seen, not imitated: no wrong name", Limit::Told,
        |o| Rate::one(is_law(o), o.wrong_names().is_empty())),
    target("taken out of the library, seen, not imitated: unknown, right variable", Limit::Told,
        |o| Rate::one(is_taken_out(o), o.is_unknown_of_right_variable())),
    target("proposed experiments, run, whole library: the class is split", Limit::Told,
        |o| Rate::one(o.split.is_some(), o.split.as_ref().is_some_and(|s| s.succeeded()))),
    target("cases that could not be run", Limit::Told,
        |o| Rate::one(true, o.failed.is_some())),
];

/// A way to look at the outcomes apart.
#[derive(Clone, Copy)]
pub struct Group {
    /// What it is by.
    pub name: &'static str,
    /// Which part a case is in.
    pub of: fn(&CaseOutcome) -> String,
}

/// All of them.
#[rustfmt::skip]
pub const GROUPS: &[Group] = &[
    Group { name: "machine", of: |o| o.case.setting.machine.clone() },
    Group { name: "noise", of: |o| o.case.noise.name().to_owned() },
    Group { name: "tolerance", of: |o| format!("{:2.0} %", 100.0 * o.case.setting.tolerance) },
    Group { name: "channels", of: |o| o.case.setting.channels.name().to_owned() },
    Group { name: "form of the truth", of: |o| o.case.form.name().to_owned() },
    Group { name: "start", of: |o| match o.case.wound {
        0.0 => "relaxed".to_owned(),
        _ => "bristles deflected".to_owned(),
    } },
    Group { name: "motion", of: |o| o.case.setting.exercise.name().to_owned() },
];
