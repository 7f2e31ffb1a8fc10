//! Damage: to any bytes, and to text line by line and word by word.

use std::ops::Range;

use super::random::Source;

/// What stands in a number's place.
pub const NASTY: [&str; 36] = [
    "0",
    "-0.0",
    "-1",
    "1",
    "3",
    "0.5",
    "1e-9",
    "1e9",
    "1e20",
    "-1e20",
    "1e300",
    "1e308",
    "-1e308",
    "1.8e308",
    "1e400",
    "nan",
    "-nan",
    "inf",
    "-inf",
    "1e-320",
    "5e-324",
    "1e-300",
    "99999999999999999999999",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551615",
    "4294967295",
    "2147483648",
    "65536",
    "1_000",
    "0x10",
    "+7",
    "",
    ".5",
    "1.",
    "00",
];

/// What stands in a value's place.
const VALUES: [&str; 12] = [
    "\"text\"",
    "''",
    "true",
    "[]",
    "{}",
    "[1, 2]",
    "[[[[[[[[[[[[[[[[[[[[[[",
    "1979-05-27",
    "\"\\u0000\"",
    "\"\u{202e}\u{0301}\t\"",
    "\"\"\"",
    "{ a = { b = 1 } }",
];

/// One to four changes anywhere in the bytes.
pub fn bytes(base: &[u8], random: &mut Source) -> Vec<u8> {
    let mut bytes = base.to_vec();
    for _ in 0..=random.below(4) {
        change(&mut bytes, random);
    }
    bytes
}

fn change(bytes: &mut Vec<u8>, random: &mut Source) {
    let at = random.below(bytes.len());
    let part = part(bytes.len(), random);
    match random.below(8) {
        _ if bytes.is_empty() => bytes.push(random.byte()),
        0 | 1 => bytes[at] ^= 1 << random.below(8),
        2 => bytes[at] = random.byte(),
        3 => bytes.truncate(at),
        4 => drop(bytes.drain(part)),
        5 => {
            let again = bytes[part].to_vec();
            bytes.splice(at..at, again);
        }
        6 => {
            let new: Vec<u8> = (0..=random.below(8)).map(|_| random.byte()).collect();
            bytes.splice(at..at, new);
        }
        _ => {
            // Lengths and counts are little-endian words; most are far too large.
            let end = (at + 1 + random.below(8)).min(bytes.len());
            bytes[at..end].fill(*random.pick(&[0x00, 0xff, 0x7f, 0x80]));
        }
    }
}

/// A part of at most 64 of so many things.
fn part(length: usize, random: &mut Source) -> Range<usize> {
    let start = random.below(length);
    start..(start + 1 + random.below(64)).min(length)
}

/// One to four changes to text; now and then the bytes are changed instead.
pub fn text(base: &str, random: &mut Source) -> Vec<u8> {
    if random.chance(0.2) {
        return bytes(base.as_bytes(), random);
    }
    let mut lines: Vec<String> = base.lines().map(str::to_owned).collect();
    for _ in 0..=random.below(4) {
        line(&mut lines, random);
    }
    let mut text = lines.join("\n") + "\n";
    if random.chance(0.05) {
        let mut cut = random.below(text.len());
        while !text.is_char_boundary(cut) {
            cut -= 1;
        }
        text.truncate(cut);
    }
    text.into_bytes()
}

fn line(lines: &mut Vec<String>, random: &mut Source) {
    if lines.is_empty() {
        return lines.push("=".to_owned());
    }
    let (at, other) = (random.below(lines.len()), random.below(lines.len()));
    match random.below(12) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(other, lines[at].clone()),
        2 => lines.swap(at, other),
        3 => typo(&mut lines[at], random),
        4 => value(&mut lines[at], random),
        5 => lines[at].truncate(0),
        _ => number(&mut lines[at], random),
    }
}

/// A character lost, doubled or another, in the first word.
fn typo(line: &mut String, random: &mut Source) {
    let mut letters: Vec<char> = line.chars().collect();
    let word = letters.iter().take_while(|c| !c.is_whitespace()).count();
    let at = random.below(word.max(1));
    match random.below(3) {
        _ if letters.is_empty() => {}
        0 => drop(letters.remove(at)),
        1 => letters.insert(at, letters[at]),
        _ => letters[at] = *random.pick(&['x', '_', 'ß', '.', '"', '[', '=', ' ']),
    }
    *line = letters.into_iter().collect();
}

/// Something else behind the equals sign, or the comma.
fn value(line: &mut String, random: &mut Source) {
    if let Some(at) = line.find(['=', ',']) {
        line.truncate(at + 1);
        let value: &&str = random.pick(&VALUES);
        line.push_str(value);
    }
}

/// Another number in the place of one.
pub fn number(line: &mut String, random: &mut Source) {
    let numbers = numbers(line);
    if numbers.is_empty() {
        return;
    }
    let range = random.pick(&numbers).clone();
    let new = if random.chance(0.6) {
        (*random.pick(&NASTY)).to_owned()
    } else {
        let old: f64 = line[range.clone()].parse().unwrap_or(1.0);
        format!("{}", old * 10f64.powf(6.0 * random.unit() - 3.0))
    };
    line.replace_range(range, &new);
}

/// Where numbers stand that are not part of a word.
pub fn numbers(line: &str) -> Vec<Range<usize>> {
    let bytes = line.as_bytes();
    let of_number = |b: u8| b.is_ascii_digit() || matches!(b, b'.' | b'-' | b'+' | b'e');
    let of_word = |b: u8| b.is_ascii_alphanumeric() || b == b'_';
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let start = at;
        while at < bytes.len() && (of_number(bytes[at]) || of_word(bytes[at])) {
            at += 1;
        }
        let run = &bytes[start..at];
        if run.iter().any(u8::is_ascii_digit) && run.iter().all(|&b| of_number(b)) {
            found.push(start..at);
        }
        at += usize::from(run.is_empty());
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_found_where_they_stand_alone() {
        let line = "density_kg_per_m3 = -7.85e3  # steel, 2 of [1]";
        let found: Vec<&str> = numbers(line).into_iter().map(|r| &line[r]).collect();
        assert_eq!(found, ["-7.85e3", "2", "1"]);
    }

    #[test]
    fn damage_depends_on_the_seed_alone_and_survives_any_text() {
        for index in 0..5000 {
            let once = |base: &str| text(base, &mut Source::new(1, "text", index));
            for base in ["", "a = 1\nb = 2.5\n", "# µ\n\n[ß]\n"] {
                assert_eq!(once(base), once(base));
            }
        }
    }
}
