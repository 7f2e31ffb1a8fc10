//! The loop cut at the plant's input: its frequency response and its eigenvalues.
//!
//! Where the drive's loops repeat after N periods, so does the loop: what it does in N of them is
//! one step of a loop with N inputs and outputs, and its sensitivity is the greatest gain from
//! whatever disturbs the command to what the command becomes, over all periods together
//! (lifting; P. P. Khargonekar, K. Poolla, A. Tannenbaum, "Robust control of linear
//! time-invariant plants using periodic compensation", IEEE Trans. Autom. Control 30, 1985,
//! doi:10.1109/TAC.1985.1103841). For N = 1 that is the greatest |S|.

use nalgebra::{Complex, DMatrix, DVector, RowDVector, Schur};
use std::vec::Vec;

use super::Design;
use super::drive_loops::{Commanding, phases};
use super::hessenberg::SampledResponse;
use super::linear::SampledDrive;
use crate::model::DriveModel;

/// Frequencies, evenly spread over the logarithm up to half the rate at which the loop repeats.
const FREQUENCIES: usize = 300;
/// Lowest frequency, of half the sampling rate.
const LOWEST: f64 = 2e-5;
/// Most cycles of delay that are tried of a loop that repeats after several.
const MOST_CYCLES: usize = 16;

/// A plant under an observer, a state feedback and the drive's loops.
pub(super) struct Loop<'a> {
    plant: &'a SampledDrive,
    phases: Vec<Commanding>,
}

/// A loop that is open at the plant's input: z(k+1) = F z + g v, and −v comes back as h z.
struct Open {
    f: Vec<DMatrix<f64>>,
    g: DVector<f64>,
    h: Vec<RowDVector<f64>>,
}

impl<'a> Loop<'a> {
    pub fn new(plant: &'a SampledDrive, model: &DriveModel, design: &Design) -> Self {
        Self {
            plant,
            phases: phases(model, design),
        }
    }

    /// Periods after which the loop repeats.
    pub fn repeats(&self) -> usize {
        self.phases.len()
    }

    /// Open, with `late` more cycles of delay; the disturbance of the plant left out.
    fn open(&self, late: usize) -> Open {
        let (p, q) = (self.plant.size() - 1, self.phases[0].a.nrows());
        let (a, b) = (self.plant.a.view((0, 0), (p, p)), self.plant.b.rows(0, p));
        let c = self.plant.c.columns(0, p);
        let size = p + late + q;
        let mut g = DVector::zeros(size);
        match late {
            0 => g.rows_mut(0, p).copy_from(&b),
            _ => g[p + late - 1] = 1.0,
        }
        let of = |law: &Commanding| {
            let mut f = DMatrix::zeros(size, size);
            f.view_mut((0, 0), (p, p)).copy_from(&a);
            if late > 0 {
                f.view_mut((0, p), (p, 1)).copy_from(&b);
            }
            for j in 1..late {
                f[(p + j - 1, p + j)] = 1.0;
            }
            f.view_mut((p + late, 0), (q, p)).copy_from(&(&law.b * c));
            f.view_mut((p + late, p + late), (q, q)).copy_from(&law.a);
            let mut h = RowDVector::zeros(size);
            h.columns_mut(0, p).copy_from(&-(&law.d * c));
            h.columns_mut(p + late, q).copy_from(&-&law.c);
            (f, h)
        };
        let (f, h) = self.phases.iter().map(of).unzip();
        Open { f, g, h }
    }

    /// Greatest eigenvalue of the closed loop, a cycle, with `late` more cycles of delay.
    pub fn radius(&self, late: usize) -> f64 {
        let open = self.open(late);
        let size = open.g.len();
        let closed = open.f.iter().zip(&open.h).map(|(f, h)| f - &open.g * h);
        let turn = closed.fold(DMatrix::identity(size, size), |before, m| m * before);
        let greatest = Schur::try_new(turn, f64::EPSILON, 10_000).map_or(f64::INFINITY, |schur| {
            let eigenvalues = schur.complex_eigenvalues();
            eigenvalues
                .iter()
                .map(|z| libm::hypot(z.re, z.im))
                .fold(0.0, f64::max)
        });
        match self.repeats() {
            1 => greatest,
            cycles => libm::pow(greatest, 1.0 / cycles as f64),
        }
    }

