//! One test program: element, assembly, mesh and modes.

mod assembly_laws;
mod bad_input;
mod banded_modes;
mod closed_forms;
mod definite;
mod element_sources;
mod moving_nut;
