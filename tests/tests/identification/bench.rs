//! A real motor on a bench (github:TeacherRock/LuGre_Friction, no licence stated: not part of the project).
//! Nobody says its inertia, nothing runs at constant speed, and its encoder shows small motions in six steps.

use axis_log::read_log;
use axis_pipeline::identification::identify_from_logs;
use axis_sim::Axis;

use crate::balance::folder;

#[test]
fn friction_and_bristles_of_a_real_bench() {
    let from = "github:TeacherRock/LuGre_Friction, as CSV (data/axes/lugre-bench.toml)";
    let Some(folder) = folder("lugre-bench", from) else {
        return;
    };
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/axes/lugre-bench.toml");
    let text = std::fs::read_to_string(file).unwrap();
    // Where the authors fit Coulomb's and viscous friction: above 5 rad/s. Below it the bench's friction
    // is no steady-state curve of this law.
    let axis = Axis::parse(file, &(text + "\n[balance]\nslowest_rad_per_s = 5\n")).unwrap();
    let read = |name: &&str| {
        let log = read_log(folder.join(name), &axis.log, &[]).unwrap();
        ((*name).to_owned(), log)
    };
    let names = [
        "J_1.csv",
        "J_2.csv",
        "J_3.csv",
        "J_4.csv",
        "sigma0_1.csv",
        "sigma0_2.csv",
        "sigma0_3.csv",
    ];
    let logs: Vec<_> = names.iter().map(read).collect();
    let found = identify_from_logs(&axis, &logs).unwrap();
    for p in &found.parameters {
        println!("{} {:.4e} {:?} {:?}", p.name, p.value, p.interval, p.source);
    }
    println!("{:?} {:?}", found.notes, found.open);
    let [coulomb, _, _, _, stiffness, _] = found.parameters;
    // Least squares on J_1 where |speed| > 5 rad/s: 0.0321 N·m, 3.4 mN·m left
    // (shared/data/lugre-bench/SOURCE.md).
    assert!((coulomb.value / 0.0321 - 1.0).abs() < 0.15, "{coulomb:?}");
    let within = |[low, high]: [f64; 2], value: f64| low <= value && value <= high;
    assert!(
        coulomb.interval.is_some_and(|ends| within(ends, 0.0321)),
        "{coulomb:?}"
    );
    // ±0.012 N·m move it by ±3 counts of 2π/10 000 rad: 0.012/1.88e-3 = 6.4 N·m/rad at least, and 9.5
    // on the branches where it returns.
    assert!((5.0..12.0).contains(&stiffness.value), "{stiffness:?}");
}
