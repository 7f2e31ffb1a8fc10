//! A rigid body with an oscillator on it, sampled exactly, and noise.

use frequency_response::Complex;

/// Speed per held command: gain/s + φ s/(s² + 2ζ ω₀ s + ω₀²), and so many samples of delay.
#[derive(Clone, Copy)]
pub struct Machine {
    pub gain: f64,
    pub share: f64,
    pub omega: f64,
    pub zeta: f64,
    pub late: usize,
    pub period: f64,
}

impl Default for Machine {
    fn default() -> Self {
        Self {
            gain: 90.0,
            share: 60.0,
            omega: std::f64::consts::TAU * 63.0,
            zeta: 0.03,
            late: 2,
            period: 1e-3,
        }
    }
}

impl Machine {
    /// e^{−σT} cos, e^{−σT} sin/ω_d, and the two of a held input: speed and position of the oscillator.
    fn steps(&self) -> ([[f64; 2]; 2], [f64; 2]) {
        let (t, w, sigma) = (self.period, self.omega, self.zeta * self.omega);
        let wd = w * (1.0 - self.zeta * self.zeta).sqrt();
        let (e, c, s) = ((-sigma * t).exp(), (wd * t).cos(), (wd * t).sin() / wd);
        let a = [
            [e * (c + sigma * s), e * s],
            [-e * w * w * s, e * (c - sigma * s)],
        ];
        // Of a unit step: x = (1 − e(c + σ s))/ω², v = e s.
        (a, [(1.0 - a[0][0]) / (w * w), e * s])
    }

    /// The exact response at a frequency, Hz.
    pub fn response(&self, hz: f64) -> Complex<f64> {
        let z = Complex::from_polar(1.0, std::f64::consts::TAU * hz * self.period);
        let (a, b) = self.steps();
        // Second row of (zI − A)⁻¹ B of the 2 × 2.
        let det = (z - a[0][0]) * (z - a[1][1]) - a[0][1] * a[1][0];
        let v = ((z - a[0][0]) * b[1] + a[1][0] * b[0]) / det;
        let rigid = self.gain * self.period / (z - 1.0);
        (rigid + v * self.share) * z.powi(-(self.late as i32))
    }
}

/// The machine at work.
pub struct Running {
    machine: Machine,
    rigid: f64,
    x: [f64; 2],
    queue: Vec<f64>,
}

impl Running {
    pub fn new(machine: Machine) -> Self {
        Self {
            machine,
            rigid: 0.0,
            x: [0.0; 2],
            queue: vec![0.0; machine.late],
        }
    }

    pub fn speed(&self) -> f64 {
        self.rigid + self.machine.share * self.x[1]
    }

    pub fn push(&mut self, u: f64) {
        self.queue.push(u);
        let u = self.queue.remove(0);
        let (a, b) = self.machine.steps();
        self.rigid += self.machine.gain * self.machine.period * u;
        let [x, v] = self.x;
        self.x = [
            a[0][0] * x + a[0][1] * v + b[0] * u,
            a[1][0] * x + a[1][1] * v + b[1] * u,
        ];
    }
}

/// Normal numbers: a 64-bit linear congruential generator (Knuth's MMIX) and Box and Muller.
pub struct Noise(pub u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    pub fn normal(&mut self) -> f64 {
        let size = (-2.0 * self.uniform().ln()).sqrt();
        size * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// PI of the loops below, kp and ki.
pub const PI: [f64; 2] = [0.4, 2.0];

/// Command and measured speed of the machine under the controller, excited by r at the command, with noise
/// of that deviation at the measured speed.
pub fn closed(machine: Machine, r: &[f64], noise: f64, seed: u64) -> [Vec<f64>; 2] {
    let mut running = Running::new(machine);
    let mut random = Noise(seed);
    let mut integral = 0.0;
    let (mut us, mut ys) = (Vec::new(), Vec::new());
    for r in r {
        let y = running.speed() + noise * random.normal();
        integral -= PI[1] * machine.period * y;
        let u = r - PI[0] * y + integral;
        running.push(u);
        us.push(u);
        ys.push(y);
    }
    [us, ys]
}
