//! Which function of a drive or of a CNC compensates which effect.
//!
//! One line an effect. What the functions are called in the controls of several makers is
//! in `docs/drive-terms.md`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What can be done against an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DriveFunction {
    /// A torque with the sign of the motion, with a pulse after reversals.
    FrictionCompensation,
    /// A torque in proportion to the speed.
    ViscousFeedForward,
    /// A torque in proportion to the acceleration.
    AccelerationFeedForward,
    /// A torque at rest, as of weight.
    StandingLoad,
    /// A torque over the motor's angle.
    CoggingTable,
    /// A torque or a position over the position.
    PositionTable,
    /// Lost motion at reversals.
    BacklashCompensation,
    /// Travel errors over the position.
    LeadErrorTable,
    /// Offset of the position in proportion to acceleration or force.
    WindUpCompensation,
    /// Growth over time or temperature.
    ThermalCompensation,
    /// Voltage lost in the inverter.
    DeadTimeCompensation,
    /// A limit to what the motion asks for at one frequency.
    VibrationFilter,
    /// A number of the drive, the control or a sensor that is set otherwise than the model says.
    Setting,
    /// No function of a drive: the machine is repaired or warmed up.
    MechanicalRepair,
}

impl DriveFunction {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::FrictionCompensation => "friction compensation",
            Self::ViscousFeedForward => "speed-proportional torque feed-forward",
            Self::AccelerationFeedForward => "acceleration (torque) feed-forward",
            Self::StandingLoad => "weight compensation (constant load)",
            Self::CoggingTable => "cogging table over the motor angle",
            Self::PositionTable => "torque table over the position",
            Self::BacklashCompensation => "backlash compensation",
            Self::LeadErrorTable => "lead-error table over the position",
            Self::WindUpCompensation => "wind-up compensation",
            Self::ThermalCompensation => "thermal compensation",
            Self::DeadTimeCompensation => "dead-time compensation of the inverter",
            Self::VibrationFilter => "notch filter or jerk filter",
            Self::Setting => "check the setting",
            Self::MechanicalRepair => "no function of a drive: find the cause in the machine",
        }
    }
}

/// What is done against an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Remedy {
    /// The effect.
    pub effect: &'static str,
    /// The function.
    pub function: DriveFunction,
    /// What is entered there.
    pub parameter: &'static str,
}

impl Remedy {
    /// The line of an effect; `None` for a name that the library does not have.
    pub fn of(effect: &str) -> Option<&'static Self> {
        REMEDIES.iter().find(|remedy| remedy.effect == effect)
    }
}

const fn line(effect: &'static str, function: DriveFunction, parameter: &'static str) -> Remedy {
    Remedy {
        effect,
        function,
        parameter,
    }
}

use DriveFunction::{
    AccelerationFeedForward, BacklashCompensation, CoggingTable, DeadTimeCompensation,
    FrictionCompensation, LeadErrorTable, MechanicalRepair, PositionTable, Setting, StandingLoad,
    ThermalCompensation, VibrationFilter, ViscousFeedForward, WindUpCompensation,
};

