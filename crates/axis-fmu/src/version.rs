//! Versions of the standard that units are made of.

use std::fmt;

/// A version of FMI. What a unit does is the same in both; description and functions differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FmiVersion {
    /// FMI 2.0 (*Functional Mock-up Interface for Model Exchange and Co-Simulation 2.0.5*).
    V2,
    /// FMI 3.0 (*Functional Mock-up Interface Specification 3.0.2*).
    #[default]
    V3,
}

impl FmiVersion {
    /// As a description states it.
    pub fn number(self) -> &'static str {
        match self {
            Self::V2 => "2.0",
            Self::V3 => "3.0",
        }
    }

    /// The folder of a library for this operating system and this processor, as
    /// [`std::env::consts`] names them; none if no library is made for them.
    ///
    /// FMI 3.0.2, Section 2.5.1.4.1. FMI 2.0.5, Section 2.3, has the system and the number of
    /// bits alone, whatever the processor.
    pub fn platform(self, os: &str, arch: &str) -> Option<String> {
        let system = match os {
            "linux" => "linux",
            "macos" => "darwin",
            "windows" => "windows",
            _ => return None,
        };
        if !matches!(arch, "x86_64" | "aarch64") {
            return None;
        }
        Some(match self {
            Self::V2 if os == "windows" => "win64".to_owned(),
            Self::V2 => format!("{system}64"),
            Self::V3 => format!("{arch}-{system}"),
        })
    }
}

impl fmt::Display for FmiVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.number())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_named_as_each_version_says() {
        let of = |os, arch| [FmiVersion::V2, FmiVersion::V3].map(|v| v.platform(os, arch));
        let named = |two: &str, three: &str| [Some(two.to_owned()), Some(three.to_owned())];
        assert_eq!(of("linux", "x86_64"), named("linux64", "x86_64-linux"));
        assert_eq!(of("macos", "aarch64"), named("darwin64", "aarch64-darwin"));
        assert_eq!(of("windows", "x86_64"), named("win64", "x86_64-windows"));
        assert_eq!(of("freebsd", "x86_64"), [None, None]);
        assert_eq!(of("linux", "x86"), [None, None]);
    }
}
