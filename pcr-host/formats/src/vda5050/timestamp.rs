//! Time stamps of messages: ISO 8601, UTC.

use std::time::{SystemTime, UNIX_EPOCH};

/// Now, as messages write it.
pub fn now() -> String {
    written(seconds())
}

/// Now \[s since 1970\].
pub fn seconds() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64())
}

/// A time \[s since 1970\], from 0 to the year 9999, to the millisecond.
pub fn written(seconds: f64) -> String {
    /// 1 January of the year 10000 \[s\].
    const END: f64 = 253_402_300_800.0;
    // Within the range a `u64` holds it.
    let millis = (seconds.clamp(0.0, END - 1.0) * 1e3).round() as u64;
    let (days, rest) = (millis / 86_400_000, millis % 86_400_000);
    // Years that begin in March, in cycles of 400.
    let since_march = days + 719_468;
    let (cycle, day) = (since_march / 146_097, since_march % 146_097);
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let date = day - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    let year = year + 400 * cycle + next;
    let [hours, minutes, seconds] = [rest / 3_600_000, rest / 60_000 % 60, rest / 1_000 % 60];
    format!("{year:04}-{month:02}-{date:02}T{hours:02}:{minutes:02}:{seconds:02}.{:03}Z", rest % 1_000)
}

#[cfg(test)]
mod tests {
    use super::written;
    use crate::import::seconds;

    #[test]
    fn what_is_written_is_read_as_the_same_time() {
        assert_eq!(written(0.0), "1970-01-01T00:00:00.000Z");
        assert_eq!(written(951_825_600.5), "2000-02-29T12:00:00.500Z");
        let (mut time, mut years) = (0.0, 0);
        while time < 253_402_300_000.0 {
            assert_eq!(seconds(&written(time)), Some(time), "{}", written(time));
            (time, years) = (time + 12_345_678.125 + 1.0 / 8.0, years + 1);
        }
        assert!(years > 20_000);
    }
}
