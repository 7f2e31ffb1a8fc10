//! The closed loop from one repetition to the next: exact, its slower loops included.

use compensator::DriveFilter;
use nalgebra::{DMatrix, DVector, Schur};

use crate::law::{LoopGains, common};
use crate::loops::CornerLoop;
use crate::plant::LoopModel;

/// Where each state of the drive is, behind those of the machine.
struct Places {
    integral: usize,
    set_point: usize,
    effort: usize,
    /// Angle and speed that were derived last.
    angle: usize,
    speed: usize,
    /// Position one and two cycles ago.
    positions: [usize; 2],
    /// Two states each: of the speed, of the command (two), of the blend.
    filters: [[usize; 2]; 4],
    /// What the sensors showed before, the newest first.
    load_past: usize,
    motor_past: usize,
    count: usize,
}

/// Greatest eigenvalue of the closed loop, per control cycle: below 1 where it is stable.
///
/// What the axis does in as many cycles as its loops take to repeat is linear, and its matrix is what
/// comes of each state by itself.
pub(crate) fn radius(model: &LoopModel, corner: &CornerLoop, gains: &LoopGains) -> f64 {
    let drive = &corner.drive;
    let n = drive.size() - 1;
    let signal_path = model.signal_path();
    let sensing = &model.sensing;
    let (speed_every, position_every) = (
        signal_path.speed_every.max(1),
        signal_path.position_every.max(1),
    );
    let cycles = speed_every / common(speed_every, position_every) * position_every;
    let past = |delay: f64| match delay {
        0.0 => 0,
        delay => delay as usize + 1,
    };
    let (loads, motors) = (past(sensing.load_delay), past(sensing.motor_delay));
    let at = |i: usize| n + i;
    let places = Places {
        integral: at(0),
        set_point: at(1),
        effort: at(2),
        angle: at(3),
        speed: at(4),
        positions: [at(5), at(6)],
        filters: [
            [at(7), at(8)],
            [at(9), at(10)],
            [at(11), at(12)],
            [at(13), at(14)],
        ],
        load_past: at(15),
        motor_past: at(15) + loads,
        count: at(15) + loads + motors,
    };
    let cycle = Cycle {
        model,
        gains,
        n,
        a: drive.a.view((0, 0), (n, n)).into_owned(),
        b: drive.b.rows(0, n) / model.model.effort_limit,
        rows: [&drive.motor, &drive.motor_speed, &drive.load]
            .map(|row| row.columns(0, n).transpose()),
        places: &places,
        past: [loads, motors],
        unused: places.unused(model, gains),
    };
    let mut turn = DMatrix::zeros(places.count, places.count);
    for j in 0..places.count {
        let mut x = DVector::zeros(places.count);
        x[j] = 1.0;
        for k in 0..cycles {
            x = cycle.run(k, x);
        }
        turn.set_column(j, &x);
    }
    let _ = nalgebra::linalg::balancing::balance_parlett_reinsch(&mut turn);
    let greatest = Schur::try_new(turn, f64::EPSILON, 10_000).map_or(f64::INFINITY, |schur| {
        let eigenvalues = schur.complex_eigenvalues();
        eigenvalues.iter().map(|z| z.norm()).fold(0.0, f64::max)
    });
    greatest.powf(1.0 / f64::from(cycles))
}

impl Places {
    /// States that this drive does not have: they would keep what they are for ever.
    fn unused(&self, model: &LoopModel, gains: &LoopGains) -> Vec<usize> {
        let signal_path = model.signal_path();
        let filters = [
            signal_path.speed.is_some(),
            signal_path.command[0].is_some(),
            signal_path.command[1].is_some(),
            signal_path.blend.is_some(),
        ];
        let mut all = Vec::new();
        if gains.integral == 0.0 {
            all.push(self.integral);
        }
        if !model.sensing.by_differences {
            all.extend([self.angle, self.speed]);
        }
        if !signal_path.speed_of_position {
            all.extend(self.positions);
        }
        for (states, is_there) in self.filters.into_iter().zip(filters) {
            if !is_there {
                all.extend(states);
            }
        }
        all
    }
}

