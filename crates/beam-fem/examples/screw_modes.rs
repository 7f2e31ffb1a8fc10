//! Natural frequencies of the default screw, and the nut's compliance on its
//! way along it.

use std::time::Instant;

use beam_fem::{Beam, BeamError, CrossSection, Dof, Material, Mesh, MovingNode, lowest_modes};

fn screw(mesh: Mesh) -> Result<Beam, BeamError> {
    let steel = Material::new(206e9, 0.3, 7850.0)?;
    let section = CrossSection::solid_circle(0.040, &steel)?;
    Ok(Beam::new(section, steel, mesh))
}

/// The direction that holds most of a shape's energy of motion.
fn direction(beam: &Beam, shape: nalgebra::DVectorView<f64>) -> Dof {
    let polar = beam.section.polar_moment();
    let area = beam.section.area();
    let shares = [
        (Dof::U, area),
        (Dof::V, area),
        (Dof::W, area),
        (Dof::ThetaX, polar),
    ];
    let share = |(dof, weight): &(Dof, f64)| -> f64 {
        let rows = (0..shape.len() / 6).map(|node| dof.at(node));
        weight * rows.map(|row| shape[row].powi(2)).sum::<f64>()
    };
    let largest = shares.iter().max_by(|a, b| share(a).total_cmp(&share(b)));
    largest.map_or(Dof::U, |(dof, _)| *dof)
}

fn main() -> Result<(), BeamError> {
    println!("Free steel screw, 40 mm x 1.5 m: elastic modes, Hz");
    let coarse = screw(Mesh::uniform(1.5, 10)?)?;
    let fine = screw(Mesh::uniform(1.5, 1000)?)?;
    let few = lowest_modes(&coarse.assemble_banded(), 18)?;
    let many = lowest_modes(&fine.assemble_banded(), 18)?;
    println!(
        "{:>10} {:8} {:>10} {:8}",
        "N = 10", "mostly", "N = 1000", "mostly"
    );
    for mode in 6..18 {
        for (beam, modes) in [(&coarse, &few), (&fine, &many)] {
            let kind = format!("{:?}", direction(beam, modes.shapes.column(mode)));
            print!("{:>10.3} {kind:8} ", modes.frequencies_hz()[mode]);
        }
        println!();
    }

    println!("\nTwist per torque at the nut, urad/(N m), driven end held, N = 10");
    println!(
        "{:>8} {:>12} {:>16}",
        "x, m", "moving node", "shape functions"
    );
    for step in 1..=10 {
        let x = 0.14 * f64::from(step);
        let nut = MovingNode::at(1.5, 10, x, MovingNode::MIN_FRACTION)?;
        let on_node = screw(nut.mesh().clone())?.torsional_compliance_at_node(nut.node())?;
        let on_shape = coarse.torsional_compliance_at(x);
        println!("{x:>8.2} {:>12.4} {:>16.4}", 1e6 * on_node, 1e6 * on_shape);
    }

    let mut matrices = fine.assemble_banded();
    let start = Instant::now();
    fine.assemble_banded_into(&mut matrices)?;
    let assembled = start.elapsed();
    lowest_modes(&matrices, 12)?;
    println!(
        "\n1000 elements: assembled in {assembled:?}, with 12 modes {:?}",
        start.elapsed()
    );
    Ok(())
}
