//! Strategies by their names on the command line.

use std::sync::LazyLock;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use pipeline::strategies::{NONE, STRATEGIES, StrategyKind};

/// The strategies by their names on the command line.
static NAMES: LazyLock<Vec<(String, &StrategyKind)>> = LazyLock::new(|| {
    let all = [&NONE].into_iter().chain(STRATEGIES.iter().copied());
    all.map(|kind| (kind.name.replace('_', "-"), kind))
        .collect()
});

/// Reads the name of a strategy.
pub fn strategy_name() -> impl TypedValueParser<Value = &'static StrategyKind> {
    let value = |(name, kind): &'static (String, &StrategyKind)| {
        PossibleValue::new(name.as_str()).help(kind.summary)
    };
    PossibleValuesParser::new(NAMES.iter().map(value)).try_map(|given| {
        let mut all = NAMES.iter();
        let found = all.find(|(name, _)| *name == given);
        found
            .map(|(_, kind)| *kind)
            .ok_or_else(|| format!("there is no strategy {given}"))
    })
}
