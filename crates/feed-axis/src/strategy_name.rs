//! Strategies by their names on the command line.

use std::sync::LazyLock;

use axis_pipeline::strategies::{NONE, STRATEGIES, StrategyKind};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

/// The strategies by their names on the command line.
static NAMES: LazyLock<Vec<(String, &StrategyKind)>> = LazyLock::new(|| {
    let all = [&NONE].into_iter().chain(STRATEGIES.iter().copied());
    all.map(|kind| (kind.name.replace('_', "-"), kind))
        .collect()
});

/// Reads the name of a strategy.
pub fn strategy_name() -> impl TypedValueParser<Value = &'static StrategyKind> {
    strategy_name_shown(None)
}

/// Reads the name of a strategy; help shows those of `names` alone, so that the command can
/// refuse each other one with its reason.
pub fn strategy_name_of(
    names: &'static [&'static str],
) -> impl TypedValueParser<Value = &'static StrategyKind> {
    strategy_name_shown(Some(names))
}

fn strategy_name_shown(
    names: Option<&'static [&'static str]>,
) -> impl TypedValueParser<Value = &'static StrategyKind> {
    let value = |(name, kind): &'static (String, &StrategyKind)| {
        let hidden = names.is_some_and(|names| !names.contains(&kind.name));
        let value = PossibleValue::new(name.as_str()).help(kind.summary);
        value.hide(hidden)
    };
    PossibleValuesParser::new(NAMES.iter().map(value)).try_map(|given| {
        let mut all = NAMES.iter();
        let found = all.find(|(name, _)| *name == given);
        found
            .map(|(_, kind)| *kind)
            .ok_or_else(|| format!("there is no strategy {given}"))
    })
}
