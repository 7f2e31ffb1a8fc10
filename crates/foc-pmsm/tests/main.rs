//! One test program: motor, inverter, frames, laws and the whole cascade.

mod axis;
mod bits;
mod current_step;
mod dead_time;
mod field_weakening;
mod frames;
mod gains;
mod injection;
mod inverter;
mod linear_motor;
mod modulation;
mod motor;
mod motulator;
mod operating;
mod operating_point;
mod pi;
mod saturation;
mod sensorless;
mod servo;
mod single;
#[cfg(feature = "serde")]
mod stored;
mod svpwm;
mod total;
mod total_drive;
mod total_single;
