//! A compensator as one self-contained C99 file with its header.
//!
//! No allocation and no library: sums, products, quotients and own exponentials. The state is a
//! struct of the caller's:
//!
//! ```c
//! static network_lugre law;              /* state: once for each axis */
//!
//! network_lugre_init(&law);              /* at power-on; switched off */
//! network_lugre_switch(&law, 1);         /* fades in; 0 fades out */
//! network_lugre_step(&law, &in, &out);   /* each control cycle */
//! network_lugre_reset(&law);             /* before the first motion after a stop that was no rest */
//! network_lugre_limit(&law, &limits);    /* other limits of the guard, at any moment */
//! ```
//!
//! Operations stand in the order of the Rust code and are not contracted, so results are the
//! same to the bit wherever `float` and `double` are IEEE 754 and round after each operation.

mod data;
mod draft;
mod feedback;
mod friction;
mod guard;
mod head;
mod input;
mod network;
mod part;
mod plan;
mod transfer;

use cfnn::NetworkScalar;
use lugre::Exponential;

pub use input::Input;

use crate::{ExportError, ExportedController, ExportedLaw, NamedText, Position};
use draft::Draft;

/// The floating-point type of the C code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// `float`: for a controller that has no double precision in hardware.
    F32,
    /// `double`.
    F64,
}

impl Precision {
    /// Its type in C.
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "float",
            Self::F64 => "double",
        }
    }

    /// Bytes of a number.
    pub fn bytes(self) -> usize {
        match self {
            Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// Memory of an exported compensator, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// The state, once for each axis: `sizeof` where a number is aligned to its size.
    pub state: usize,
    /// Constant tables, once.
    pub constants: usize,
    /// The greatest array on the stack. What a step takes of the stack is the compiler's, and
    /// more: a few hundred bytes (docs/controller-export.md has measurements).
    pub greatest_array: usize,
}

/// A compensator in C.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CSource {
    /// `NAME.h`.
    pub header: NamedText,
    /// `NAME.c`.
    pub source: NamedText,
    /// What it takes in memory.
    pub memory: Memory,
    /// Of a plan: cycles by which its set points must come ahead.
    pub look_ahead: Option<usize>,
    /// Members of the input, in their order.
    pub inputs: Vec<Input>,
    /// Hash (BLAKE3) of axis, strategy, precision and all its numbers.
    pub hash: String,
}

/// The C code of a compensator. `step_time` goes to its top: how long a step was measured to
/// take, and on which machine; without it "not measured" stands there.
///
/// # Errors
/// [`ExportError`] if a number leaves its range in this precision, or the name is one that the
/// code has inside.
pub fn export(
    controller: &ExportedController,
    precision: Precision,
    step_time: Option<&str>,
) -> Result<CSource, ExportError> {
    let draft = match precision {
        Precision::F64 => drafted(controller, precision, &controller.law),
        Precision::F32 => drafted(controller, precision, &controller.law.cast::<f32>()?),
    };
    head::finish(controller, draft, step_time)
}

fn drafted<T: NetworkScalar + Exponential>(
    controller: &ExportedController,
    precision: Precision,
    law: &ExportedLaw<T>,
) -> Draft {
    let mut draft = Draft::new(precision);
    match &law.position {
        Position::Nothing => {}
        Position::Network(network) => network::add(&mut draft, network),
        Position::Transfer(filter) => transfer::add(&mut draft, filter),
    }
    if let Some(feedforward) = &law.friction {
        friction::add(&mut draft, feedforward);
    }
    if let Some(law) = &law.plan {
        plan::add(&mut draft, &law.planner);
        if let Some(feedback) = &law.feedback {
            feedback::add(&mut draft, feedback);
        }
    }
    guard::add(&mut draft, &controller.limits.cast::<T>());
    draft
}
