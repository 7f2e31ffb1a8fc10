//! The words that columns are named with, one vocabulary for all readers, and how a name falls
//! into them.
//!
//! English and German, and the same words of French, Italian and Spanish. German writes several
//! as one, `Lagesollwert`, `Motordrehzahl`; so do programs that know no capitals, `actpos`.

/// A quantity: words that name it, the unit that it is taken in where none is said, and by
/// dimension of the unit the channel, of what is, what should be, what is at the motor, and what
/// should be there. An empty one: there is no such channel.
pub(super) struct Quantity {
    pub words: &'static [&'static str],
    pub usual: &'static str,
    pub channels: &'static [(&'static str, [&'static str; 4])],
}

/// Channels of what is, what should be, of the motor, and what should be of it.
const SPEEDS: &[(&str, [&str; 4])] = &[
    (
        "speed",
        [
            "velocity_m_s",
            "velocity_ref_m_s",
            "velocity_m_s",
            "velocity_ref_m_s",
        ],
    ),
    (
        "angular speed",
        [
            "velocity_rad_s",
            "velocity_ref_rad_s",
            "motor_speed_rad_s",
            "speed_ref_rad_s",
        ],
    ),
];
const POSITIONS: &[(&str, [&str; 4])] = &[
    (
        "length",
        [
            "position_m",
            "position_ref_m",
            "position_m",
            "position_ref_m",
        ],
    ),
    (
        "angle",
        ["position_rad", "position_ref_rad", "motor_angle_rad", ""],
    ),
];

/// Of two words that a name holds, the last counts ([`Words::quantities`]): the torque current is
/// a current.
pub(super) const QUANTITIES: &[Quantity] = &[
    Quantity {
        words: &["time", "timestamp", "t", "zeit", "temps", "tempo", "tiempo"],
        usual: "s",
        channels: &[("time", ["t_s", "", "t_s", ""])],
    },
    Quantity {
        words: &[
            "torque",
            "trq",
            "tau",
            "moment",
            "drehmoment",
            "couple",
            "coppia",
        ],
        usual: "N·m",
        channels: &[(
            "torque",
            [
                "torque_n_m",
                "torque_ref_n_m",
                "torque_n_m",
                "torque_ref_n_m",
            ],
        )],
    },
    Quantity {
        words: &["force", "kraft", "forza", "fuerza"],
        usual: "N",
        channels: &[(
            "force",
            ["force_n", "force_ref_n", "force_n", "force_ref_n"],
        )],
    },
    Quantity {
        words: &[
            "current",
            "iq",
            "strom",
            "amps",
            "courant",
            "corrente",
            "corriente",
        ],
        usual: "A",
        channels: &[("current", ["iq_a", "iq_ref_a", "iq_a", "iq_ref_a"])],
    },
    // A number of turns is of something that turns.
    Quantity {
        words: &["omega", "drehzahl"],
        usual: "rpm",
        channels: SPEEDS,
    },
    Quantity {
        words: &[
            "velocity",
            "vel",
            "velo",
            "speed",
            "v",
            "qd",
            "dq",
            "geschwindigkeit",
            "vitesse",
            "velocità",
            "velocita",
            "velocidad",
        ],
        usual: "mm/s",
        channels: SPEEDS,
    },
    Quantity {
        words: &[
            "angle", "theta", "phi", "winkel", "angolo", "ángulo", "angulo",
        ],
        usual: "deg",
        channels: POSITIONS,
    },
    Quantity {
        words: &[
            "position",
            "pos",
            "x",
            "q",
            "lage",
            "weg",
            "posizione",
            "posición",
            "posicion",
        ],
        usual: "mm",
        channels: POSITIONS,
    },
];

