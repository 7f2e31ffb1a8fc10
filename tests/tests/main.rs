//! One test program: acceptance across the crates, on real logs where they lie beside the project.

mod balance;
mod bench;
mod contour;
mod emps;
mod heat;
mod identification;
mod independent_logs;
mod joint;
#[path = "../needs.rs"]
mod needs;
mod readme;
mod rigid_stand_in;
mod slide;
mod spin;
