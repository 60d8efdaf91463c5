//! Execution of other programs.

use crate::BenchError;
use std::ffi::OsStr;
use std::process::Command;

/// Runs a command to its end and returns its standard output.
///
/// # Errors
/// [`BenchError::Command`] if it cannot be run or fails.
pub(crate) fn run(command: &mut Command) -> Result<String, BenchError> {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    let words: Vec<_> = words.map(OsStr::to_string_lossy).collect();
    let line = words.join(" ");
    let fault = |reason: String| BenchError::Command {
        command: line.clone(),
        reason,
    };
    let output = command.output().map_err(|error| fault(error.to_string()))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(fault(format!("{}: {}", output.status, said.trim())));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_command() {
        let error = run(Command::new("command-of-nowhere").arg("x")).unwrap_err();
        assert!(error.to_string().starts_with("command-of-nowhere x: "));
    }
}
