use axis_thermal::{FittedGrowth, GrowthFit, GrowthLog, GrowthStretch, ThermalModel, ThermalUnknown};
use independent_axis::{HeatHours, HeatedScrew, Random, there_and_back};
use crate::brute_force::duty;
use crate::identify::assumed;

fn log(seed: u64, rho: f64) -> GrowthLog {
    let of = HeatHours::to_fit();
    let air = of.air;
    let m = ThermalModel::new(assumed()).unwrap();
    let mut machine = HeatedScrew::other(air(0.0));
    let mut random = Random::new(7, seed);
    let mut log = GrowthLog::default();
    for (motion, count) in &of.duties {
        let duty = duty(&m, motion.as_ref());
        for _ in 0..*count {
            let (from, spent) = (machine.time, machine.friction_heat);
            machine.run(motion.as_ref(), 300.0, air);
            let found = match log.stretches.len() % 2 {
                1 => [0.5, 1.1].map(|x| [x, machine.growth(air(0.0), x) + 0.5e-6 * random.normal()]).to_vec(),
                _ => Vec::new(),
            };
            let power = (machine.friction_heat - spent) / 300.0 * (1.0 + rho * random.normal());
            log.stretches.push(GrowthStretch { duty: duty.clone(), duration: 300.0, air: [air(from), air(machine.time)], found, friction: Some(power), temperatures: Vec::new() });
        }
    }
    log
}

fn report(name: &str, fit: &FittedGrowth) {
    let model = ThermalModel::new(fit.parameters.clone()).unwrap();
    let stroke = there_and_back(0.45, 0.95, 0.2, 1.0);
    let d = duty(&model, Some(&stroke));
    let mut state = model.at_rest(20.0);
    let mut machine = HeatedScrew::other(20.0);
    let work = model.under(&d).unwrap();
    print!("{name:<40}");
    let mut last = 0.0;
    for t in [0.0, 300.0, 1200.0, 3600.0] {
        work.run(&mut state, 20.0, t - last).ok();
        machine.run(Some(&stroke), t - last, |_| 20.0);
        last = t;
        let f = work.friction_factors(&state);
        let g = (0..50).map(|k| machine.friction_factors(0.455 + 0.01 * f64::from(k))).fold([0.0; 2], |s, f| [s[0] + f[0] / 50.0, s[1] + f[1] / 50.0]);
        print!(" mid {:.4}", machine.friction_factors(0.7)[0]);
        // torque at 200 mm/s: dry share
        let p = d.friction_power();
        print!(" | {:.4} {:.4} vs {:.4} {:.4} P {:+.3}%", f[0], f[1], g[0], g[1], 100.0 * ((p[0]*f[0]+p[1]*f[1])/(p[0]*g[0]+p[1]*g[1]) - 1.0));
    }
    println!();
}


/// With a slow stroke of a minute in each ten.
fn slow(seed: u64, rho: f64, speed: f64) -> GrowthLog {
    let of = HeatHours::to_fit();
    let air = of.air;
    let m = ThermalModel::new(assumed()).unwrap();
    let mut machine = HeatedScrew::other(air(0.0));
    let mut random = Random::new(7, seed);
    let mut log = GrowthLog::default();
    let way = speed * 15.0;
    for (motion, count) in &of.duties {
        let work = duty(&m, motion.as_ref());
        for k in 0..*count {
            let mut parts = vec![(motion.clone(), work.clone(), 300.0)];
            if k % 2 == 1 {
                let s = there_and_back(0.7, 0.7 + way, speed, 0.0);
                parts = vec![(motion.clone(), work.clone(), 240.0), (Some(s.clone()), duty(&m, Some(&s)), 60.0)];
            }
            let n = parts.len();
            for (i, (motion, d, time)) in parts.into_iter().enumerate() {
                let (from, spent) = (machine.time, machine.friction_heat);
                machine.run(motion.as_ref(), time, air);
                let found = match n == 2 && i == 1 {
                    true => [0.5, 1.1].map(|x| [x, machine.growth(air(0.0), x) + 0.5e-6 * random.normal()]).to_vec(),
                    _ => Vec::new(),
                };
                let power = (machine.friction_heat - spent) / time * (1.0 + rho * random.normal());
                log.stretches.push(GrowthStretch { duty: d, duration: time, air: [air(from), air(machine.time)], found, friction: Some(power), temperatures: Vec::new() });
            }
        }
    }
    log
}

#[test]
fn scratch_factors() {
    for seed in 3..6 {
        let how = GrowthFit::default();
        let all = ThermalUnknown::ALL;
        report(&format!("dry fall too, {seed}"), &assumed().fit(&[log(seed, 0.005)], &all, &how).unwrap());
        let l = [slow(seed, 0.005, 0.02)];
        report(&format!("slow 0.02 {seed}"), &assumed().fit(&l, &all, &how).unwrap());
    }
    report("slow exact", &assumed().fit(&[slow(3, 0.0, 0.02)], &ThermalUnknown::ALL, &GrowthFit::default()).unwrap());
}
