//! Single numbers at addresses of the environment.
//!
//! FMI passes an array as its address and a length; in FMI 2.0 one length is that of two arrays. No
//! slice can be made of the two without `unsafe`, and a structure of both passes as two arguments do
//! under some calling conventions alone (not under that of Windows). So elements are reached one by
//! one, each by a function of C that takes a reference. Such a function is called by the type that
//! C gives it, which has an address there: Rust guarantees that references and addresses pass in
//! the same manner (`fn` in the standard library, "ABI compatibility"). The change of type happens
//! where `safer-ffi` makes all of them, at the border: an instance leaves as [`Lent`] holds the
//! functions, and comes back as [`Access`] does, as the methods of C++'s objects do.

/// The functions as they are.
#[repr(C)]
pub struct Lent {
    reference: extern "C" fn(&u32) -> u32,
    number: extern "C" fn(&f64) -> f64,
    put: extern "C" fn(&mut f64, f64),
    byte: extern "C" fn(&u8) -> u8,
    put_byte: extern "C" fn(&mut u8, u8),
}

/// The same as C sees them.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Access {
    reference: extern "C" fn(*const u32) -> u32,
    number: extern "C" fn(*const f64) -> f64,
    put: extern "C" fn(*mut f64, f64),
    byte: extern "C" fn(*const u8) -> u8,
    put_byte: extern "C" fn(*mut u8, u8),
}

extern "C" fn reference(at: &u32) -> u32 {
    *at
}

extern "C" fn number(at: &f64) -> f64 {
    *at
}

extern "C" fn put(at: &mut f64, value: f64) {
    *at = value;
}

extern "C" fn byte(at: &u8) -> u8 {
    *at
}

extern "C" fn put_byte(at: &mut u8, value: u8) {
    *at = value;
}

impl Lent {
    pub const ALL: Self = Self {
        reference,
        number,
        put,
        byte,
        put_byte,
    };
}

impl Access {
    /// The `i`th value reference of an array that begins at `at`.
    pub fn reference(&self, at: *const u32, i: usize) -> u32 {
        (self.reference)(at.wrapping_add(i))
    }

    /// The `i`th number.
    pub fn number(&self, at: *const f64, i: usize) -> f64 {
        (self.number)(at.wrapping_add(i))
    }

    /// Writes the `i`th number.
    pub fn put(&self, at: *mut f64, i: usize, value: f64) {
        (self.put)(at.wrapping_add(i), value);
    }

    /// The `i`th byte.
    pub fn byte(&self, at: *const u8, i: usize) -> u8 {
        (self.byte)(at.wrapping_add(i))
    }

    /// Writes the `i`th byte.
    pub fn put_byte(&self, at: *mut u8, i: usize, value: u8) {
        (self.put_byte)(at.wrapping_add(i), value);
    }
}