/// One line an effect.
#[rustfmt::skip]
pub const REMEDIES: &[Remedy] = &[
    line("viscous-friction", ViscousFeedForward, "the coefficient, added to that of the model"),
    line("coulomb-friction", FrictionCompensation, "the level, added to that of the model"),
    line("asymmetric-friction", FrictionCompensation, "one level for each direction"),
    line("asymmetric-viscous-friction", ViscousFeedForward, "one coefficient for each direction, or a table of torque over speed"),
    line("stribeck-friction", FrictionCompensation, "a table of torque over speed, dense at low speed"),
    line("presliding", FrictionCompensation, "delay and decay of the pulse after a reversal"),
    line("position-dependent-friction", PositionTable, "the level over the position; look at guide and transmission there"),
    line("load-dependent-friction", FrictionCompensation, "a level that grows with the acceleration, if the drive has one"),
    line("warming-friction", MechanicalRepair, "a warm-up run, or a level that is adapted as the machine warms"),
    line("maxwell-slip-hysteresis", FrictionCompensation, "delay and decay of the pulse after a reversal"),
    line("constant-load", StandingLoad, "the force as motor torque, with its sign"),
    line("process-force", MechanicalRepair, "a force of the process: the loops must withstand it"),
    line("cyclic-load", MechanicalRepair, "a source that acts in time: fan, pump, cutter or a neighbouring axis"),
    line("spring-force", PositionTable, "a torque that grows along the stroke; look at the cable chain and covers"),
    line("gravity-imbalance", PositionTable, "torque as a sine over the angle, or a counterweight"),
    line("payload-mass", AccelerationFeedForward, "total inertia: the mass times travel per radian squared is added"),
    line("structural-resonance", VibrationFilter, "its frequency"),
    line("motor-inertia", AccelerationFeedForward, "total inertia: this is added"),
    line("torque-constant", Setting, "torque constant of the motor in the drive: all torque feed-forwards scale with it"),
    line("cogging-torque", CoggingTable, "amplitude, order and phase"),
    line("torque-ripple", CoggingTable, "amplitude in proportion to the torque, at six times the electrical angle"),
    line("force-ripple", PositionTable, "amplitude, order and phase over two pole pitches"),
    line("current-sensor-offset", Setting, "offset of the current sensors: calibrate them in the drive"),
    line("current-sensor-gain", Setting, "scale of the current sensors: calibrate them in the drive"),
    line("backlash", BacklashCompensation, "the gap; beyond a few micrometres preload or repair the transmission"),
    line("lead-error", LeadErrorTable, "a straight line over the position: slope"),
    line("periodic-lead-error", LeadErrorTable, "a sine with the motor's turn: several points a turn"),
    line("kinematic-error-harmonic", LeadErrorTable, "a sine with several periods a turn: eight points and more a period"),
    line("thermal-expansion", ThermalCompensation, "strain against time or temperature of the transmission"),
    line("transmission-stiffness", WindUpCompensation, "travel lost per acceleration"),
    line("hardening-stiffness", WindUpCompensation, "travel lost over the force, as a table"),
    line("encoder-eccentricity", LeadErrorTable, "a sine with the motor's turn; or mount the encoder anew"),
    line("inverter-dead-time", DeadTimeCompensation, "voltage lost per phase"),
    line("stator-resistance", Setting, "resistance of the winding in the current controller: identify the motor warm"),
    line("control-delay", Setting, "delay from command to current: cycle times, filters of the current reference"),
    line("controller-gain", Setting, "gain of the position controller, here and in the axis file"),
    line("speed-controller-gain", Setting, "gain of the speed controller, here and in the axis file"),
    line("velocity-feedforward", Setting, "weight of the velocity feed-forward: 100 % unless set otherwise on purpose"),
    line("clock-offset", Setting, "delay of the channel, in the [log] part of the axis file: an error of the log, not of the motion"),
    line("reference-delay", Setting, "delay of the logged reference, in the [log] part of the axis file: an error of the log, not of the motion"),
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use axis_sim::effects::EFFECTS;

    use super::{REMEDIES, Remedy};

    #[test]
    fn every_effect_has_one_line_and_every_line_an_effect() {
        let effects: BTreeSet<&str> = EFFECTS.iter().map(|e| e.name).collect();
        let lines: BTreeSet<&str> = REMEDIES.iter().map(|r| r.effect).collect();
        assert_eq!(effects, lines);
        assert_eq!(REMEDIES.len(), lines.len());
        assert!(REMEDIES.iter().all(|r| !r.parameter.is_empty()));
        assert!(Remedy::of("nonsense").is_none());
    }

    /// What is advised is advised on a joint too; a table is one of numbers.
    #[test]
    fn no_line_speaks_of_a_screw() {
        for line in REMEDIES {
            let mut words = line.parameter.split(|c: char| !c.is_alphanumeric());
            assert!(
                words.all(|word| !["screw", "nut"].contains(&word)),
                "{}",
                line.parameter
            );
        }
    }
}
