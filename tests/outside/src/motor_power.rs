//! `motor_power_w`: mechanical power of the motor, torque times speed.

use axis_sim::{ChannelPart, LogChannel};

/// Power that the motor gives to the axis; below zero where it brakes.
pub const MOTOR_POWER: LogChannel = LogChannel {
    linear: ["motor_power_w", "W"],
    rotary: ["motor_power_w", "W"],
    read: |cycle| cycle.torque * cycle.motor_speed,
    of: |_| true,
    part: ChannelPart::Shown,
};
