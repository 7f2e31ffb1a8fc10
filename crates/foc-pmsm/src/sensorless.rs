//! Control without a position sensor: a flux observer, a start that needs none, and signal injection for standstill.

mod injection;
mod observer;
mod start;

pub use injection::{
    SignalEstimate, SignalInjection, SignalInjectionParameters, SignalInjectionState,
};
pub use observer::{FluxEstimate, FluxObserver, FluxObserverParameters, FluxObserverState};
pub use start::{CurrentStart, CurrentStartParameters, CurrentStartState};
