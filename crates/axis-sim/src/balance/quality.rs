//! What was decided on a log, for messages.

use crate::balance_error::CutoffReason;

/// How a log was prepared for its torque balance.
#[derive(Clone, Debug, PartialEq)]
pub struct BalanceQuality {
    /// Channel of the torque.
    pub channel: &'static str,
    /// Channels of the motion.
    pub motion: Vec<&'static str>,
    /// Cut-off of the low-pass that both sides go through, Hz.
    pub cutoff: f64,
    /// What sets it.
    pub reason: CutoffReason,
    /// Cut-off of the low-pass of the motion before it is differentiated, Hz.
    pub motion_cutoff: f64,
    /// Share of the acceleration's power below the cut-off that is noise: by so much an inertia would be drawn
    /// towards zero if the acceleration were taken as measured.
    pub attenuation: f64,
    /// Speed up to which nothing is compared, m/s or rad/s: that which the sensor distinguishes
    /// from standstill, or the axis file's `slowest`.
    pub standstill: f64,
    /// Unit of that speed.
    pub speed_unit: &'static str,
    /// Period of the compared samples, s.
    pub compared_period: f64,
    /// Samples compared, and how many there were at that rate.
    pub samples: [usize; 2],
    /// Samples left out because friction depends there on motion finer than what was measured.
    pub unresolved: usize,
    /// Uncertainty of the friction at the samples that are compared, RMS in the channel's unit.
    pub friction: f64,
}

impl BalanceQuality {
    /// In words, of the log of that name.
    pub fn sentence(&self, name: &str) -> String {
        let [kept, all] = self.samples;
        let beware = match self.attenuation > TOLERATED {
            true => format!(
                "; {:.2} % of the acceleration's power is noise, and the acceleration is taken as it is expected without it",
                100.0 * self.attenuation
            ),
            false => String::new(),
        };
        format!(
            "{name}: torque balance of {} along {}, both sides low-passed at {:.3} Hz (set by {}); {:.1} % of the samples are left out: slower than {:.2e} {}, at the ends, or ({} samples) where friction depends on motion finer than the sensor resolves{beware}",
            self.channel,
            self.motion.join(" and "),
            self.cutoff,
            self.reason,
            100.0 * (all - kept) as f64 / all.max(1) as f64,
            self.standstill,
            self.speed_unit,
            self.unresolved,
        )
    }
}

/// Share of the acceleration's power that its noise may have below the cut-off.
pub(super) const TOLERATED: f64 = 1e-3;
