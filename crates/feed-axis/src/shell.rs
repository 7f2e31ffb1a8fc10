//! Commands in messages, written so that they work where they are pasted into a shell.

/// A word as a shell takes it literally: file names with spaces in quotes.
///
/// Double quotes, which every shell knows; single ones where a Unix shell would read more than
/// letters between double quotes.
pub fn word(text: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./=:,@%+".contains(c);
    let is_separator = |c: char| cfg!(windows) && c == '\\';
    if !text.is_empty() && text.chars().all(|c| is_plain(c) || is_separator(c)) {
        return text.to_owned();
    }
    match cfg!(unix) && text.contains(['$', '`', '\\', '!', '"']) {
        true => format!("'{}'", text.replace('\'', r"'\''")),
        false => format!("\"{text}\""),
    }
}

/// Words as a line of a shell.
pub fn line(words: &[String]) -> String {
    let words: Vec<String> = words.iter().map(|text| word(text)).collect();
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shell's own reading of a line is the truth.
    #[test]
    #[cfg(unix)]
    fn a_shell_reads_the_words_again() {
        for text in [
            "x.toml",
            "my axis.toml",
            "l'axe.toml",
            "a\"b",
            "$HOME",
            "a`b",
            "a\\b",
            "it's $5",
            "",
            "ä µ",
            "*",
            "a;b&c",
        ] {
            let script = format!("printf %s {}", word(text));
            let mut shell = std::process::Command::new("sh");
            let read = shell.args(["-c", &script]).output().unwrap().stdout;
            assert_eq!(String::from_utf8(read).unwrap(), text, "{script}");
        }
        assert_eq!(line(&["a b".into(), "c".into()]), "\"a b\" c");
    }
}
