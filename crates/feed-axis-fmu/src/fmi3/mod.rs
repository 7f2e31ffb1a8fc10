//! The 75 functions of `fmi3Functions.h`.

mod absent;
mod lifecycle;
mod states;
mod values;

/// `fmi3Boolean`, C's `bool`: a byte, so that a wrong one is no undefined value.
type Bool = u8;