/// What should be, not what is.
pub(super) const DEMANDED: &[&str] = &[
    "ref",
    "reference",
    "referenz",
    "cmd",
    "command",
    "commanded",
    "set",
    "setpoint",
    "setpt",
    "sp",
    "des",
    "desired",
    "dem",
    "demand",
    "request",
    "requested",
    "target",
    "goal",
    "nominal",
    "soll",
    "sollwert",
    "ziel",
    "zielwert",
    "vorgabe",
    "führung",
    "fuehrung",
    "führungsgröße",
    "consigne",
    "consigna",
    "riferimento",
    "referencia",
];
/// What is: known so that words which hold it can be told apart.
const ACTUAL: &[&str] = &[
    "ist", "istwert", "wert", "value", "act", "actual", "fb", "feedback", "mess", "messwert",
    "meas", "measured", "momentan", "geber", "enc", "encoder",
];
pub(super) const OF_MOTOR: &[&str] = &["motor", "mot", "rotor", "moteur", "motore"];
/// Words of columns that are none of the quantities, whatever else is in the name.
pub(super) const OTHER: &[&str] = &[
    "error",
    "err",
    "fehler",
    "deviation",
    "dev",
    "abweichung",
    "diff",
    "differenz",
    "lag",
    "following",
    "schlepp",
    "schleppfehler",
    "schleppabstand",
    "limit",
    "grenze",
    "max",
    "min",
    "maximal",
    "minimal",
    "rated",
    "nenn",
    "id",
    "feedforward",
    "ff",
    "vorsteuerung",
    "override",
    "temp",
    "temperature",
    "temperatur",
    "thermo",
];
/// A share of a rated value, and how many per cent one of it is.
pub(super) const SHARES: &[(&str, f64)] = &[
    ("%", 1.0),
    ("‰", 0.1),
    ("percentage", 1.0),
    ("percent", 1.0),
    ("pct", 1.0),
    ("prozent", 1.0),
    ("pourcent", 1.0),
    ("permille", 0.1),
    ("promille", 0.1),
];
/// A mean of squares.
pub(super) const RMS: &[&str] = &[
    "rms",
    "eff",
    "effektiv",
    "effektivwert",
    "effective",
    "efficace",
];
/// The current along the magnet's field, which makes no torque.
pub(super) const OF_FIELD: &[&str] = &[
    "d",
    "id",
    "feldbildend",
    "feldbildender",
    "flussbildend",
    "flussbildender",
    "magnetisierung",
    "magnetizing",
    "magnetising",
];
/// Currents that are not of the rotor's axes: of phases, of a winding that excites, and of what
/// feeds them.
pub(super) const NOT_OF_ROTOR: &[&str] = &[
    "phase",
    "u",
    "v",
    "w",
    "alpha",
    "beta",
    "field",
    "feld",
    "dc",
    "bus",
    "link",
    "zwischenkreis",
    "supply",
    "netz",
    "mains",
    "brake",
    "bremse",
];
/// What a current does, which is no torque.
const DOES: &[&str] = &["momentenbildend", "drehmomentbildend", "momentbildend"];

/// What stands between the parts of a German word.
const LINKS: [&str; 5] = ["", "s", "es", "en", "n"];
/// Shorter words are parts only at the beginning, before what says whether it is or should be:
/// `xsoll`.
const PART: usize = 3;
/// Longer ones are found in words of which the others are not known.
const SURE: usize = 3;

/// Bytes of the longest word that is taken apart: what is longer is no name.
const LONGEST: usize = 80;

/// The words of a name, and the parts of those that are several.
pub(super) struct Words(Vec<String>);

impl Words {
    pub(super) fn of(name: &str) -> Self {
        let words = separate(name);
        let mut parts = Vec::with_capacity(words.len());
        let mut words = words.into_iter().peekable();
        while let Some(word) = words.next() {
            // `I_q` is `Iq`.
            let behind = words.peek().map_or("", String::as_str);
            match (word.as_str(), behind) {
                ("i", "q" | "d") => {
                    parts.push(word + behind);
                    words.next();
                }
                _ => parts.extend(parts_of(word)),
            }
        }
        Self(parts)
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(String::as_str)
    }

    pub(super) fn has(&self, list: &[&str]) -> bool {
        self.iter().any(|word| list.contains(&word))
    }

    /// What it may be, the likeliest first: what the last long word says, as what is in front says
    /// more of it; then short ones, which may be the letter of an axis.
    pub(super) fn quantities(&self) -> impl Iterator<Item = &'static Quantity> {
        let long = self.iter().filter(|word| word.len() >= PART);
        let long: Vec<_> = long.filter_map(of_word).collect();
        let short = QUANTITIES.iter().filter(|q| {
            let is_its = |word: &str| word.len() < PART && q.words.contains(&word);
            self.iter().any(is_its)
        });
        long.into_iter().rev().chain(short.collect::<Vec<_>>())
    }
}

