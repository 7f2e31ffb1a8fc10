//! Items of motor and drive.

use std::f64::consts::PI;

use axis_rating::{Rating, WindingModel, motor};

use super::item::CheckedItem;
use super::keys::AMBIENT;
use super::{AxisDuty, CheckError};
use crate::axis::Axis;
use crate::part::Role;

/// The items, those left out that the actuator or the mechanism cannot have.
pub(super) fn items(axis: &Axis, duty: &AxisDuty) -> Result<Vec<CheckedItem>, CheckError> {
    let mut items = vec![continuous(duty), peak(duty), speed(axis, duty)?];
    items.extend(voltage(axis, duty)?);
    items.push(winding(axis, duty)?);
    items.extend(brake(axis, duty)?);
    items.extend(inertia(axis)?);
    Ok(items)
}

fn continuous(duty: &AxisDuty) -> CheckedItem {
    let name = "motor_rms_torque";
    let title = match duty.sheets.is_linear {
        false => "RMS torque, at the mean speed",
        true => "RMS force, at the mean speed",
    };
    let unit = duty.sheets.torque_unit;
    match &duty.sheets.continuous {
        Some(curve) => CheckedItem::rated(name, title, duty.motor.continuous(curve, unit)),
        None => {
            let known = Some((duty.motor.rms_torque_n_m(), unit));
            CheckedItem::missing(name, title, known, &["continuous_torque"])
        }
    }
}

fn peak(duty: &AxisDuty) -> CheckedItem {
    let name = "motor_peak_torque";
    let title = match duty.sheets.is_linear {
        false => "peak torque, at its speed",
        true => "peak force, at its speed",
    };
    match duty.peak {
        Some(rating) => CheckedItem::rated(name, title, rating),
        None => {
            let known = Some((duty.motor.peak_torque_n_m(), duty.sheets.torque_unit));
            CheckedItem::missing(name, title, known, &["peak_torque"])
        }
    }
}

/// rpm of a motor that turns, m/s of one that does not.
fn of_speed(duty: &AxisDuty) -> (f64, &'static str) {
    match duty.sheets.is_linear {
        true => (1.0, "m/s"),
        false => (30.0 / PI, "rpm"),
    }
}

fn speed(axis: &Axis, duty: &AxisDuty) -> Result<CheckedItem, CheckError> {
    let (name, title) = ("motor_speed", "greatest speed of the motor");
    let (factor, unit) = of_speed(duty);
    let fastest = duty.motor.fastest_rad_per_s();
    Ok(match axis.rating.values.optional("max_speed") {
        Some(limit) => {
            let found = motor::speed(fastest, limit)?;
            let shown = Rating::at_most(factor * found.value, factor * found.limit, unit);
            CheckedItem::rated(name, title, shown)
        }
        None => CheckedItem::missing(name, title, Some((factor * fastest, unit)), &["max_speed"]),
    })
}

/// Of an actuator with voltages.
fn voltage(axis: &Axis, duty: &AxisDuty) -> Result<Vec<CheckedItem>, CheckError> {
    let Some(motor) = duty.motor_voltage() else {
        return Ok(Vec::new());
    };
    let mut items = Vec::new();
    if let Some(rating) = duty.voltage {
        let title = "phase voltage at constant speed, amplitude";
        items.push(CheckedItem::rated("motor_voltage", title, rating));
    }
    let (name, title) = (
        "motor_back_emf",
        "back-EMF at the greatest speed, between phases",
    );
    let fastest = duty.motor.fastest_rad_per_s();
    items.push(match axis.rating.values.optional("dc_link_limit") {
        Some(limit) => CheckedItem::rated(name, title, motor.back_emf(fastest, limit)?),
        None => {
            let known = motor.back_emf(fastest, 1.0)?.value;
            CheckedItem::missing(name, title, Some((known, "V")), &["dc_link_limit"])
        }
    });
    Ok(items)
}

