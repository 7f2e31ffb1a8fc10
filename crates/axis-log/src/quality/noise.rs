//! Noise and the filter that a channel went through, from its spectrum.

use crate::numeric::welch::density;

/// Noise of a channel, from the upper half of its spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelNoise {
    /// Standard deviation of white noise with that density, in the channel's unit.
    pub level: f64,
    /// How the density goes.
    pub colour: Colour,
}

/// How the density of noise goes with frequency.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colour {
    /// Even.
    White,
    /// Falling: filtered, or motion up to the highest frequencies.
    Falling,
    /// Rising: differences of something quantised or noisy.
    Rising,
}

/// Factor between the densities of the third and fourth quarter of the spectrum up to which
/// it is even: the estimate's own noise is a few per cent, as each is a mean over many bins
/// and segments; differences of white noise make 1.38.
const EVEN: f64 = 1.25;
/// Share of half the rate above which the last bins are left out: a decimating filter's.
const TOP: f64 = 0.98;
/// Fall below the level before, over two octaves or to the end, that is a filter's.
const FALL: f64 = 10.0;

/// Noise, and the frequency in Hz from which on the spectrum falls off, of finite samples.
///
/// The corner is where the density is half that of an even stretch of at least a third of
/// an octave below it, after which it falls by ten times within two octaves; motion, whose
/// density falls from the lowest frequency on, has none.
pub(super) fn noise(samples: &[f64], period: f64) -> (Option<ChannelNoise>, Option<f64>) {
    let Some(density) = density(samples) else {
        return (None, None);
    };
    let p = density.0;
    let bins = p.len() - 1;
    let mean = |from: f64, to: f64| {
        let part = &p[(from * bins as f64) as usize..(to * bins as f64) as usize];
        part.iter().sum::<f64>() / part.len() as f64
    };
    let (third, fourth) = (mean(0.5, 0.75), mean(0.75, TOP));
    let colour = if third > EVEN * fourth {
        Colour::Falling
    } else if fourth > EVEN * third {
        Colour::Rising
    } else {
        Colour::White
    };
    // One-sided, over half the rate: the variance of white noise is half its density.
    let level = (0.5 * mean(0.5, TOP)).sqrt();
    let corner = corner(&p).map(|bin| bin / bins as f64 / (2.0 * period));
    (Some(ChannelNoise { level, colour }), corner)
}

/// Bands of a sixth of an octave: middle bin and mean density.
fn bands(p: &[f64]) -> Vec<[f64; 2]> {
    let top = TOP * (p.len() - 1) as f64;
    let (mut bands, mut from) = (Vec::new(), 4.0_f64);
    while from < top {
        let to = (from * 2f64.powf(1.0 / 6.0)).max(from + 1.0).min(top);
        let (a, b) = (from as usize, (to as usize).max(from as usize + 1));
        let mean = p[a..b].iter().sum::<f64>() / (b - a) as f64;
        bands.push([0.5 * (a + b - 1) as f64, mean]);
        from = to;
    }
    bands
}

/// The level of the even stretch at the end of these bands: the median of those down to the
/// first that is far from the greatest of the last three.
fn plateau(bands: &[[f64; 2]], high: f64) -> f64 {
    let near = |b: &&[f64; 2]| (0.5 * high..=2.0 * high).contains(&b[1]);
    let mut level: Vec<f64> = bands.iter().rev().take_while(near).map(|b| b[1]).collect();
    crate::numeric::order::median(&mut level)
}

fn corner(p: &[f64]) -> Option<f64> {
    let bands = bands(p);
    // From the highest even stretch down: what is below it is motion.
    for start in (0..bands.len().saturating_sub(3)).rev() {
        let flat = &bands[start..start + 3];
        let (low, high) =
            (flat.iter()).fold((f64::MAX, 0.0_f64), |(a, b), v| (a.min(v[1]), b.max(v[1])));
        if high > 1.6 * low || low == 0.0 {
            continue;
        }
        let level = plateau(&bands[..start + 3], high);
        let after = &bands[start + 3..];
        let half = after.iter().position(|b| b[1] < 0.5 * level)?;
        let reach = 4.0 * after[half][0];
        let falls = after[half..].iter().filter(|b| b[0] <= reach);
        let stays_down = after[half..].iter().all(|b| b[1] < 0.7 * level);
        if stays_down && falls.map(|b| b[1]).fold(f64::MAX, f64::min) < level / FALL {
            let (a, b) = (
                if half == 0 { flat[2] } else { after[half - 1] },
                after[half],
            );
            let along = ((a[1] / (0.5 * level)).ln() / (a[1] / b[1]).ln()).clamp(0.0, 1.0);
            return Some(a[0] * (b[0] / a[0]).powf(along));
        }
        // An even stretch that nothing falls off from, above all others.
        if !stays_down || after.is_empty() {
            return None;
        }
    }
    None
}
