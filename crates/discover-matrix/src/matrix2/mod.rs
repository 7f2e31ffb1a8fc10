//! A matrix as hard as reality: several machines, laws of another form than the model's,
//! noise that is coloured, quantised or in the logger, logs with few channels, known
//! parameters off by up to a fifth, and laws outside the library drawn from a grammar.
//!
//! [`cases`] lays out a split plot; a [`Bench`] holds what is the same for all cases of a
//! plot; [`Bench::try_case`] makes a case's logs, searches them blind and keeps what was
//! hidden beside what was said. [`TARGETS`] count, each over all cases and by each of
//! [`GROUPS`].
//!
//! Nothing that was named is excused by the verdict: a name of an effect that is not there
//! is wrong ([`CaseOutcome::wrong_names`]).

mod bench;
mod case;
mod design;
mod outcome;
mod peers;
mod score;
mod scored;
mod sight;
mod trial;

pub use bench::Bench;
pub use case::{Case, CaseSetting, Channels, TOLERANCES, VERSION, VISIBLE};
pub use design::{MatrixPlan, cases};
pub use outcome::{CaseOutcome, Deviance};
pub use peers::{IN_TERMS, Reach, peer_cases};
pub use score::{GROUPS, Group, Limit, ScoreTarget, TARGETS};
pub use trial::Given;
