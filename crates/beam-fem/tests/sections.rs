//! Sections, tapers and stepped shafts.

use std::f64::consts::PI;

use beam_fem::{
    Beam, BeamError, BeamModel, CrossSection, Dof, LumpedMass, Material, Mesh, SectionProperties,
    SectionShape, Shaft, Span,
};
use nalgebra::DVector;
use proptest::prelude::*;

fn steel() -> Material {
    Material::new(206e9, 0.3, 7850.0).unwrap()
}

fn close(found: f64, exact: f64, tolerance: f64) {
    assert!((found / exact - 1.0).abs() < tolerance, "{found} {exact}");
}

#[test]
fn a_hollow_circle_is_the_difference_of_two() {
    let outer = CrossSection::solid_circle(0.06, &steel()).unwrap();
    let inner = CrossSection::solid_circle(0.04, &steel()).unwrap();
    let tube = CrossSection::hollow_circle(0.06, 0.04, &steel()).unwrap();
    close(tube.area(), outer.area() - inner.area(), 1e-14);
    let i = outer.second_moment_y() - inner.second_moment_y();
    close(tube.second_moment_y(), i, 1e-14);
    close(tube.torsion_constant(), 2.0 * i, 1e-14);
    // Without a hole Cowper's formula is that of the solid; of a thin tube it is
    // 2(1+ν)/(4+3ν), the limit of it.
    let solid = CrossSection::hollow_circle(0.06, 0.0, &steel()).unwrap();
    close(solid.shear_coefficient(), outer.shear_coefficient(), 1e-15);
    let thin = CrossSection::hollow_circle(0.06, 0.06 * (1.0 - 1e-6), &steel()).unwrap();
    close(thin.shear_coefficient(), 2.6 / 4.9, 1e-6);
    close(thin.area(), PI * 0.06 * 0.03e-6, 1e-6);
}

#[test]
fn a_rectangle_has_the_torsion_of_saint_venant() {
    // J/(a b³) by a/b as Oasys's GSA reference, "Rectangular sections", tabulates it, each
    // to half of its last digit.
    let table = [
        (1.0, 0.141),
        (1.5, 0.196),
        (2.0, 0.229),
        (3.0, 0.263),
        (5.0, 0.291),
        (10.0, 0.312),
    ];
    for (ratio, factor) in table {
        for (height, width) in [(0.02 * ratio, 0.02), (0.02, 0.02 * ratio)] {
            let s = CrossSection::rectangle(height, width, &steel()).unwrap();
            let found = s.torsion_constant() / (ratio * 0.02_f64.powi(4));
            assert!((found - factor).abs() <= 5e-4, "{ratio} {found}");
        }
    }
    // Height is along y: it stiffens bending in x–y, about z.
    let s = CrossSection::rectangle(0.04, 0.02, &steel()).unwrap();
    close(s.second_moment_z() / s.second_moment_y(), 4.0, 1e-14);
    close(s.shear_coefficient(), 13.0 / 15.3, 1e-14);
}

#[test]
fn each_plane_has_its_own_shear_coefficient() {
    let section = CrossSection::general(SectionProperties {
        area: 1e-3,
        second_moment_y: 2e-7,
        second_moment_z: 3e-7,
        torsion_constant: 4e-7,
        shear_coefficient_y: 0.4,
        shear_coefficient_z: 0.7,
    })
    .unwrap();
    let (e, g) = (steel().youngs_modulus(), steel().shear_modulus());
    let l = 0.2_f64;
    let beam = Beam::new(section, steel(), Mesh::uniform(l, 3).unwrap());
    let free = beam.assemble().unwrap().fixed(&[0, 1, 2, 3, 4, 5]).unwrap();
    let solve = free.stiffness.clone().cholesky().unwrap();
    for (dof, i, kappa) in [(Dof::V, 3e-7, 0.4), (Dof::W, 2e-7, 0.7)] {
        let mut load = DVector::zeros(18);
        load[12 + dof as usize] = 1.0;
        let exact = l.powi(3) / (3.0 * e * i) + l / (kappa * g * 1e-3);
        close(solve.solve(&load)[12 + dof as usize], exact, 1e-12);
    }
}

/// Compliance of the end of a shaft whose start is clamped.
fn tip(spans: &[Span], dof: Dof) -> f64 {
    let mut model = BeamModel::new(Shaft::new(spans).unwrap());
    model.clamp(0).unwrap();
    let system = model.matrices().unwrap();
    let row = system.row(dof.at(model.nodes() - 1)).unwrap();
    let mut load = DVector::zeros(system.order());
    load[row] = 1.0;
    system.stiffness.clone().cholesky().unwrap().solve(&load)[row]
}

