//! Where a unit's resources are: FMI 3.0 gives a path, FMI 2.0 a URI.

/// The path of a `file` URI as FMI 2.0.5, Section 2.1.5 (`fmi2Instantiate`), has it: IETF RFC 3986,
/// Section 3, with an empty authority, none or `localhost`; and a path as it is, which some
/// importers give.
///
/// # Errors
/// What is wrong with it, in words.
pub fn resource_path(uri: &str) -> Result<String, String> {
    let refused = |why: &str| {
        Err(format!(
            "the location of the resources is \"{uri}\": {why}; valid: file:///folder/resources"
        ))
    };
    let Some((scheme, rest)) = uri.split_once(':').filter(|(scheme, _)| !is_drive(scheme)) else {
        return Ok(uri.to_owned());
    };
    if !scheme.eq_ignore_ascii_case("file") {
        return refused("it is no file");
    }
    let path = match rest.strip_prefix("//") {
        Some(rest) => {
            let (host, path) = rest.split_at(rest.find('/').unwrap_or(rest.len()));
            if !matches!(host, "" | "localhost") {
                return refused("it is on another machine");
            }
            path
        }
        None => rest,
    };
    match percent_decoded(path) {
        Some(path) => Ok(without_root(path)),
        None => refused("a % is not followed by the two hexadecimal digits of a UTF-8 text"),
    }
}

/// Whether it is the letter of a drive of Windows, of which no scheme of one letter is registered.
fn is_drive(scheme: &str) -> bool {
    scheme.len() == 1 && scheme.chars().all(|c| c.is_ascii_alphabetic())
}

/// `/C:/folder`, as RFC 8089, Appendix E.2, has a path of Windows, as `C:/folder`.
fn without_root(path: String) -> String {
    let rest = path.strip_prefix('/');
    let drive = rest.and_then(|rest| Some((rest, rest.split_once(':')?.0)));
    match drive {
        Some((rest, drive)) if is_drive(drive) => rest.to_owned(),
        _ => path,
    }
}

/// RFC 3986, Section 2.1.
fn percent_decoded(text: &str) -> Option<String> {
    let mut bytes = text.bytes();
    let mut decoded = Vec::with_capacity(text.len());
    while let Some(byte) = bytes.next() {
        decoded.push(match byte {
            b'%' => {
                let digit = |byte: u8| char::from(byte).to_digit(16);
                let (high, low) = (digit(bytes.next()?)?, digit(bytes.next()?)?);
                u8::try_from(16 * high + low).ok()?
            }
            byte => byte,
        });
    }
    String::from_utf8(decoded).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_uris_are_paths() {
        for (uri, path) in [
            ("file:///tmp/a%20b/resources", "/tmp/a b/resources"),
            ("file:/tmp/resources", "/tmp/resources"),
            ("FILE://localhost/tmp/resources/", "/tmp/resources/"),
            ("file:///tmp/%C3%BC/%25", "/tmp/ü/%"),
            ("/tmp/plain", "/tmp/plain"),
            ("file:///C:/units%20a/resources", "C:/units a/resources"),
            (r"C:\units\resources", r"C:\units\resources"),
            ("file:///c/units", "/c/units"),
            ("", ""),
        ] {
            assert_eq!(resource_path(uri).as_deref(), Ok(path));
        }
        for (uri, why) in [
            ("https://example.org/resources", "no file"),
            ("file://server/share", "another machine"),
            ("file:///a%2", "hexadecimal"),
            ("file:///a%zz", "hexadecimal"),
            ("file:///a%FF", "hexadecimal"),
        ] {
            let refused = resource_path(uri).unwrap_err();
            assert!(
                refused.contains(why) && refused.contains("valid:"),
                "{refused}"
            );
        }
    }
}
