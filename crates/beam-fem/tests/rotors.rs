//! Rotors of books and papers, for the example `campbell` and the tests.
#![allow(dead_code)] // Each user takes some of them.

use beam_fem::{BeamError, BeamModel, Bearing, LumpedMass, Material, SectionShape, Shaft, Span};

/// The steel of Friswell, Penny, Garvey and Lees, *Dynamics of Rotating Machines*,
/// Cambridge 2010, section 5.9: E = 211 GPa, G = 81.2 GPa, 7810 kg/m³.
pub fn steel() -> Result<Material, BeamError> {
    Material::new(211e9, 211e9 / (2.0 * 81.2e9) - 1.0, 7810.0)
}

/// Example 5.9.1 and its variants: a shaft of 1.5 m and 50 mm in `elements`, a multiple of
/// three, discs at its thirds.
pub fn two_discs(elements: usize, bearing: Bearing, axial: f64) -> Result<BeamModel, BeamError> {
    let steel = steel()?;
    let round = SectionShape::solid(0.05).section(&steel)?;
    let span = Span::uniform(1.5, elements, round, steel.clone())?;
    let mut rotor = BeamModel::new(Shaft::new(&[span])?);
    for (node, outer) in [(elements / 3, 0.28), (2 * elements / 3, 0.35)] {
        rotor.add_mass(node, LumpedMass::disc([outer, 0.05], 0.07, &steel)?)?;
    }
    rotor.add_bearing(0, bearing)?;
    rotor.add_bearing(elements, bearing)?;
    rotor.set_axial_force(axial)?;
    rotor.lateral_only();
    Ok(rotor)
}

/// Example 5.9.9: overhung disc.
pub fn overhung() -> Result<BeamModel, BeamError> {
    let steel = steel()?;
    let round = SectionShape::solid(0.05).section(&steel)?;
    let mut rotor = BeamModel::new(Shaft::new(&[Span::uniform(1.5, 6, round, steel.clone())?])?);
    rotor.add_mass(6, LumpedMass::disc([0.35, 0.05], 0.07, &steel)?)?;
    rotor.add_bearing(0, Bearing::isotropic(1e7, 0.0))?;
    rotor.add_bearing(4, Bearing::isotropic(1e7, 0.0))?;
    rotor.lateral_only();
    Ok(rotor)
}

/// Like example 5.9.10: a shaft that tapers from 25 to 40 mm, a disc in its middle.
pub fn tapered(elements: usize) -> Result<BeamModel, BeamError> {
    let steel = steel()?;
    let ends = [SectionShape::solid(0.025), SectionShape::solid(0.040)];
    let span = Span::tapered(1.5, elements, ends, steel.clone())?;
    let mut rotor = BeamModel::new(Shaft::new(&[span])?);
    rotor.add_mass(elements / 2, LumpedMass::disc([0.28, 0.05], 0.07, &steel)?)?;
    rotor.add_bearing(0, Bearing::isotropic(1e7, 1e3))?;
    rotor.add_bearing(elements, Bearing::isotropic(1e7, 1e3))?;
    rotor.lateral_only();
    Ok(rotor)
}

/// Ends of the elements of Nelson and McVaugh (1976), J. Eng. Ind. 98, 593, cm, and
/// outer and inner radius of each, cm.
const STEPS: [(f64, f64, f64); 18] = [
    (1.27, 0.51, 0.0),
    (5.08, 1.02, 0.0),
    (7.62, 0.76, 0.0),
    (8.89, 2.03, 0.0),
    (10.16, 2.03, 0.0),
    (10.67, 3.30, 0.0),
    (11.43, 3.30, 1.52),
    (12.70, 2.54, 1.78),
    (13.46, 2.54, 0.0),
    (16.51, 1.27, 0.0),
    (19.05, 1.27, 0.0),
    (22.86, 1.52, 0.0),
    (26.67, 1.52, 0.0),
    (28.70, 1.27, 0.0),
    (30.48, 1.27, 0.0),
    (31.50, 3.81, 0.0),
    (34.54, 2.03, 0.0),
    (35.81, 2.03, 1.52),
];

/// The rotor of Nelson and McVaugh with isotropic bearings of 43.78 MN/m. They take
/// shear as infinitely stiff; `shear` = false does so.
pub fn nelson_mcvaugh(shear: bool) -> Result<BeamModel, BeamError> {
    let steel = Material::new(207.8e9, 0.3, 7806.0)?;
    let mut spans = Vec::new();
    let mut start = 0.0;
    for (end, outer, inner) in STEPS {
        let shape = SectionShape::Circle {
            outer: 0.02 * outer,
            inner: 0.02 * inner,
        };
        let mut section = shape.section(&steel)?;
        if !shear {
            section = beam_fem::CrossSection::new(
                section.area(),
                section.second_moment_y(),
                section.second_moment_z(),
                section.torsion_constant(),
                1e9,
            )?;
        }
        spans.push(Span::uniform(
            0.01 * (end - start),
            1,
            section,
            steel.clone(),
        )?);
        start = end;
    }
    let mut rotor = BeamModel::new(Shaft::new(&spans)?);
    rotor.add_mass(
        4,
        LumpedMass {
            mass: 1.401,
            polar_inertia: 0.00203,
            diametral_inertia: 0.00136,
        },
    )?;
    rotor.add_bearing(10, Bearing::isotropic(4.378e7, 0.0))?;
    rotor.add_bearing(14, Bearing::isotropic(4.378e7, 0.0))?;
    rotor.lateral_only();
    Ok(rotor)
}

/// Bearings of example 5.9.4: 1 MN/m and, in one cross term, 0.5 MN/m.
pub fn cross_coupled() -> Bearing {
    Bearing {
        stiffness: [[1e6, 5e5], [0.0, 1e6]],
        damping: [[0.0; 2]; 2],
    }
}

/// Every rotor that is compared with ROSS, by the name that both sides use.
pub fn all() -> Result<Vec<(&'static str, BeamModel)>, BeamError> {
    let plain = Bearing::isotropic(1e6, 0.0);
    Ok(vec![
        ("isotropic", two_discs(6, plain, 0.0)?),
        (
            "anisotropic",
            two_discs(12, Bearing::orthotropic([1e6, 8e5], [0.0; 2]), 0.0)?,
        ),
        ("cross_coupled", two_discs(12, cross_coupled(), 0.0)?),
        ("damped", two_discs(6, Bearing::isotropic(1e6, 3e3), 0.0)?),
        ("overhung", overhung()?),
        ("tension", two_discs(12, plain, 1e5)?),
        ("compression", two_discs(12, plain, -1e5)?),
        ("tapered_12", tapered(12)?),
        ("tapered_48", tapered(48)?),
        ("nelson_mcvaugh", nelson_mcvaugh(true)?),
    ])
}
