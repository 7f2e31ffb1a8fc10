//! What channels seem to be, by the names of the NC.

use super::super::{Found, by_name};
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

/// Of each axis, in the order of its variables.
pub(super) fn proposed(heads: &[&Head]) -> Vec<Found> {
    let one = |head: &&Head| {
        let mut variables = VARIABLES.iter().enumerate();
        variables.find_map(|(place, (name, channel, unit))| {
            let axis = axis(head, name)?.concat();
            let axis = axis.trim_matches(['.', '_', ' ']);
            Some((place, Found::of(axis, head, channel, unit)))
        })
    };
    let all: Vec<(usize, Found)> = heads.iter().filter_map(one).collect();
    if all.is_empty() {
        // Names that a user gave; those with a variable's name in them are the others beside it.
        let is_free = |head: &&&Head| {
            let name = head.name.to_ascii_lowercase();
            !VARIABLES
                .iter()
                .any(|(variable, ..)| name.contains(variable))
        };
        let named = heads.iter().filter(is_free);
        return named.filter_map(|head| by_name::motion(head)).collect();
    }
    let first = |axis: &str| all.iter().position(|(_, found)| found.axis == axis);
    let mut sorted: Vec<&(usize, Found)> = all.iter().collect();
    sorted.sort_by_key(|(place, found)| (first(&found.axis), *place));
    sorted.into_iter().map(|(_, found)| found.clone()).collect()
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
