//! What channels seem to be, by the names of the NC.

use super::super::ProposedColumn;
use crate::table::Head;

/// Variables of an axis, in small letters
/// ([NCTOPLC_AXIS_REF](https://infosys.beckhoff.com/content/1033/tcplclib_tc2_mc2/70133899.html)),
/// what they are, and their unit on a linear axis in mm.
const VARIABLES: &[(&str, &str, &str)] = &[
    ("setpos", "position_ref_m", "mm"),
    ("actpos", "position_m", "mm"),
    ("setvelo", "velocity_ref_m_s", "mm/s"),
    ("actvelo", "velocity_m_s", "mm/s"),
];

/// Variables beside those that have their name in them: `ModuloActPos`,
/// `ActPosWithoutPosCorrection`.
const NOT_BEHIND: &str = "modulo";
const NOT_BEFORE: &str = "without";

/// Those of the first axis that has one: two axes would be one channel.
pub(super) fn proposed(heads: &[&Head]) -> Vec<ProposedColumn> {
    let any = |head: &&Head| VARIABLES.iter().find_map(|(name, ..)| axis(head, name));
    let Some(first) = heads.iter().find_map(any) else {
        return Vec::new();
    };
    let one = |(name, channel, unit): &(&str, &'static str, &'static str)| {
        let mut heads = heads.iter();
        let head = heads.find(|head| axis(head, name).as_ref() == Some(&first))?;
        Some(ProposedColumn {
            source: head.name.clone(),
            channel,
            unit,
        })
    };
    VARIABLES.iter().filter_map(one).collect()
}

/// What stands before and behind the variable's name, where the channel has it; that is the
/// same for all variables of an axis.
fn axis(head: &Head, variable: &str) -> Option<[String; 2]> {
    let within = |name: &str| {
        let name = name.to_ascii_lowercase();
        let (before, behind) = name.split_once(variable)?;
        let is_it = !before.ends_with(NOT_BEHIND) && !behind.starts_with(NOT_BEFORE);
        is_it.then(|| [before.to_owned(), behind.to_owned()])
    };
    let address = head.address.as_deref().and_then(within);
    address.or_else(|| within(&head.name))
}
