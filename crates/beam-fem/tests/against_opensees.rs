//! Values of OpenSees 3.7.1, as `docs/peers/beam/opensees.py` prints them.

use beam_fem::{
    BeamModel, CrossSection, Dof, LumpedMass, Material, SectionProperties, Shaft, Span,
};

/// Frequencies in the limit of many elements, Hz.
const THEIRS: [f64; 4] = [22.146538258, 128.364965346, 305.883706732, 616.068379183];

/// A tube by Cowper's coefficient for it (doi 10.1115/1.3625046), diameters in m.
fn tube(outer: f64, inner: f64, steel: &Material) -> CrossSection {
    let pi = std::f64::consts::PI;
    let moment = pi / 64.0 * (outer.powi(4) - inner.powi(4));
    let (m, nu) = (inner / outer, steel.poisson_ratio());
    let tube = (1.0 + m * m).powi(2);
    let shear = 6.0 * (1.0 + nu) * tube / ((7.0 + 6.0 * nu) * tube + (20.0 + 12.0 * nu) * m * m);
    CrossSection::general(SectionProperties {
        area: 0.25 * pi * (outer.powi(2) - inner.powi(2)),
        second_moment_y: moment,
        second_moment_z: moment,
        torsion_constant: 2.0 * moment,
        shear_coefficient_y: shear,
        shear_coefficient_z: shear,
    })
    .unwrap()
}

/// Our frequencies with so many elements in each span, Hz.
fn ours(elements: usize) -> Vec<f64> {
    let steel = Material::new(206e9, 0.3, 7850.0).unwrap();
    let spans = [(0.4, 0.05, 0.0), (0.5, 0.04, 0.02), (0.3, 0.03, 0.0)];
    let span = |(length, outer, inner)| {
        Span::uniform(length, elements, tube(outer, inner, &steel), steel.clone()).unwrap()
    };
    let mut model = BeamModel::new(Shaft::new(&spans.map(span)).unwrap());
    model.lateral_only();
    model.fix_everywhere(Dof::W);
    model.fix_everywhere(Dof::ThetaY);
    model.fix(0, Dof::V).unwrap();
    model.fix(0, Dof::ThetaZ).unwrap();
    model
        .add_mass(3 * elements, LumpedMass::point(3.0))
        .unwrap();
    model.add_ground_spring(Dof::V.at(elements), 2e6).unwrap();
    let modes = model.matrices().unwrap().natural_modes().unwrap();
    modes.frequencies_hz()
}

/// The limits, as the errors of both fall with the square of an element's length.
#[test]
fn a_stepped_shaft_with_a_mass_and_a_spring_swings_as_in_opensees() {
    let pairs = ours(16).into_iter().zip(ours(32));
    for ((coarse, fine), theirs) in pairs.zip(THEIRS) {
        let limit = fine + (fine - coarse) / 3.0;
        let error = limit / theirs - 1.0;
        println!("{limit:.9} {theirs:.9}: {error:.1e}");
        assert!(error.abs() < 1e-6, "{limit} {theirs}: {error:e}");
    }
}
