//! Date, processor and versions of a measurement: the first line of every table.

use crate::process::run;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

/// The repository that this program was built from.
#[must_use]
pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Date, processor and versions of a measurement.
#[derive(Debug, Clone, Default)]
pub struct Versions {
    /// The day, as 2026-11-21.
    pub date: String,
    /// The processor's name and the number of its cores.
    pub processor: String,
    /// The processor's maker as one word in lower case: intel, amd, or what it calls itself.
    pub vendor: String,
    /// Version and commit of estampe.
    pub estampe: String,
    /// Version of the compiler.
    pub rustc: String,
}

impl Versions {
    /// Determines the versions and the machine of this process.
    #[must_use]
    pub fn here() -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        let days = since.map_or(0, |time| time.as_secs() / 86_400);
        let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let mut git = Command::new("git");
        git.args(["describe", "--always", "--dirty"]);
        let commit = run(git.current_dir(repository()));
        let version = format!("estampe {}", env!("CARGO_PKG_VERSION"));
        Self {
            date: date_of(days),
            processor: processor(&cpu),
            vendor: vendor(&cpu),
            estampe: match commit {
                Ok(commit) => format!("{version}, {}", commit.trim()),
                Err(_) => version,
            },
            rustc: run(Command::new("rustc").arg("-V")).map_or_else(
                |_| "rustc unknown".to_owned(),
                |text| text.trim().to_owned(),
            ),
        }
    }
}

/// The first processor's name in `/proc/cpuinfo`, and the number of processors.
fn processor(cpuinfo: &str) -> String {
    let mut names = fields(cpuinfo, "model name");
    match names.next() {
        Some(name) => format!("{name}, {} cores", names.count() + 1),
        None => "an unknown processor".to_owned(),
    }
}

/// The first processor's maker in `/proc/cpuinfo`.
fn vendor(cpuinfo: &str) -> String {
    match fields(cpuinfo, "vendor_id").next() {
        Some("GenuineIntel") => "intel".to_owned(),
        Some("AuthenticAMD") => "amd".to_owned(),
        other => other.unwrap_or("unknown").to_ascii_lowercase(),
    }
}

/// The values of a field, one for each processor.
fn fields<'text>(cpuinfo: &'text str, name: &str) -> impl Iterator<Item = &'text str> {
    let value = move |line: &'text str| {
        let (key, value) = line.split_once(':')?;
        (key.trim() == name).then_some(value.trim())
    };
    cpuinfo.lines().filter_map(value)
}

/// The date of a day since 1970-01-01 in the form 2026-11-21, by the Gregorian calendar.
fn date_of(days: u64) -> String {
    let (mut year, mut left) = (1970, days);
    let is_leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    while left >= 365 + u64::from(is_leap(year)) {
        left -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let february = 28 + u64::from(is_leap(year));
    let mut month = 1;
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31] {
        if left < length {
            break;
        }
        left -= length;
        month += 1;
    }
    format!("{year}-{month:02}-{:02}", left + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_become_dates() {
        assert_eq!(date_of(0), "1970-01-01");
        assert_eq!(date_of(11_016), "2000-02-29");
        assert_eq!(date_of(20_778), "2026-11-21");
        assert_eq!(date_of(47_540), "2100-02-28");
        assert_eq!(date_of(47_541), "2100-03-01");
    }

    #[test]
    fn processors_are_named_and_counted() {
        let text = "processor\t: 0\nmodel name\t: A B\nprocessor\t: 1\nmodel name\t: A B\n";
        assert_eq!(processor(text), "A B, 2 cores");
        assert_eq!(processor(""), "an unknown processor");
        assert_eq!(vendor("vendor_id\t: GenuineIntel\n"), "intel");
        assert_eq!(vendor("vendor_id\t: AuthenticAMD\n"), "amd");
        assert_eq!(vendor(text), "unknown");
    }
}
