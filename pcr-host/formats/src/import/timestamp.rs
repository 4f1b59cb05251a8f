//! Time stamps of ISO 8601: `2017-04-15T11:40:03.123Z`, also with an offset instead of `Z`.

/// Seconds since 1970 of a time stamp; nothing for what is none, a 31st of February among it.
pub fn seconds(stamp: &str) -> Option<f64> {
    Timestamp::read(stamp).map(|Timestamp { whole, fraction }| whole as f64 + fraction)
}

/// A time stamp with all its digits: as one number of seconds since 1970 it would be off by 0.2 µs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Timestamp {
    /// Seconds since 1970.
    whole: i64,
    fraction: f64,
}

impl Timestamp {
    /// Nothing for what is no time stamp, a 31st of February among it.
    pub(super) fn read(stamp: &str) -> Option<Self> {
        let (date, time) = stamp.trim().split_once(['T', 't', ' '])?;
        let at = time.find(['Z', 'z', '+', '-']).unwrap_or(time.len());
        let (time, zone) = time.split_at_checked(at)?;
        let (seconds, fraction) = clock(time)?;
        Some(Self { whole: days(date)? * 86_400 + seconds - offset(zone)?, fraction })
    }

    /// A number of seconds, of which the text has all digits.
    pub(super) fn of_seconds(text: &str, seconds: f64) -> Self {
        let decimal = text.split_once('.').filter(|(whole, _)| !whole.is_empty() && !whole.starts_with('-'));
        let digits = decimal.and_then(|(whole_part, fraction)| {
            whole(fraction)?;
            Some(Self { whole: whole(whole_part)?, fraction: format!("0.{fraction}").parse().ok()? })
        });
        digits.unwrap_or(Self { whole: seconds.floor() as i64, fraction: seconds - seconds.floor() })
    }

    /// A whole number of seconds.
    pub(super) fn of_whole(whole: i64) -> Self {
        Self { whole, fraction: 0.0 }
    }

    /// A part of a second later.
    #[cfg(feature = "bags")]
    pub(super) fn plus(self, fraction: f64) -> Self {
        Self { fraction: self.fraction + fraction, ..self }
    }

    /// Whole seconds, rounded down.
    pub(super) fn whole(self) -> i64 {
        self.whole
    }

    /// Seconds since another one.
    pub(super) fn since(self, other: Self) -> f64 {
        (self.whole - other.whole) as f64 + (self.fraction - other.fraction)
    }
}

/// Days since 1970 of a date.
fn days(date: &str) -> Option<i64> {
    let mut parts = date.split('-').map(whole);
    let (year, month, day) = (parts.next()??, parts.next()??, parts.next()??);
    let leaps = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let last = match month {
        2 => 28 + i64::from(leaps),
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => return None,
    };
    if parts.next().is_some() || !(1600..=9999).contains(&year) || !(1..=last).contains(&day) {
        return None;
    }
    // Since 1 March of the year 0, by years that begin in March.
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    Some(365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day - 1 - 719_468)
}

/// Seconds since midnight, and the fraction of one; the second may be a leap second, and be left out.
fn clock(time: &str) -> Option<(i64, f64)> {
    let mut parts = time.split(':');
    let (hours, minutes) = (below(parts.next()?, 24)?, below(parts.next()?, 60)?);
    let (seconds, fraction) = match parts.next() {
        None => (0, 0.0),
        Some(text) => {
            let (second, fraction) = text.split_once('.').unwrap_or((text, "0"));
            whole(fraction)?;
            (below(second, 61)?, format!("0.{fraction}").parse().ok()?)
        }
    };
    parts.next().is_none().then_some((hours * 3600 + minutes * 60 + seconds, fraction))
}

/// How far a zone is ahead \[s\]: `Z` or nothing, `+01:00`, `+0100` or `+01`.
fn offset(zone: &str) -> Option<i64> {
    let sign = match zone.chars().next() {
        None => return Some(0),
        Some('Z' | 'z') => return (zone.len() == 1).then_some(0),
        Some('-') => -1,
        Some(_) => 1,
    };
    let digits = zone.get(1..)?;
    let (hours, minutes) = match digits.split_once(':') {
        Some(parts) => parts,
        None if digits.len() == 4 => digits.split_at_checked(2)?,
        None => (digits, "0"),
    };
    Some(sign * (below(hours, 24)? * 3600 + below(minutes, 60)? * 60))
}

/// A whole number below a limit.
fn below(text: &str, limit: i64) -> Option<i64> {
    whole(text).filter(|number| *number < limit)
}

/// A number of digits only.
fn whole(text: &str) -> Option<i64> {
    let digits = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    // Of a fraction no more digits count than are read here.
    if digits { text.get(..text.len().min(18))?.parse().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps() {
        assert_eq!(seconds("1970-01-01T00:00:00Z"), Some(0.0));
        assert_eq!(seconds("2000-02-29T12:00:00.500Z"), Some(951_825_600.5));
        assert_eq!(seconds("2026-11-21T08:30:00+01:00"), seconds("2026-11-21T07:30:00Z"));
        assert_eq!(seconds("2026-11-21T08:45:10-00:30"), Some(1_795_252_510.0));
        assert_eq!(seconds("2101-03-01T00:00:00Z"), Some(4_139_078_400.0));
        assert_eq!(seconds("2016-12-31T23:59:60Z"), seconds("2017-01-01T00:00:00Z"));
        for zone in ["+0100", "+01", "+01:00"] {
            assert_eq!(seconds(&format!("2026-11-21T08:30{zone}")), seconds("2026-11-21 07:30:00"), "{zone}");
        }
    }

    #[test]
    fn differences_have_all_digits() {
        let [first, second] = ["2026-11-21T08:30:00.123456Z", "2026-11-21T09:30:00.224859+01:00"]
            .map(|text| Timestamp::read(text).unwrap());
        assert!((second.since(first) - 0.101403).abs() < 1e-15 && (first.since(second) + 0.101403).abs() < 1e-15);
        let midnight = Timestamp::read("2026-11-22T00:00:00.000001Z").unwrap();
        assert!((midnight.since(first) - 55_799.876545).abs() < 1e-11);
    }

    #[test]
    fn what_is_no_time_is_no_stamp() {
        for wrong in
            ["", "T", "2026-13-01T00:00:00Z", "2026-01-01", "x-1-1T1", "2026-01-01T-:00", "+2026-01-01T00:00:00Z"]
        {
            assert_eq!(seconds(wrong), None, "{wrong}");
        }
        for clock in [
            "24:00:00Z",
            "00:60:00Z",
            "00:00:61Z",
            "99:99:99Z",
            "00:00:00:00Z",
            "0x0:00Z",
            "00:00:1e1Z",
            "00:00:00.Z",
            "00",
        ] {
            assert_eq!(seconds(&format!("2024-01-01T{clock}")), None, "{clock}");
        }
        for zone in ["Z junk", "Z+05:00", "ZZ", "+05:00Z", "+25:00", "+05:60", "+", "+5:00:00", "CET"] {
            assert_eq!(seconds(&format!("2024-01-01T00:00:10{zone}")), None, "{zone}");
        }
        for date in
            ["2024-02-30", "2023-02-29", "1900-02-29", "2024-04-31", "2024-01-00", "2024-01-32", "2024-01-01-01"]
        {
            assert_eq!(seconds(&format!("{date}T00:00:00Z")), None, "{date}");
        }
        assert!(
            seconds("2024-02-29T00:00:00Z").is_some()
                && seconds("2024-12-31T00:00:00.123456789123456789123Z").is_some()
        );
    }
}