#[test]
fn a_cone_bends_twists_and_stretches_exactly_on_any_mesh() {
    // Diameter d_a at the clamp, d_b at the tip: ∫(L−x)²/EI = PL³/(3E I_a) d_a/d_b,
    // ∫dx/A = L/(π/4 d_a d_b), ∫dx/I_p = (32 L/3π)(1/d_b³ − 1/d_a³)/(d_a − d_b).
    let (a, b, l) = (0.05_f64, 0.02_f64, 0.4_f64);
    let (e, g) = (steel().youngs_modulus(), steel().shear_modulus());
    let kappa = CrossSection::solid_circle(a, &steel())
        .unwrap()
        .shear_coefficient();
    let ends = [SectionShape::solid(a), SectionShape::solid(b)];
    let stretch = l / (0.25 * PI * a * b);
    let bend = l.powi(3) / (3.0 * e * PI * a.powi(4) / 64.0) * a / b;
    let twist = 32.0 * l / (3.0 * PI * g) * (b.powi(-3) - a.powi(-3)) / (a - b);
    for elements in [1, 2, 7] {
        let span = [Span::tapered(l, elements, ends, steel()).unwrap()];
        // 2e-15 measured.
        close(tip(&span, Dof::U), stretch / e, 1e-13);
        close(tip(&span, Dof::V), bend + stretch / (kappa * g), 1e-13);
        close(tip(&span, Dof::W), bend + stretch / (kappa * g), 1e-13);
        close(tip(&span, Dof::ThetaX), twist, 1e-13);
    }
}

#[test]
fn a_stepped_cantilever_deflects_as_its_spans_add() {
    let (big, small) = (0.05, 0.03);
    let section = |d| CrossSection::solid_circle(d, &steel()).unwrap();
    let (one, two) = (section(big), section(small));
    let (a, b) = (0.3_f64, 0.2_f64);
    let spans = [
        Span::uniform(a, 2, one.clone(), steel()).unwrap(),
        Span::uniform(b, 3, two.clone(), steel()).unwrap(),
    ];
    let (e, g) = (steel().youngs_modulus(), steel().shear_modulus());
    let l = a + b;
    let bend = (l.powi(3) - b.powi(3)) / (3.0 * e * one.second_moment_z())
        + b.powi(3) / (3.0 * e * two.second_moment_z());
    let shear = a / (one.shear_coefficient() * g * one.area())
        + b / (two.shear_coefficient() * g * two.area());
    close(tip(&spans, Dof::V), bend + shear, 1e-12);
}

