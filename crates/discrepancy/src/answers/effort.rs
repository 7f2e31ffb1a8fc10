//! Channels that show what a drive gives.

/// Commands of actuators, of which an axis has one.
pub const COMMANDS: [&str; 4] = [
    "iq_ref_a",
    "torque_ref_n_m",
    "force_ref_n",
    "drive_command_v",
];

/// What the drive gives, as the drive has it: measured current, then commands.
pub fn of_drive() -> impl Iterator<Item = &'static str> {
    ["iq_a"].into_iter().chain(COMMANDS)
}

/// The same, with measured torque or force before it.
pub fn efforts() -> impl Iterator<Item = &'static str> {
    ["torque_n_m", "force_n"].into_iter().chain(of_drive())
}