    /// Delay that the loop takes, s, where it repeats after several periods: in whole ones, as
    /// long as it stays stable.
    pub fn whole_delay(&self, period: f64) -> f64 {
        let stable = |late: &usize| self.radius(*late) < 1.0;
        let cycles = (1..=MOST_CYCLES).take_while(stable).count();
        cycles as f64 * period
    }

    /// Greatest sensitivity; and the delay margin in s of a loop that does the same in each
    /// period, infinite of others.
    pub fn frequencies(&self, late: usize, period: f64) -> (f64, f64) {
        let (mut greatest, mut delay) = (0.0f64, f64::INFINITY);
        let mut before: Option<(f64, Complex<f64>)> = None;
        let response = lifted(&self.open(late));
        for i in 0..=FREQUENCIES {
            let share = libm::pow(LOWEST, 1.0 - i as f64 / FREQUENCIES as f64);
            // Of one step of the loop that repeats.
            let angle = std::f64::consts::PI * share;
            let (sine, cosine) = libm::sincos(angle);
            let Some(l) = response.at(Complex::new(cosine, sine)) else {
                return (f64::INFINITY, 0.0);
            };
            if l.nrows() > 1 {
                greatest = greatest.max(1.0 / least_gain(&l));
                continue;
            }
            let l = l[(0, 0)];
            let one = l + Complex::new(1.0, 0.0);
            greatest = greatest.max(1.0 / libm::hypot(one.re, one.im));
            let size = |l: Complex<f64>| libm::hypot(l.re, l.im);
            if let Some((last, l0)) = before
                && (size(l0) - 1.0) * (size(l) - 1.0) <= 0.0
            {
                // Phase above −180°, by the angle at the crossing.
                let lead = libm::atan2(-l.im, -l.re);
                let lead = if lead < 0.0 {
                    lead + 2.0 * std::f64::consts::PI
                } else {
                    lead
                };
                delay = delay.min(lead / (0.5 * (last + angle)) * period);
            }
            before = Some((angle, l));
        }
        (greatest, delay)
    }
}

/// All periods until it repeats as one step with as many inputs and outputs.
fn lifted(open: &Open) -> SampledResponse {
    let (size, n) = (open.g.len(), open.f.len());
    let mut from_start = DMatrix::identity(size, size);
    // What each input has done to the state so far.
    let mut b = DMatrix::zeros(size, n);
    let (mut c, mut d) = (DMatrix::zeros(n, size), DMatrix::zeros(n, n));
    for (i, (f, h)) in open.f.iter().zip(&open.h).enumerate() {
        c.row_mut(i).copy_from(&(h * &from_start));
        d.row_mut(i).copy_from(&(h * &b));
        from_start = f * from_start;
        b = f * b;
        b.set_column(i, &open.g);
    }
    SampledResponse::new(from_start, &b, &c, d)
}

/// Least singular value of 1 + L.
fn least_gain(l: &DMatrix<Complex<f64>>) -> f64 {
    let n = l.nrows();
    // As a real matrix, whose singular values are the same, each twice.
    let real = DMatrix::from_fn(2 * n, 2 * n, |i, j| {
        let at = l[(i % n, j % n)];
        let one = if i == j { 1.0 } else { 0.0 };
        match (i < n, j < n) {
            (true, true) | (false, false) => one + at.re,
            (true, false) => -at.im,
            (false, true) => at.im,
        }
    });
    let least = real.svd(false, false).singular_values.min();
    if least.is_nan() { 0.0 } else { least }
}
