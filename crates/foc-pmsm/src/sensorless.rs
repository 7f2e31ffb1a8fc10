//! Control without a position sensor: a flux observer, and a start that needs none.

mod observer;
mod start;

pub use observer::{FluxEstimate, FluxObserver, FluxObserverParameters, FluxObserverState};
pub use start::{CurrentStart, CurrentStartParameters, CurrentStartState};
