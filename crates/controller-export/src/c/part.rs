//! The evaluator in C, part by part.

use super::Precision;

/// A piece of C code and the pieces that must stand before it.
#[derive(Debug)]
pub(super) struct Part {
    /// In double and in single precision.
    code: [&'static str; 2],
    needs: &'static [&'static Part],
}

impl Part {
    /// Its code.
    pub fn code(&self, precision: Precision) -> &'static str {
        match precision {
            Precision::F64 => self.code[0],
            Precision::F32 => self.code[1],
        }
    }

    /// Adds what it needs and itself to a list, each once.
    pub fn join(&'static self, list: &mut Vec<&'static Self>) {
        for need in self.needs {
            need.join(list);
        }
        if !list.iter().any(|part| std::ptr::eq(*part, self)) {
            list.push(self);
        }
    }
}

macro_rules! part {
    ($name:ident, $file:literal, [$($need:ident),*]) => {
        pub(super) static $name: Part = Part {
            code: [
                include_str!(concat!("runtime/", $file, ".c")),
                include_str!(concat!("runtime/", $file, ".c")),
            ],
            needs: &[$(&$need),*],
        };
    };
    (each $name:ident, $file:literal, [$($need:ident),*]) => {
        pub(super) static $name: Part = Part {
            code: [
                include_str!(concat!("runtime/", $file, "_f64.c")),
                include_str!(concat!("runtime/", $file, "_f32.c")),
            ],
            needs: &[$(&$need),*],
        };
    };
}

part!(ABSOLUTE, "absolute", []);
part!(WITH_SIGN, "with_sign", []);
part!(IS_NAN, "is_nan", []);
part!(IS_ZERO, "is_zero", []);
part!(GREATEST, "greatest", [IS_NAN]);
part!(LEAST, "least", [IS_NAN]);
part!(LIMITED, "limited", [GREATEST, LEAST]);
part!(FINITE, "finite", []);
part!(NOT_A_NUMBER, "not_a_number", []);
part!(each REMAINDER, "remainder", []);
part!(each TANSIG, "tansig", [ABSOLUTE, WITH_SIGN]);
part!(FORWARD, "forward", [TANSIG]);
part!(ESTIMATOR, "estimator", [REMAINDER, FORWARD]);
part!(TRANSFER, "transfer", []);
part!(each DECAYS, "decays", [IS_NAN]);
part!(LUGRE, "lugre", [DECAYS, ABSOLUTE, WITH_SIGN]);
// The actuator's part stands before it.
part!(
    PLAN,
    "plan",
    [IS_ZERO, ALONG, LUGRE, LIMITED, FINITE, NOT_A_NUMBER]
);
part!(FRICTION, "friction", [LUGRE]);
part!(each ROOT, "root", []);
part!(ALONG, "along", [LEAST, GREATEST]);
part!(FIELD_ORIENTED, "field_oriented", [LIMITED, ROOT]);
part!(LAG, "lag", [IS_ZERO, LIMITED]);
part!(FEEDBACK, "feedback", [FINITE, ROOT]);
part!(FADE, "fade", []);
part!(GUARD, "guard", [ABSOLUTE, LIMITED, FINITE, FADE]);
