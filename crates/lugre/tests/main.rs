//! One test program: the law, its step and its identification.

mod bits;
mod family;
mod identify_family;
mod identify_presliding;
mod identify_record;
mod identify_static;
mod identify_total;
mod law;
mod passivity;
mod rig;
mod single_precision;
mod step;
mod total;
