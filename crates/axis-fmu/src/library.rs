//! Libraries of units, told apart by the headers of their files.

use crate::library_mark::LIBRARY_MARK;
use crate::package_error::PackageError;
use crate::version::FmiVersion;

/// A library of units, for one operating system and one processor.
#[derive(Clone, Copy, Debug)]
pub struct UnitLibrary<'a> {
    bytes: &'a [u8],
    /// As [`std::env::consts`] names them.
    os: &'static str,
    arch: &'static str,
}

/// Where formats have what is asked for, as little-endian numbers. ELF: System V ABI, "ELF Header"
/// (`e_ident`, `e_type`, `e_machine`). PE: Microsoft, *PE Format*, "COFF File Header". Mach-O: Apple,
/// `mach-o/loader.h`, `mach_header_64`.
impl<'a> UnitLibrary<'a> {
    /// The library of these bytes.
    ///
    /// # Errors
    /// [`PackageError::Header`] if it is not a shared library that a unit can have;
    /// [`PackageError::Library`] if it is not the library of this version.
    pub fn of(bytes: &'a [u8]) -> Result<Self, PackageError> {
        let (os, arch) = match bytes {
            [0x7f, b'E', b'L', b'F', ..] => ("linux", elf(bytes)?),
            [b'M', b'Z', ..] => ("windows", pe(bytes)?),
            [0xcf, 0xfa, 0xed, 0xfe, ..] => ("macos", mach_o(bytes)?),
            [0xca, 0xfe, 0xba, 0xbe, ..] => {
                return header("it is for several processors (lipo -thin takes one out)");
            }
            _ => return header("it begins as neither ELF, PE nor Mach-O"),
        };
        let mark = LIBRARY_MARK.as_bytes();
        if !bytes.windows(mark.len()).any(|window| window == mark) {
            return Err(PackageError::Library);
        }
        Ok(Self { bytes, os, arch })
    }

    /// The folder of the unit that it belongs in.
    ///
    /// # Errors
    /// [`PackageError::Platform`] if that version of FMI has none.
    pub fn platform(&self, version: FmiVersion) -> Result<String, PackageError> {
        let (os, arch) = (self.os, self.arch);
        let platform = version.platform(os, arch);
        platform.ok_or(PackageError::Platform { os, arch })
    }

    pub(crate) fn bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// How its file's name ends.
    pub(crate) fn end(&self) -> &'static str {
        end(self.os)
    }
}

/// The name of the library as cargo builds it for the system of this program.
///
/// # Errors
/// [`PackageError::Platform`] if it is not made there.
pub fn library_file() -> Result<String, PackageError> {
    let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
    let is_made = FmiVersion::default().platform(os, arch);
    is_made.ok_or(PackageError::Platform { os, arch })?;
    let begin = if os == "windows" { "" } else { "lib" };
    Ok(format!("{begin}feed_axis_fmu.{}", end(os)))
}

fn end(os: &str) -> &'static str {
    match os {
        "windows" => "dll",
        "macos" => "dylib",
        _ => "so",
    }
}

fn elf(bytes: &[u8]) -> Result<&'static str, PackageError> {
    /// 64 bits, little-endian; System V or Linux.
    const IDENTS: [[u8; 4]; 2] = [[2, 1, 1, 0], [2, 1, 1, 3]];
    if !IDENTS.iter().any(|ident| bytes.get(4..8) == Some(ident)) {
        return header("it is ELF, but not of 64 bits for Linux");
    }
    if number::<2>(bytes, 16) != Some(3) {
        return header("it is ELF, but no shared library");
    }
    processor(number::<2>(bytes, 18), [62, 183])
}

fn pe(bytes: &[u8]) -> Result<&'static str, PackageError> {
    let at = number::<4>(bytes, 0x3c).map(|at| at as usize);
    let found = at.filter(|at| bytes.get(*at..).is_some_and(|b| b.starts_with(b"PE\0\0")));
    let Some(at) = found else {
        return header("it begins as a program of DOS, and is not PE");
    };
    /// `IMAGE_FILE_DLL`.
    const DLL: u64 = 0x2000;
    if number::<2>(bytes, at + 22).is_none_or(|flags| flags & DLL == 0) {
        return header("it is PE, but no library");
    }
    processor(number::<2>(bytes, at + 4), [0x8664, 0xaa64])
}

fn mach_o(bytes: &[u8]) -> Result<&'static str, PackageError> {
    /// `MH_DYLIB`.
    const DYLIB: u64 = 6;
    if number::<4>(bytes, 12) != Some(DYLIB) {
        return header("it is Mach-O, but no dynamic library");
    }
    processor(number::<4>(bytes, 4), [0x0100_0007, 0x0100_000c])
}

/// The processor of a number, given those of x86-64 and AArch64.
fn processor(found: Option<u64>, known: [u64; 2]) -> Result<&'static str, PackageError> {
    let Some(found) = found else {
        return header("it ends in its header");
    };
    match known.iter().position(|number| *number == found) {
        Some(0) => Ok("x86_64"),
        Some(_) => Ok("aarch64"),
        None => header(&format!("it is for another processor (number {found:#x})")),
    }
}

/// The little-endian number of `N` bytes at that place.
fn number<const N: usize>(bytes: &[u8], at: usize) -> Option<u64> {
    let bytes = bytes.get(at..)?.first_chunk::<N>()?;
    let digits = bytes.iter().rev();
    Some(digits.fold(0, |sum, byte| sum << 8 | u64::from(*byte)))
}

fn header<T>(found: &str) -> Result<T, PackageError> {
    Err(PackageError::Header(found.to_owned()))
}
