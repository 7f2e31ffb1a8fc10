//! [`LuGre`] as one of the family. Its own functions stay as they are.

use super::{FrictionLaw, halves, pressing, sound};
use crate::exponential::Exponential;
use crate::law::LuGre;

/// The state is the deflection of the bristles, m or rad. As
/// [`step`](LuGre::step), which is exact at a constant speed, but from a state that is not
/// finite it begins at 0.
impl<T: Exponential> FrictionLaw<T> for LuGre<T> {
    type State = T;

    fn step(&self, z: T, v0: T, v1: T, h: T) -> T {
        let limit = self.bristle_limit();
        halves(sound(z, [-limit, limit]), [v0, v1], h, |z, speed, h| {
            let still = speed == T::ZERO || h <= T::ZERO;
            if still && !(speed.is_nan() || h.is_nan()) {
                return z;
            }
            LuGre::step(self, z, speed, speed, h)
        })
    }

    fn force_at_load(&self, z: &T, speed: T, load: T) -> T {
        let p = self.parameters();
        let dry = self.bristle_stiffness() * *z + p.damping * self.rate(*z, speed);
        pressing(load) * dry + p.viscous * speed
    }

    fn steady_state(&self, speed: T) -> T {
        LuGre::steady_state(self, speed)
    }

    fn settled(&self, speed: T) -> T {
        self.steady_bristle(speed)
    }

    fn stiffness(&self) -> T {
        self.bristle_stiffness()
    }

    fn spring_limits(&self) -> [T; 2] {
        let stiction = self.parameters().stiction;
        [-stiction, stiction]
    }

    fn spring_force(&self, z: &T) -> T {
        self.bristle_stiffness() * *z
    }

    fn stored_energy(&self, z: &T) -> T {
        LuGre::stored_energy(self, *z)
    }

    fn is_passive(&self) -> bool {
        LuGre::is_passive(self)
    }
}
