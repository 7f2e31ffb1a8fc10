#![allow(missing_docs)]
use axis_sim::Axis;
use discover_matrix::matrix2::{Bench, CaseOutcome, Channels, MatrixPlan, TARGETS, cases};
use rayon::prelude::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let (seed, size): (u64, usize) = (a[1].parse().unwrap(), a[2].parse().unwrap());
    let only: Vec<&str> = a[4..].iter().map(|s| s.as_str()).collect();
    let machines: Vec<Axis> = ["liu2025", "joint", "linear-motor"]
        .iter()
        .map(|n| Axis::read(format!("data/axes/{n}.toml").as_ref()).unwrap())
        .collect();
    let all = cases(&machines, &MatrixPlan::of(size), seed).unwrap();
    let all: Vec<_> = all
        .into_iter()
        .filter(|c| c.setting.channels == Channels::Balance)
        .filter(|c| only.is_empty() || only.iter().any(|o| c.id.starts_with(o)))
        .collect();
    let mut plots: Vec<Vec<discover_matrix::matrix2::Case>> = Vec::new();
    for c in all {
        match plots.last_mut() {
            Some(l) if l[0].plot == c.plot => l.push(c),
            _ => plots.push(vec![c]),
        }
    }
    let out: Vec<CaseOutcome> = plots
        .par_iter()
        .flat_map_iter(|cases| {
            let axis = machines
                .iter()
                .find(|m| m.name == cases[0].setting.machine)
                .unwrap();
            let bench = Bench::new(axis, &cases[0].setting);
            cases
                .iter()
                .map(|c| match &bench {
                    Ok(b) => b.try_case(c),
                    Err(e) => CaseOutcome::failed(c, e.to_string()),
                })
                .collect::<Vec<_>>()
        })
        .collect();
    std::fs::write(&a[3], serde_json::to_vec(&out).unwrap()).unwrap();
    for t in TARGETS {
        let r = t.rate(&out);
        println!("{:80} {}/{}", t.name, r.hits, r.of);
    }
}
