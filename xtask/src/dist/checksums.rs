//! `SHA256SUMS`: the checksums of all archives of a folder, as `sha256sum --check` reads them.

use sha2::{Digest, Sha256};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Writes the file anew and returns its path.
pub(super) fn write(folder: &Path) -> io::Result<PathBuf> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        names.extend(name.ends_with(".tar.gz").then_some(name));
    }
    names.sort();
    let mut text = String::new();
    for name in names {
        text += &line(&name, &fs::read(folder.join(&name))?);
    }
    let path = folder.join("SHA256SUMS");
    fs::write(&path, text)?;
    Ok(path)
}

/// The line of a file.
fn line(name: &str, bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    let digits: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
    format!("{digits}  {name}\n")
}

#[cfg(test)]
mod tests {
    use super::line;

    /// The first example of FIPS 180-4.
    #[test]
    fn a_line_is_that_of_sha256sum() {
        let sum = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(line("a.tar.gz", b"abc"), format!("{sum}  a.tar.gz\n"));
    }
}
