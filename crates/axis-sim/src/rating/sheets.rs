//! `[rating]` of an axis and what the file says of the same parts elsewhere, as the check needs them.

use std::f64::consts::PI;

use axis_rating::{DcLink, MotorVoltage, RollingElement, TorqueCurve};

use super::CheckError;
use crate::axis::Axis;
use crate::data_sheets::{DataSheets, MotorPoint};
use crate::freedom::Freedom;
use crate::part::{Role, Values};

/// The same, with what the axis' parts say.
#[derive(Clone, Debug)]
pub(super) struct Sheets {
    pub continuous: Option<TorqueCurve>,
    pub peak: Option<TorqueCurve>,
    pub torque_unit: &'static str,
    pub is_linear: bool,
    pub voltage: Option<MotorVoltage>,
    /// Loss of the winding per torque squared at the reference temperature; none if it is not known.
    pub per_torque_squared: Option<f64>,
    /// 1.5 R, W/A², for the current that makes no torque.
    pub per_current_squared: f64,
    /// What the capacitors take, J; none if it is not known.
    pub capacitor_j: Option<f64>,
    pub has_screw: bool,
    pub nut_preload: f64,
    pub bearing_preload: f64,
    pub bearing_element: RollingElement,
}

/// Ball or roller.
pub(super) fn element(v: &Values, key: &str) -> RollingElement {
    match v.word(key) {
        Some("roller") => RollingElement::Roller,
        _ => RollingElement::Ball,
    }
}

impl Sheets {
    pub fn of(axis: &Axis) -> Result<Self, CheckError> {
        let (sheets, v) = (&axis.rating, &axis.rating.values);
        let is_linear = axis.mechanism.motor_freedom() == Freedom::Linear;
        let thermal = axis.thermal_parameters().winding.per_torque_squared;
        let resistance = axis.actuator.value(Role::Resistance);
        Ok(Self {
            continuous: curve(sheets, "continuous_torque", |point| point.continuous)?,
            peak: curve(sheets, "peak_torque", |point| point.peak)?,
            torque_unit: if is_linear { "N" } else { "N·m" },
            is_linear,
            voltage: voltage(axis),
            per_torque_squared: (thermal > 0.0).then_some(thermal),
            per_current_squared: 1.5 * resistance.unwrap_or(0.0),
            capacitor_j: capacitor(axis)?,
            has_screw: axis.mechanism.screw().is_some(),
            nut_preload: v.or("nut_preload", 0.0),
            bearing_preload: v.or("bearing_preload", 0.0),
            bearing_element: element(v, "bearing_element"),
        })
    }

    /// Loss of the winding at its reference temperature, W; 0 if it is not known.
    pub fn loss_w(&self, torque: f64, [d, _]: [f64; 2]) -> f64 {
        let of_torque = self.per_torque_squared.unwrap_or(0.0) * torque * torque;
        of_torque + self.per_current_squared * d * d
    }
}

/// The points of a curve, or the same torque at every speed.
fn curve(
    sheets: &DataSheets,
    key: &str,
    of: fn(&MotorPoint) -> Option<f64>,
) -> Result<Option<TorqueCurve>, CheckError> {
    let points = sheets.motor_curve.iter();
    let points = points.filter_map(|point| Some([point.speed, of(point)?]));
    let points: Vec<[f64; 2]> = points.collect();
    if !points.is_empty() {
        return Ok(Some(TorqueCurve::new(points)?));
    }
    let constant = sheets.values.optional(key).map(TorqueCurve::constant);
    Ok(constant.transpose()?)
}

/// Electrical values of the motor, where its actuator has them.
fn voltage(axis: &Axis) -> Option<MotorVoltage> {
    let v = axis.actuator.values();
    let electrical = match v.optional("pole_pitch") {
        Some(pitch) => PI / pitch,
        None => f64::from(v.optional_count("pole_pairs")?),
    };
    Some(MotorVoltage {
        resistance_ohm: v.optional("resistance")?,
        inductance_d_h: v.optional("inductance_d")?,
        inductance_q_h: v.optional("inductance_q")?,
        // T = 1.5 p ψ i_q.
        flux_v_s: axis.torque_constant() / (1.5 * electrical),
        electrical_per_motor: electrical,
        dc_link_v: v.optional("dc_link")?,
    })
}

/// What the capacitors of the DC link take.
fn capacitor(axis: &Axis) -> Result<Option<f64>, CheckError> {
    let v = &axis.rating.values;
    let link = v
        .optional("dc_link_capacitance")
        .zip(v.optional("brake_on_voltage"))
        .zip(axis.actuator.values().optional("dc_link"));
    let energy = link.map(|((capacitance_f, brake_on_v), voltage_v)| {
        let link = DcLink {
            capacitance_f,
            voltage_v,
            brake_on_v,
        };
        link.capacitor_energy_j()
    });
    Ok(energy.transpose()?)
}
