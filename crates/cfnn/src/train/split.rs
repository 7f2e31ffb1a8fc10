use std::vec::Vec;

use rand::RngExt;

use super::initial::generator;
use super::settings::TrainingSettings;
use crate::Error;

/// Training and validation samples, each in rising order.
pub(super) fn split(
    samples: usize,
    settings: &TrainingSettings,
) -> Result<(Vec<usize>, Vec<usize>), Error> {
    let mut order: Vec<usize> = (0..samples).collect();
    let Some(validation) = settings.validation else {
        return Ok((order, Vec::new()));
    };
    let apart = libm::round(validation.fraction * samples as f64) as usize;
    if apart == 0 || apart == samples {
        return Err(Error::Length {
            what: "validation samples (neither none nor all)",
            found: apart,
            expected: (samples / 5).max(1),
        });
    }
    let mut rng = generator(settings.seed, 1);
    for i in (1..samples).rev() {
        order.swap(i, rng.random_range(0..=i));
    }
    let mut training = order.split_off(apart);
    training.sort_unstable();
    order.sort_unstable();
    Ok((training, order))
}
