//! By how many samples one sequence comes behind another: correlation at every lag.

/// The lag, in samples, at which `y_k ≈ ± x_{k − lag}` correlates most, and the
/// correlation there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Peak {
    pub lag: f64,
    pub correlation: f64,
}

/// The peak of the magnitude of the normalised cross-correlation
///
/// ```text
/// ρ(l) = cov(x_{k−l}, y_k) / (σ_x σ_y),    |l| ≤ most,
/// ```
///
/// each lag over its own overlap, which is at least `least` samples; a parabola through
/// the three greatest values gives the part of a sample (C. Knapp, G. Carter, IEEE Trans.
/// ASSP 24 (1976) 320–327, doi:10.1109/TASSP.1976.1162830, on the method). `None` if
/// either does not vary.
pub(crate) fn peak(x: &[f64], y: &[f64], most: usize, least: usize) -> Option<Peak> {
    let (x, y) = (centred(x)?, centred(y)?);
    let products = cross(&x, &y);
    let (sx, sy) = (sums(&x), sums(&y));
    let n = products.len() as i64;
    let rho = |lag: i64| -> f64 {
        // y from `from` to `to` meets x from `from − lag`.
        let from = lag.max(0);
        let to = (y.len() as i64).min(x.len() as i64 + lag);
        let count = to - from;
        if count < least.max(2) as i64 {
            return 0.0;
        }
        let range = |s: &[[f64; 2]], a: i64, b: i64, i: usize| s[b as usize][i] - s[a as usize][i];
        let (mx, my) = (range(&sx, from - lag, to - lag, 0), range(&sy, from, to, 0));
        let count = count as f64;
        let vx = range(&sx, from - lag, to - lag, 1) - mx * mx / count;
        let vy = range(&sy, from, to, 1) - my * my / count;
        let product = products[lag.rem_euclid(n) as usize] - mx * my / count;
        let scale = (vx.max(0.0) * vy.max(0.0)).sqrt();
        // Next to nothing moves in this overlap.
        if scale < 1e-6 * (sx[sx.len() - 1][1] * sy[sy.len() - 1][1]).sqrt() {
            return 0.0;
        }
        product / scale
    };
    let most = most as i64;
    let best = (-most..=most).max_by(|&a, &b| {
        let by = rho(a).abs().total_cmp(&rho(b).abs());
        by.then(b.abs().cmp(&a.abs()))
    })?;
    let sign = rho(best).signum();
    let [a, b, c] = [best - 1, best, best + 1].map(|l| sign * rho(l));
    let bend = a - 2.0 * b + c;
    let part = if bend < 0.0 {
        0.5 * (a - c) / bend
    } else {
        0.0
    };
    Some(Peak {
        lag: best as f64 + part.clamp(-0.5, 0.5),
        correlation: sign * b,
    })
}

fn centred(x: &[f64]) -> Option<Vec<f64>> {
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    let most = x.iter().map(|v| (v - mean).abs()).fold(0.0, f64::max);
    (most > 0.0 && most.is_finite()).then(|| x.iter().map(|v| (v - mean) / most).collect())
}

/// Sums of the numbers and of their squares up to each place.
fn sums(x: &[f64]) -> Vec<[f64; 2]> {
    let mut all = Vec::with_capacity(x.len() + 1);
    let mut sum = [0.0; 2];
    all.push(sum);
    for v in x {
        sum = [sum[0] + v, sum[1] + v * v];
        all.push(sum);
    }
    all
}

/// Σ_k x_{k−l} y_k at index l, of negative lags from the end.
fn cross(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = (x.len() + y.len()).next_power_of_two();
    let (forward, back) = (axis_fourier::forward(n), axis_fourier::inverse(n));
    let transform = |v: &[f64]| {
        let mut time = v.to_vec();
        time.resize(n, 0.0);
        let mut out = forward.make_output_vec();
        // Fails only on wrong lengths.
        let _ = forward.process(&mut time, &mut out);
        out
    };
    let (a, b) = (transform(x), transform(y));
    let mut product: Vec<_> = a
        .iter()
        .zip(&b)
        .map(|(a, b)| a.conj() * b / n as f64)
        .collect();
    let mut out = back.make_output_vec();
    if let (Some(first), last) = (product.first().copied(), product.len() - 1) {
        // Both are real but for rounding, as the inverse demands.
        product[0].im = 0.0 * first.im;
        product[last].im = 0.0;
    }
    let _ = back.process(&mut product, &mut out);
    out
}
