//! Screening: how much of a residual each effect of the library explains, and each
//! pair, and how near some together come to it.

mod imitation;
mod response;
mod screened;
mod screening;

pub use self::imitation::imitate;
pub use self::response::mostly_same;
pub use self::screened::Screened;
pub use self::screening::Screening;