#[test]
fn a_taper_is_the_limit_of_steps() {
    // Steps of uniform elements (their own code) with the diameter of their middle have
    // an error of order 2: extrapolated from 48 and 96 steps.
    let ends = [0.025, 0.040];
    let natural = |spans: &[Span], middle: usize| {
        let mut model = BeamModel::new(Shaft::new(spans).unwrap());
        model.add_mass(middle, LumpedMass::point(5.0)).unwrap();
        let last = model.nodes() - 1;
        for node in [0, last] {
            for dof in [Dof::V, Dof::W] {
                model.fix(node, dof).unwrap();
            }
        }
        model.lateral_only();
        let all = model.matrices().unwrap().natural_modes().unwrap();
        [0, 2, 4].map(|mode| all.frequencies_rad_s[mode])
    };
    let steps = |n: usize| {
        let diameter = |i: usize| ends[0] + (ends[1] - ends[0]) * (i as f64 + 0.5) / n as f64;
        let span = |i| {
            let section = CrossSection::solid_circle(diameter(i), &steel()).unwrap();
            Span::uniform(1.5 / n as f64, 1, section, steel()).unwrap()
        };
        natural(&(0..n).map(span).collect::<Vec<_>>(), n / 2)
    };
    let taper = |n: usize| {
        let shapes = ends.map(SectionShape::solid);
        natural(&[Span::tapered(1.5, n, shapes, steel()).unwrap()], n / 2)
    };
    let (coarse, fine, exact) = (steps(48), steps(96), taper(48));
    let few = taper(12);
    for mode in 0..3 {
        let limit = fine[mode] + (fine[mode] - coarse[mode]) / 3.0;
        // 2.9e-8, 2.6e-6, 7.1e-6 measured; 12 elements against 48: 1.3e-6, 9.0e-5, 2.4e-4.
        close(exact[mode], limit, 1e-5);
        close(few[mode], exact[mode], 5e-4);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A taper that does not taper is a uniform shaft, in every matrix, and any element
    /// has the mass and the inertia of its solid.
    #[test]
    fn a_taper_of_equal_ends_is_uniform(
        height in 0.01..0.2_f64, width in 0.01..0.2_f64, length in 0.05..2.0_f64, force in -1e5..1e5_f64,
    ) {
        let shape = SectionShape::Rectangle { height, width };
        let section = shape.section(&steel()).unwrap();
        let build = |span| {
            let mut model = BeamModel::new(Shaft::new(&[span]).unwrap());
            model.set_axial_force(force).unwrap();
            model.matrices().unwrap()
        };
        let taper = build(Span::tapered(length, 2, [shape, shape], steel()).unwrap());
        let plain = build(Span::uniform(length, 2, section, steel()).unwrap());
        for (a, b) in [
            (&taper.mass, &plain.mass),
            (&taper.stiffness, &plain.stiffness),
            (&taper.geometric, &plain.geometric),
            (&taper.gyroscopic, &plain.gyroscopic),
        ] {
            prop_assert!((a - b).amax() <= 1e-11 * b.amax());
        }
    }

    /// Rigid motions cost a taper nothing, and its mass is that of a frustum.
    #[test]
    fn a_taper_moves_rigidly(
        a in 0.01..0.2_f64, b in 0.01..0.2_f64, share in 0.0..0.9_f64, length in 0.05..2.0_f64,
    ) {
        let circle = |outer: f64| SectionShape::Circle { outer, inner: share * outer };
        let span = Span::tapered(length, 1, [circle(a), circle(b)], steel()).unwrap();
        let system = BeamModel::new(Shaft::new(&[span]).unwrap()).matrices().unwrap();
        let (k, m) = (&system.stiffness, &system.mass);
        let volume = PI * length * (1.0 - share * share) * (a * a + a * b + b * b) / 12.0;
        for dof in [Dof::U, Dof::V, Dof::W] {
            let mut q = DVector::zeros(12);
            (q[dof.at(0)], q[dof.at(1)]) = (1.0, 1.0);
            prop_assert!((k * &q).amax() <= 1e-10 * k.amax());
            prop_assert!((q.dot(&(m * &q)) / (7850.0 * volume) - 1.0).abs() < 1e-12);
        }
        // θz with v = x θz, θy with w = −x θy: the slope of an axial load and no strain.
        for (turn, shift, sign) in [(Dof::ThetaZ, Dof::V, 1.0), (Dof::ThetaY, Dof::W, -1.0)] {
            let mut q = DVector::zeros(12);
            (q[turn.at(0)], q[turn.at(1)], q[shift.at(1)]) = (1.0, 1.0, sign * length);
            prop_assert!((k * &q).amax() <= 1e-9 * k.amax());
        }
    }
}

#[test]
fn bad_shapes_and_spans_are_named() {
    let message = |e: BeamError| e.to_string();
    let hole = CrossSection::hollow_circle(0.05, 0.05, &steel()).unwrap_err();
    assert!(message(hole).contains("below the outer diameter"));
    assert!(CrossSection::hollow_circle(0.05, -0.01, &steel()).is_err());
    assert!(CrossSection::rectangle(0.0, 0.1, &steel()).is_err());
    assert!(CrossSection::rectangle(f64::NAN, 0.1, &steel()).is_err());
    let mixed = [
        SectionShape::solid(0.05),
        SectionShape::Rectangle {
            height: 0.1,
            width: 0.1,
        },
    ];
    let taper = Span::tapered(1.0, 3, mixed, steel()).unwrap_err();
    assert!(message(taper).contains("a taper from a circle to a rectangle"));
    assert!(Span::tapered(1.0, 0, [SectionShape::solid(0.1); 2], steel()).is_err());
    assert!(Span::tapered(-1.0, 1, [SectionShape::solid(0.1); 2], steel()).is_err());
    let none = Shaft::new(&[]).unwrap_err();
    assert!(message(none).contains("spans is empty"));
    let section = CrossSection::solid_circle(0.1, &steel()).unwrap();
    let span = |l| Span::uniform(l, 1, section.clone(), steel()).unwrap();
    assert!(matches!(
        Shaft::new(&[span(1.0), span(1e-12)]),
        Err(BeamError::Spacing { .. })
    ));
    assert!(matches!(
        Shaft::new(&[span(1.0), span(1e-20)]),
        Err(BeamError::Node { .. } | BeamError::Spacing { .. })
    ));
}
