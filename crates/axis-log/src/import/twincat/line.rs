//! Lines and their fields.

/// Key of the line of names, and of the first line.
pub(super) const NAME: &str = "Name";

/// What separates fields, or a blank.
const SEPARATORS: [char; 5] = ['\t', ';', ',', ':', ' '];

/// Name, file and start of an export in its first three lines, with one separator.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    let Some(separator) = separator(bytes) else {
        return false;
    };
    let mut lines = bytes.split(|byte| *byte == b'\n').skip(1);
    let file = lines.next().and_then(|line| line.strip_prefix(b"File"));
    file.is_some_and(|rest| rest.first().copied().map(char::from) == Some(separator))
        && lines.next().is_some_and(|line| line.starts_with(b"Start"))
}

/// What stands behind the key of the first line.
pub(super) fn separator(bytes: &[u8]) -> Option<char> {
    let behind = bytes.strip_prefix(NAME.as_bytes())?.first();
    let separator = char::from(*behind?);
    SEPARATORS.contains(&separator).then_some(separator)
}

/// The fields of a line, without blanks around them.
pub(super) fn fields(line: &str, separator: char) -> impl DoubleEndedIterator<Item = &str> + Clone {
    line.split(separator).map(str::trim)
}

/// The first field of a line, in a header its key.
pub(super) fn key(line: &str, separator: char) -> &str {
    fields(line, separator).next().unwrap_or_default()
}