fn winding(axis: &Axis, duty: &AxisDuty) -> Result<CheckedItem, CheckError> {
    let (name, title) = ("winding_rise", "rise of the winding above the surroundings");
    let v = &axis.rating.values;
    let keys = [
        "winding_thermal_resistance",
        "winding_time_constant",
        "winding_temperature_limit",
    ];
    let mut missing: Vec<&str> = keys
        .into_iter()
        .filter(|key| v.optional(key).is_none())
        .collect();
    if duty.sheets.per_torque_squared.is_none() {
        missing.push("thermal.motor_constant");
    }
    let thermal = axis.thermal_parameters();
    let values = keys.map(|key| v.optional(key));
    let [Some(resistance), Some(time), limit] = values else {
        return Ok(CheckedItem::missing(name, title, None, &missing));
    };
    if duty.sheets.per_torque_squared.is_none() {
        return Ok(CheckedItem::missing(name, title, None, &missing));
    }
    let model = WindingModel {
        thermal_resistance_k_per_w: resistance,
        time_constant_s: time,
        ambient_deg_c: v.or("ambient_temperature", AMBIENT),
        reference_deg_c: thermal.reference_temperature,
        resistance_rise_per_k: thermal.winding.resistance_per_kelvin,
    };
    Ok(match limit {
        Some(limit) => CheckedItem::rated(name, title, model.rise(&duty.losses, limit)?),
        None => {
            let known = model.greatest_deg_c(&duty.losses)? - model.ambient_deg_c;
            CheckedItem::missing(name, title, Some((known, "K")), &missing)
        }
    })
}

/// Energy and power that stops give back.
fn brake(axis: &Axis, duty: &AxisDuty) -> Result<[CheckedItem; 3], CheckError> {
    let (v, back) = (&axis.rating.values, &duty.regeneration);
    let lacks = |keys: &[&'static str]| -> Vec<&'static str> {
        keys.iter().copied().filter(|key| !v.has(key)).collect()
    };
    let (name, title) = ("brake_energy", "greatest energy of a stop");
    let energy = (back.greatest_energy_j(), "J");
    // Capacitors of which not all is known may take more than the brake alone.
    let half_known = v.has("dc_link_capacitance") && duty.sheets.capacitor_j.is_none();
    let first = match duty.sheets.capacitor_j.or(v.optional("brake_energy")) {
        Some(_) if !half_known => {
            CheckedItem::rated(name, title, back.energy(v.or("brake_energy", 0.0))?)
        }
        _ if half_known => {
            let mut keys = lacks(&["brake_on_voltage"]);
            if !axis.actuator.values().has("dc_link") {
                keys.push("actuator.dc_link");
            }
            CheckedItem::missing(name, title, Some(energy), &keys)
        }
        _ => CheckedItem::missing(name, title, Some(energy), &["brake_energy"]),
    };
    let (name, title) = ("brake_mean_power", "mean power of the brake");
    let second = match v.optional("brake_power") {
        Some(limit) => CheckedItem::rated(name, title, back.mean_power(limit)?),
        None => {
            let known = Some((back.mean_brake_power_w(), "W"));
            CheckedItem::missing(name, title, known, &["brake_power"])
        }
    };
    let (name, title) = ("brake_peak_power", "greatest power given back");
    let keys = ["brake_on_voltage", "brake_resistance"];
    let third = match keys.map(|key| v.optional(key)) {
        [Some(on), Some(ohm)] => CheckedItem::rated(name, title, back.peak_power(on, ohm)?),
        _ => {
            let known = Some((back.peak_power_w(), "W"));
            CheckedItem::missing(name, title, known, &lacks(&keys))
        }
    };
    Ok([first, second, third])
}

/// Of a motor whose inertia is not the load's.
fn inertia(axis: &Axis) -> Result<Option<CheckedItem>, CheckError> {
    let Some(rotor) = axis.mechanism.value(Role::MotorInertia) else {
        return Ok(None);
    };
    let (name, title) = ("inertia_ratio", "inertia of the load over the motor's");
    let load = (axis.mechanism.total_inertia() - rotor).max(0.0);
    let limit = axis.rating.values.optional("inertia_ratio_limit");
    let found = motor::inertia_ratio(load, rotor, limit.unwrap_or(1.0))?;
    Ok(Some(match limit {
        Some(_) => CheckedItem::rated(name, title, found),
        None => CheckedItem::missing(
            name,
            title,
            Some((found.value, "")),
            &["inertia_ratio_limit"],
        ),
    }))
}