struct Cycle<'a> {
    model: &'a LoopModel,
    gains: &'a LoopGains,
    n: usize,
    a: DMatrix<f64>,
    b: DVector<f64>,
    /// Motor's angle, its speed, load.
    rows: [DVector<f64>; 3],
    places: &'a Places,
    past: [usize; 2],
    unused: Vec<usize>,
}

impl Cycle<'_> {
    /// The state a control cycle later, `k` cycles after all loops ran together; in the order of the
    /// simulated loop: sensors, position controller, speed controller, machine.
    fn run(&self, k: u32, mut x: DVector<f64>) -> DVector<f64> {
        let (model, p) = (self.model, self.places);
        let (signal_path, sensing) = (model.signal_path(), &model.sensing);
        let travel = model.model.travel;
        let machine = x.rows(0, self.n).into_owned();
        let [angle, mut speed, load] = [0, 1, 2].map(|i| self.rows[i].dot(&machine));
        let mut load = delayed(&mut x, p.load_past, self.past[0], sensing.load_delay, load);
        let mut angle = delayed(
            &mut x,
            p.motor_past,
            self.past[1],
            sensing.motor_delay,
            angle,
        );
        if sensing.motor_from_load {
            angle = load / travel;
        }
        let runs = k.is_multiple_of(signal_path.speed_every.max(1));
        if sensing.by_differences {
            if runs {
                x[p.speed] = (angle - x[p.angle])
                    / (model.period() * f64::from(signal_path.speed_every.max(1)));
                x[p.angle] = angle;
            }
            speed = x[p.speed];
        }
        if sensing.load_from_motor {
            load = angle * travel;
        }
        if signal_path.speed_of_position {
            speed = (load - x[p.positions[1]]) / (2.0 * model.period() * travel);
            x[p.positions[1]] = x[p.positions[0]];
            x[p.positions[0]] = load;
        }
        if k.is_multiple_of(signal_path.position_every.max(1)) {
            let motor = angle * travel;
            let position = match (&signal_path.blend, model.cascade().from_motor) {
                (Some(_), _) => {
                    let blend = signal_path.blend.as_ref();
                    motor + filtered(blend, p.filters[3], &mut x, load - motor)
                }
                (None, true) => motor,
                (None, false) => load,
            };
            x[p.set_point] = -self.gains.position * position;
        }
        if runs {
            let seen = filtered(signal_path.speed.as_ref(), p.filters[0], &mut x, speed);
            let error = x[p.set_point] - seen;
            let every = f64::from(signal_path.speed_every.max(1));
            let summed = if model.is_pid { x[p.set_point] } else { error };
            x[p.integral] += self.gains.integral * every * model.period() * summed;
            let mut command = self.gains.speed * error + x[p.integral];
            for (filter, at) in signal_path.command.iter().zip(&p.filters[1..3]) {
                command = filtered(filter.as_ref(), *at, &mut x, command);
            }
            x[p.effort] = command;
        }
        let next = &self.a * machine + &self.b * x[p.effort];
        x.rows_mut(0, self.n).copy_from(&next);
        for place in &self.unused {
            x[*place] = 0.0;
        }
        x
    }
}

/// What a sensor shows that is late by `delay` cycles, `count` values of it before at `from`.
fn delayed(x: &mut DVector<f64>, from: usize, count: usize, delay: f64, now: f64) -> f64 {
    if count == 0 {
        return now;
    }
    let whole = delay.floor();
    let of = |x: &DVector<f64>, age: usize| if age == 0 { now } else { x[from + age - 1] };
    let part = delay - whole;
    let shown = (1.0 - part) * of(x, whole as usize) + part * of(x, whole as usize + 1);
    for i in (1..count).rev() {
        x[from + i] = x[from + i - 1];
    }
    x[from] = now;
    shown
}

/// A sample through a filter whose memory is part of a state; as it is without one.
fn filtered(filter: Option<&DriveFilter>, at: [usize; 2], x: &mut DVector<f64>, input: f64) -> f64 {
    let Some(filter) = filter else {
        return input;
    };
    let mut memory = at.map(|place| x[place]);
    let output = filter.step(&mut memory, input);
    for (place, value) in at.into_iter().zip(memory) {
        x[place] = value;
    }
    output
}
