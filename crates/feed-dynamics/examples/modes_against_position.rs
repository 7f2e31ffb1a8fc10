//! The lowest modes of the paper's drive against the table's position, with
//! both nut couplings.
//!
//! `cargo run -p feed-dynamics --example modes_against_position`

use std::f64::consts::TAU;

use beam_fem::{CrossSection, Material};
use feed_dynamics::{DriveParameters, FeedDrive, NutCoupling};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Liu et al. 2025, doi:10.3390/machines13050433, Tables 2 and 3.
    let steel = Material::new(206e9, 0.3, 7850.0)?;
    let drive = FeedDrive::new(DriveParameters {
        section: CrossSection::solid_circle(0.040, &steel)?,
        material: steel,
        screw_length: 1.5,
        elements: 10,
        lead: 0.010,
        motor_inertia: 0.0053,
        sensor_inertia: 1e-4,
        motor_coupling_stiffness: 2800.0,
        screw_coupling_stiffness: 2800.0,
        table_mass: 515.0,
        nut_stiffness: 7.45e7,
        axial: None,
        stiffness_damping: 1e-5,
    })?;
    println!(
        "inertia seen at the motor {:.4e} kg·m²\n",
        drive.total_inertia()
    );
    println!("              shape functions, Hz              moving node, Hz");
    println!("   x, mm      1st     2nd     3rd     4th      1st     2nd     3rd     4th");
    for i in 0..=12 {
        let x = f64::from(i) / 12.0 * drive.parameters().screw_length;
        let mut row = format!("{:8.0}", 1e3 * x);
        for coupling in [NutCoupling::ShapeFunctions, NutCoupling::MovingNode] {
            row.push_str("  ");
            for w in &drive.modes(x, coupling)?.frequencies_rad_s[1..5] {
                row.push_str(&format!("{:8.2}", w / TAU));
            }
        }
        println!("{row}");
    }
    Ok(())
}
