//! By what a library of units is known to be of this version.

/// What the library of this version holds in its data, and another one does not.
pub const LIBRARY_MARK: &str = concat!(
    "library of feed-axis units, version ",
    env!("CARGO_PKG_VERSION")
);
