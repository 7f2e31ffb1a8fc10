//! One test program: element, assembly, mesh and modes.

mod against_opensees;
mod against_ross;
mod assembly_laws;
mod axial;
mod bad_input;
mod banded_modes;
mod closed_forms;
mod definite;
mod element_sources;
mod moving_nut;
mod rotors;
mod sections;
#[cfg(feature = "serde")]
mod stored;
mod whirl;
