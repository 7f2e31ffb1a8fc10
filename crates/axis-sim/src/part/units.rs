//! Units of the axis file: the last part of a key.

use std::f64::consts::TAU;

/// A physical dimension with the units that a key may end in.
#[derive(Debug)]
pub struct Dimension {
    /// What it is called in a message.
    pub name: &'static str,
    /// Each unit with its factor to SI, the usual one first.
    pub units: &'static [(&'static str, f64)],
}

impl Dimension {
    /// The keys that give the quantity `name`.
    pub(crate) fn keys(&self, name: &str) -> impl Iterator<Item = String> {
        self.units
            .iter()
            .map(move |(unit, _)| format!("{name}_{unit}"))
    }
}

/// rad/s in one rpm.
const RPM: f64 = TAU / 60.0;
/// rad in one degree.
const DEGREE: f64 = TAU / 360.0;

macro_rules! dimensions {
    ($($constant:ident $name:literal: $($unit:literal $factor:expr),+;)+) => {
        $(
            #[doc = concat!("The ", $name, ".")]
            pub static $constant: Dimension = Dimension {
            name: $name,
            units: &[$(($unit, $factor)),+],
        };)+
    };
}

dimensions! {
    LENGTH "unit of length": "mm" 1e-3, "m" 1.0, "um" 1e-6;
    SPEED "unit of speed": "mm_per_s" 1e-3, "m_per_s" 1.0, "m_per_min" 1.0 / 60.0;
    ACCELERATION "unit of acceleration": "mm_per_s2" 1e-3, "m_per_s2" 1.0;
    JERK "unit of jerk": "mm_per_s3" 1e-3, "m_per_s3" 1.0;
    TIME "unit of time": "s" 1.0, "ms" 1e-3, "us" 1e-6;
    FREQUENCY "unit of frequency": "khz" 1e3, "hz" 1.0;
    MASS "unit of mass": "kg" 1.0, "t" 1e3;
    DENSITY "unit of density": "kg_per_m3" 1.0, "g_per_cm3" 1e3;
    PRESSURE "unit of an elastic modulus": "gpa" 1e9, "mpa" 1e6, "pa" 1.0;
    INERTIA "unit of inertia": "kg_m2" 1.0, "kg_cm2" 1e-4;
    STIFFNESS "unit of stiffness": "n_per_m" 1.0, "n_per_um" 1e6;
    TORSION "unit of torsional stiffness": "n_m_per_rad" 1.0, "kn_m_per_rad" 1e3;
    TORQUE "unit of torque": "n_m" 1.0, "n_mm" 1e-3;
    ROTATION "unit of rotational speed": "rpm" RPM, "rad_per_s" 1.0;
    BRISTLE_STIFFNESS "unit of bristle stiffness":
        "n_m_per_rad" 1.0, "n_m_per_rpm_s" 1.0 / RPM;
    ROTARY_DAMPING "unit of rotary damping": "n_m_s_per_rad" 1.0, "n_m_per_rpm" 1.0 / RPM;
    TORQUE_CONSTANT "unit of a torque constant": "n_m_per_a" 1.0;
    RESISTANCE "unit of resistance": "ohm" 1.0, "mohm" 1e-3;
    INDUCTANCE "unit of inductance": "mh" 1e-3, "h" 1.0, "uh" 1e-6;
    VOLTAGE "unit of voltage": "v" 1.0;
    CURRENT "unit of current": "a" 1.0, "ma" 1e-3;
    POSITION_GAIN "unit of a position gain":
        "rpm_per_mm" RPM * 1e3, "rad_per_s_per_m" 1.0;
    SPEED_PROPORTIONAL "unit of a speed controller's proportional gain":
        "a_per_rpm" 1.0 / RPM, "a_s_per_rad" 1.0, "a_s_per_m" 1.0,
        "n_m_s_per_rad" 1.0, "n_m_per_rpm" 1.0 / RPM, "n_s_per_m" 1.0;
    SPEED_INTEGRAL "unit of a speed controller's integral gain":
        "a_per_rpm_s" 1.0 / RPM, "a_per_rad" 1.0, "a_per_m" 1.0,
        "n_m_per_rad" 1.0, "n_per_m" 1.0;
    ACCELERATION_FEEDFORWARD "unit of an acceleration feed-forward":
        "a_s2_per_m" 1.0, "a_s2_per_rad" 1.0, "n_m_s2_per_m" 1.0, "n_m_s2_per_rad" 1.0, "n_s2_per_m" 1.0;
    VELOCITY_GAIN "unit of a velocity gain (Kv)": "per_s" 1.0, "m_per_min_per_mm" 1e3 / 60.0;
    ANGLE "unit of angle": "deg" DEGREE, "rad" 1.0, "arcmin" DEGREE / 60.0, "arcsec" DEGREE / 3600.0;
    ANGULAR_SPEED "unit of angular speed": "deg_per_s" DEGREE, "rad_per_s" 1.0, "rpm" RPM;
    ANGULAR_ACCELERATION "unit of angular acceleration": "deg_per_s2" DEGREE, "rad_per_s2" 1.0;
    ANGULAR_JERK "unit of angular jerk": "deg_per_s3" DEGREE, "rad_per_s3" 1.0;
    FIELD_WEAKENING "unit of a field-weakening gain": "a_per_v_s" 1.0;
    FORCE_CONSTANT "unit of a force constant": "n_per_a" 1.0;
    FORCE "unit of force": "n" 1.0, "kn" 1e3;
    LINEAR_DAMPING "unit of damping": "n_s_per_m" 1.0;
    QUADRATIC_DAMPING "unit of quadratic damping": "n_s2_per_m2" 1.0;
    CUBIC_DAMPING "unit of cubic damping": "n_s3_per_m3" 1.0;
    ROTARY_QUADRATIC_DAMPING "unit of rotary quadratic damping": "n_m_s2_per_rad2" 1.0, "n_m_per_rpm2" 1.0 / (RPM * RPM);
    ROTARY_CUBIC_DAMPING "unit of rotary cubic damping": "n_m_s3_per_rad3" 1.0, "n_m_per_rpm3" 1.0 / (RPM * RPM * RPM);
    FORCE_GAIN "unit of a force gain": "n_per_v" 1.0;
    SPEED_GAIN "unit of a speed gain": "v_s_per_m" 1.0, "n_s_per_m" 1.0, "n_m_s_per_m" 1.0, "n_m_s_per_rad" 1.0, "a_s_per_m" 1.0, "a_s_per_rad" 1.0;
    PID_PROPORTIONAL "unit of a PID controller's proportional gain":
        "v_per_m" 1.0, "n_per_m" 1.0, "n_m_per_m" 1.0, "n_m_per_rad" 1.0, "a_per_m" 1.0, "a_per_rad" 1.0;
    PID_INTEGRAL "unit of a PID controller's integral gain":
        "v_per_m_s" 1.0, "n_per_m_s" 1.0, "n_m_per_m_s" 1.0, "n_m_per_rad_s" 1.0, "a_per_m_s" 1.0, "a_per_rad_s" 1.0;
    PID_DERIVATIVE "unit of a PID controller's derivative gain":
        "v_s_per_m" 1.0, "n_s_per_m" 1.0, "n_m_s_per_m" 1.0, "n_m_s_per_rad" 1.0, "a_s_per_m" 1.0, "a_s_per_rad" 1.0;
    TEMPERATURE "unit of temperature": "deg_c" 1.0;
    HEAT_CAPACITY "unit of heat capacity": "j_per_k" 1.0, "kj_per_k" 1e3;
    SPECIFIC_HEAT "unit of specific heat": "j_per_kg_k" 1.0;
    THERMAL_CONDUCTANCE "unit of thermal conductance": "w_per_k" 1.0;
    THERMAL_CONDUCTIVITY "unit of thermal conductivity": "w_per_m_k" 1.0;
    HEAT_TRANSFER "unit of heat transfer": "w_per_m2_k" 1.0;
    EXPANSION "unit of thermal expansion": "um_per_m_k" 1e-6, "per_k" 1.0;
    PER_KELVIN "unit of change with temperature": "percent_per_k" 1e-2, "per_k" 1.0;
    MOTOR_CONSTANT "unit of a motor constant": "n_m_per_sqrt_w" 1.0, "n_per_sqrt_w" 1.0;
    MOTOR_TORQUE "unit of a motor's torque or force": "n_m" 1.0, "n" 1.0;
    MOTOR_SPEED "unit of a motor's speed":
        "rpm" RPM, "rad_per_s" 1.0, "m_per_s" 1.0, "mm_per_s" 1e-3, "m_per_min" 1.0 / 60.0;
    THERMAL_RESISTANCE "unit of thermal resistance": "k_per_w" 1.0;
    CAPACITANCE "unit of capacitance": "uf" 1e-6, "mf" 1e-3, "f" 1.0;
    ENERGY "unit of energy": "j" 1.0, "kj" 1e3;
    POWER "unit of power": "w" 1.0, "kw" 1e3;
    LIFE "unit of a life": "h" 1.0;
    DN_VALUE "unit of a DN value": "mm_per_min" 1.0;
    BELT_FORCE "unit of a tooth's force for its width": "n_per_mm" 1e3, "n_per_m" 1.0;
    CURRENT_PROPORTIONAL "unit of a current controller's proportional gain": "v_per_a" 1.0;
    CURRENT_INTEGRAL "unit of a current controller's integral gain": "v_per_a_s" 1.0;
}
