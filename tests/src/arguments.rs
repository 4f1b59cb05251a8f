//! The arguments of the long commands: numbers by name, and a format.

use std::fmt;

/// What was given.
#[derive(Clone, Debug)]
pub struct Arguments {
    numbers: Vec<(&'static str, u64)>,
    format: Option<String>,
}

/// Why the arguments are refused.
#[derive(Clone, Debug, PartialEq)]
enum ArgumentError {
    /// The last one has no value.
    NoValue(String),
    /// The value of one is no number.
    NotANumber(String, String),
    /// One that is not known; these are.
    Unknown(String, Vec<&'static str>),
    /// A format that is not known; these are.
    UnknownFormat(String, Vec<String>),
}

impl fmt::Display for ArgumentError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoValue(name) => write!(f, "{name} needs a value"),
            Self::NotANumber(name, value) => write!(f, "{name} {value}: not a number"),
            Self::Unknown(name, known) => {
                let known: Vec<String> = known.iter().map(|known| format!("--{known}")).collect();
                write!(f, "{name}: allowed are {} and --format", known.join(", "))
            }
            Self::UnknownFormat(format, known) => write!(f, "--format {format}: known are {}", known.join(", ")),
        }
    }
}

impl Arguments {
    /// Those of the process: `--NAME NUMBER` for each name, with the number where it is not given, and `--format NAME` of one of these
    /// formats. Ends the process with status 2 where there are others.
    pub fn of_process<'a>(names: &[(&'static str, u64)], formats: impl Iterator<Item = &'a str>) -> Self {
        Self::read(std::env::args().skip(1), names, &formats.collect::<Vec<_>>()).unwrap_or_else(|why| {
            eprintln!("{why}");
            std::process::exit(2)
        })
    }

    fn read(
        mut given: impl Iterator<Item = String>,
        names: &[(&'static str, u64)],
        formats: &[&str],
    ) -> Result<Self, ArgumentError> {
        let mut found = Self { numbers: names.to_vec(), format: None };
        while let Some(name) = given.next() {
            let value = given.next().ok_or_else(|| ArgumentError::NoValue(name.clone()))?;
            let number = found.numbers.iter_mut().find(|(known, _)| name.strip_prefix("--") == Some(known));
            match number {
                Some((_, number)) => *number = value.parse().map_err(|_| ArgumentError::NotANumber(name, value))?,
                None if name != "--format" => {
                    let known = names.iter().map(|(known, _)| *known).collect();
                    return Err(ArgumentError::Unknown(name, known));
                }
                None if formats.contains(&value.as_str()) => found.format = Some(value),
                None => {
                    let known = formats.iter().map(ToString::to_string).collect();
                    return Err(ArgumentError::UnknownFormat(value, known));
                }
            }
        }
        Ok(found)
    }

    /// The number of this name.
    pub fn number(&self, name: &str) -> u64 {
        self.numbers.iter().find(|(known, _)| *known == name).map_or(0, |(_, number)| *number)
    }

    /// Whether a format is asked for; all are where none was given.
    pub fn wants(&self, format: &str) -> bool {
        self.format.as_ref().is_none_or(|asked| asked == format)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(words: &str) -> Result<Arguments, ArgumentError> {
        let names = [("pairs", 7), ("seed", 1)];
        Arguments::read(words.split_whitespace().map(str::to_owned), &names, &["f32", "q16"])
    }

    #[test]
    fn what_is_not_known_is_refused() {
        let found = read("--seed 3 --format q16").unwrap();
        assert_eq!((found.number("pairs"), found.number("seed")), (7, 3));
        assert!(found.wants("q16") && !found.wants("f32") && read("").unwrap().wants("f32"));
        for (words, why) in [
            ("--pairs", "needs a value"),
            ("--pairs many", "not a number"),
            ("--format f16", "known are f32, q16"),
            ("--first 3", "allowed are --pairs, --seed and --format"),
        ] {
            assert!(read(words).unwrap_err().to_string().contains(why), "{words}");
        }
    }
}