/// `Axis 1.ActPos` is `axis`, `1`, `act`, `pos`.
fn separate(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = ' ';
    for c in name.chars() {
        let begins = c.is_uppercase() && before.is_lowercase()
            || c.is_ascii_digit() != before.is_ascii_digit();
        if begins || !c.is_alphanumeric() {
            words.push(String::new());
        }
        if c.is_alphanumeric() {
            words
                .last_mut()
                .unwrap_or(&mut String::new())
                .extend(c.to_lowercase());
        }
        before = c;
    }
    words.retain(|word| !word.is_empty());
    words
}

/// The quantity of which this is a word.
fn of_word(word: &str) -> Option<&'static Quantity> {
    QUANTITIES.iter().find(|q| q.words.contains(&word))
}

/// All words.
fn all() -> impl Iterator<Item = &'static str> {
    let quantities = QUANTITIES.iter().flat_map(|quantity| quantity.words);
    let lists = [
        DEMANDED,
        ACTUAL,
        OF_MOTOR,
        OTHER,
        RMS,
        OF_FIELD,
        NOT_OF_ROTOR,
        DOES,
    ];
    let shares = SHARES.iter().map(|(word, _)| *word);
    quantities
        .chain(lists.into_iter().flatten())
        .copied()
        .chain(shares)
}

/// A word, or its parts where all of them are known; where they are not, what is known of it too.
fn parts_of(word: String) -> Vec<String> {
    if all().any(|known| known == word) {
        return vec![word];
    }
    if word.len() <= LONGEST
        && let Some(parts) = joined(&word)
    {
        return parts.into_iter().map(str::to_owned).collect();
    }
    let long = |list: &'static [&'static str]| list.iter().filter(|known| known.len() > SURE);
    let quantities = QUANTITIES.iter().flat_map(|quantity| long(quantity.words));
    let mut parts: Vec<String> = quantities
        .chain(long(OTHER))
        .filter(|known| word.ends_with(**known))
        .chain(
            long(OF_MOTOR)
                .chain(long(OTHER))
                .filter(|known| word.starts_with(**known)),
        )
        .chain(long(DEMANDED).filter(|known| word.contains(**known)))
        .map(|known| (*known).to_owned())
        .collect();
    parts.insert(0, word);
    parts
}

/// The fewest words that make up this one without a gap.
fn joined(word: &str) -> Option<Vec<&str>> {
    // From each byte on: how many words, where the first ends, and where the next begins.
    let mut best: Vec<Option<[usize; 3]>> = vec![None; word.len() + 1];
    best[word.len()] = Some([0; 3]);
    for begin in (0..word.len()).rev().filter(|k| word.is_char_boundary(*k)) {
        let behind = &word[begin..];
        let may_begin = |known: &str| begin == 0 && (known == "id" || of_word(known).is_some());
        let fits =
            |known: &&str| (known.len() >= PART || may_begin(known)) && behind.starts_with(known);
        for known in all().filter(fits) {
            let end = begin + known.len();
            for link in LINKS.iter().filter(|link| word[end..].starts_with(**link)) {
                let next = end + link.len();
                let is_last = next == word.len();
                let Some([count, ..]) = best[next].filter(|_| link.is_empty() || !is_last) else {
                    continue;
                };
                if best[begin].is_none_or(|[least, ..]| count + 1 < least) {
                    best[begin] = Some([count + 1, end, next]);
                }
            }
        }
    }
    let (mut parts, mut begin) = (Vec::new(), 0);
    while begin < word.len() {
        let [_, end, next] = best[begin]?;
        parts.push(&word[begin..end]);
        begin = next;
    }
    let tells = |part: &&str| DEMANDED.contains(part) || ACTUAL.contains(part);
    let is_short = parts.first().is_some_and(|first| first.len() < PART);
    (!is_short || parts[1..].iter().all(tells)).then_some(parts)
}
