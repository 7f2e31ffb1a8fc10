//! try
use axis_sim::effects::Machine;
use discrepancy::*;
fn main() {
    let machine = Machine::read("data/axes/emps.toml".as_ref()).unwrap();
    let Machine::Rigid(axis) = &machine else { return };
    let read = |f: &str| {
        let l = axis_log::read_log(f, &axis.log, &["position_ref_m", "position_m"]).unwrap();
        let s = axis_log::quality::check_sampling(&l);
        println!("{s:?}");
        (f.to_owned(), l, 1e-3)
    };
    let fit = LogSet::new(vec![read("../shared/data/emps/emps.csv")], &machine).unwrap();
    let check = LogSet::new(vec![read("../shared/data/emps/emps_pulses.csv")], &machine).unwrap();
    let t = std::time::Instant::now();
    let found = search(&machine, &fit, &check, &Settings::default(), |s| println!("{:.1?} {s}", t.elapsed())).unwrap();
    for n in &found.named { println!("{n:?}"); }
    for (s, k) in found.fit.state.shares.iter().zip(known_parameters(&machine)) { println!("{} {s}", k.name); }
    for e in &found.fit.state.effects { println!("{} {:?}", e.effect.name, e.values); }
    println!("left {:?}", found.leftover);
    for (set, st) in [(&fit, &found.base.state), (&fit, &found.fit.state), (&check, &found.base.state), (&check, &found.fit.state)] {
        let tr = set.simulate(&machine, st).unwrap();
        for (c, r) in set.rest(&tr)[0].iter().enumerate() { println!("{} rms {:.4e}", set.channels[c], (r[200..].iter().map(|x| x*x).sum::<f64>()/ (r.len()-200) as f64).sqrt() * if c==1 {35.15065} else {1.0}); }
    }
}
