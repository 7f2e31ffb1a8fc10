//! Assembly and modes of long meshes, and the small matrices of an axis.

use std::hint::black_box;

use beam_fem::{Beam, CrossSection, Dof, Material, Mesh, MovingNode, lowest_modes, natural_modes};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

fn screw(mesh: Mesh) -> Beam {
    let steel = Material::new(206e9, 0.3, 7850.0).expect("valid");
    let section = CrossSection::solid_circle(0.04, &steel).expect("valid");
    Beam::new(section, steel, mesh)
}

fn uniform(elements: usize) -> Beam {
    screw(Mesh::uniform(1.5, elements).expect("valid"))
}

/// Every element of another length, and I_y ≠ I_z: nothing can be reused.
fn uneven(elements: usize) -> Beam {
    let step = |i: usize| 1.5 * i as f64 / elements as f64;
    let node = |i: usize| step(i) * (1.0 + 1e-3 * (i as f64).sin() / elements as f64);
    let mesh = Mesh::from_nodes((0..=elements).map(node).collect()).expect("valid");
    let round = screw(mesh);
    let s = &round.section;
    let (y, z) = (0.9 * s.second_moment_y(), s.second_moment_z());
    let flat = CrossSection::new(s.area(), y, z, y + z, s.shear_coefficient()).expect("valid");
    Beam::new(flat, round.material, round.mesh)
}

fn assembly(c: &mut Criterion) {
    let mut group = c.benchmark_group("assemble_banded");
    for elements in [100, 1000, 10_000] {
        group.throughput(Throughput::Elements(elements as u64));
        for (name, beam) in [("uniform", uniform(elements)), ("uneven", uneven(elements))] {
            let mut matrices = beam.assemble_banded();
            group.bench_function(BenchmarkId::new(name, elements), |b| {
                b.iter(|| beam.assemble_banded_into(black_box(&mut matrices)));
            });
        }
    }
    group.finish();
}

fn modes(c: &mut Criterion) {
    let mut group = c.benchmark_group("lowest_modes");
    group.sample_size(20);
    for elements in [250, 1000, 4000] {
        let free = uniform(elements).assemble_banded();
        let clamped = free.fixed(&[0, 1, 2, 3, 4, 5]).expect("valid");
        let pins = [Dof::U, Dof::ThetaX, Dof::V, Dof::W].map(|dof| dof.at(0));
        let far = [Dof::V, Dof::W].map(|dof| dof.at(elements));
        let pinned = free.fixed(&[&pins[..], &far[..]].concat()).expect("valid");
        let cases = [
            ("free, 6 rigid + 6 elastic", &free, 12),
            ("clamped, 6", &clamped, 6),
            ("pinned, 6", &pinned, 6),
        ];
        for (name, matrices, count) in cases {
            group.bench_function(BenchmarkId::new(name, elements), |b| {
                b.iter(|| lowest_modes(black_box(matrices), count));
            });
        }
        // Springs at the middle that couple all six directions of a node.
        let mut coupled = free.clone();
        for i in 0..6 {
            for j in 0..=i {
                let node = 6 * (elements / 2);
                let value = if i == j { 1e5 } else { 1e4 };
                coupled
                    .stiffness
                    .add(node + i, node + j, value)
                    .expect("valid");
            }
        }
        group.bench_function(BenchmarkId::new("coupled, 12", elements), |b| {
            b.iter(|| lowest_modes(black_box(&coupled), 12));
        });
    }
    group.finish();
}

fn axis(c: &mut Criterion) {
    let steel = Material::new(206e9, 0.3, 7850.0).expect("valid");
    let section = CrossSection::solid_circle(0.04, &steel).expect("valid");
    c.bench_function("element matrices, 12 x 12", |b| {
        b.iter(|| {
            let l = black_box(0.15);
            let k = beam_fem::element::stiffness(&section, &steel, l);
            (k, beam_fem::element::mass(&section, &steel, l))
        });
    });
    c.bench_function("moving node and torsion, N = 10", |b| {
        b.iter(|| {
            let nut = MovingNode::at(1.5, 10, black_box(0.65), MovingNode::MIN_FRACTION);
            nut.map(|nut| screw(nut.mesh().clone()).torsion())
        });
    });
    let m = uniform(10).assemble().expect("small");
    c.bench_function("dense modes, N = 10", |b| {
        b.iter(|| natural_modes(black_box(&m.mass), &m.stiffness));
    });
}

criterion_group!(benches, assembly, modes, axis);
criterion_main!(benches);
