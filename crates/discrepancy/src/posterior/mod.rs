//! Names by probability: every explanation of what a model leaves competes by one number.
//!
//! | term | file |
//! |---|---|
//! | the logs, and where all is linear | [`base`] |
//! | prior odds | [`prior`] |
//! | what is uncertain of every machine | [`nuisance`] |
//! | laws outside the library | [`process`] |
//! | noise of a band | [`likelihood`] |
//! | evidence | [`evidence`] |
//! | hypotheses | [`hypotheses`] |
//! | the posterior, and what is named | [`answer`] |

mod answer;
mod base;
mod evidence;
mod hypotheses;
mod likelihood;
mod nuisance;
mod prior;
mod process;
mod products;
mod relinearised;

pub(crate) use self::answer::{Answer, answer};
pub use self::answer::{Explained, Posterior};
pub(crate) use self::base::{Base, friction_of, together};
pub(crate) use self::nuisance::onset_of;
