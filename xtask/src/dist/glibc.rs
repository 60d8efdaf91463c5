//! The C library that a program needs: the highest glibc version among its versioned symbols.
//!
//! A dynamic ELF program lists for each library the versions of the symbols that it uses
//! (`SHT_GNU_verneed`, Linux Standard Base, "Symbol Versioning"). The loader of an older system
//! refuses the program by these versions, so the highest is the oldest system on which it runs.

use object::elf::{DT_NEEDED, FileHeader32, FileHeader64};
use object::read::elf::{Dyn, FileHeader};
use object::{Endianness, FileKind};

/// A version, such as 2.34 or 2.2.5.
type Version = Vec<u32>;

/// The requirement of a program in words; `None` if it is no ELF file.
pub(super) fn requirement(file: &[u8]) -> Result<Option<String>, object::Error> {
    let linkage = match FileKind::parse(file)? {
        FileKind::Elf32 => linkage::<FileHeader32<Endianness>>(file)?,
        FileKind::Elf64 => linkage::<FileHeader64<Endianness>>(file)?,
        _ => return Ok(None),
    };
    Ok(Some(match linkage {
        Linkage::Static => "static: the program needs no library".to_owned(),
        Linkage::Glibc(version) => {
            let parts: Vec<String> = version.iter().map(u32::to_string).collect();
            format!("the program needs glibc {} or later", parts.join("."))
        }
        Linkage::Other => "the program needs a C library other than glibc".to_owned(),
    }))
}

/// How a program is linked.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Linkage {
    /// With no shared library.
    Static,
    /// With glibc of at least this version.
    Glibc(Version),
    /// With shared libraries, of which none has versions of glibc.
    Other,
}

fn linkage<Elf: FileHeader<Endian = Endianness>>(file: &[u8]) -> Result<Linkage, object::Error> {
    let header = Elf::parse(file)?;
    let endian = header.endian()?;
    let sections = header.sections(endian, file)?;
    let needs_library = match sections.dynamic(endian, file)? {
        Some((entries, _)) => entries.iter().any(|entry| entry.tag(endian) == DT_NEEDED),
        None => false,
    };
    if !needs_library {
        return Ok(Linkage::Static);
    }
    let mut names = Vec::new();
    if let Some((mut libraries, strings)) = sections.gnu_verneed(endian, file)? {
        let strings = sections.strings(endian, file, strings)?;
        while let Some((_, mut versions)) = libraries.next()? {
            while let Some(version) = versions.next()? {
                names.push(String::from_utf8_lossy(version.name(endian, strings)?).into_owned());
            }
        }
    }
    Ok(highest(&names).map_or(Linkage::Other, Linkage::Glibc))
}

/// The highest version of glibc among the names of versions.
fn highest(names: &[String]) -> Option<Version> {
    names.iter().filter_map(|name| glibc_version(name)).max()
}

/// The version in `GLIBC_2.34`. Other libraries have other names, and `GLIBC_PRIVATE` is none.
fn glibc_version(name: &str) -> Option<Version> {
    let parts = name.strip_prefix("GLIBC_")?.split('.');
    parts.map(|part| part.parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_compared_as_numbers() {
        let highest_of = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(ToString::to_string).collect();
            highest(&names)
        };
        assert_eq!(
            highest_of(&["GLIBC_2.2.5", "GLIBC_2.34", "GLIBC_2.9"]),
            Some(vec![2, 34])
        );
        assert_eq!(
            highest_of(&["GLIBC_2.3", "GLIBC_2.3.4"]),
            Some(vec![2, 3, 4])
        );
        assert_eq!(
            highest_of(&["GCC_3.0", "GLIBC_PRIVATE", "GLIBCXX_3.4"]),
            None
        );
        assert_eq!(highest_of(&[]), None);
    }

    /// This test is a program too.
    #[test]
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    fn a_program_of_this_system_needs_its_glibc() {
        let path = std::env::current_exe().expect("the test has a file");
        let file = std::fs::read(path).expect("the test can be read");
        let requirement = requirement(&file)
            .expect("an ELF file")
            .expect("an ELF file");
        if cfg!(target_feature = "crt-static") {
            assert!(requirement.starts_with("static"), "{requirement}");
        } else {
            // The standard library asks for 2.17 at least.
            let version = requirement
                .strip_prefix("the program needs glibc 2.")
                .and_then(|rest| rest.split([' ', '.']).next()?.parse().ok());
            assert!(
                version.is_some_and(|minor: u32| minor >= 17),
                "{requirement}"
            );
        }
    }

    /// A header without sections or segments: no shared library.
    #[test]
    fn a_program_without_dynamic_section_is_static() {
        let mut file = [0; 64];
        file[..7].copy_from_slice(b"\x7fELF\x02\x01\x01"); // 64 bits, little-endian, version 1
        file[16] = 2; // a program
        file[18] = 62; // x86-64
        file[20] = 1; // version 1
        file[52] = 64; // the header's length
        let requirement = requirement(&file)
            .expect("an ELF file")
            .expect("an ELF file");
        assert!(requirement.starts_with("static"), "{requirement}");
    }

    #[test]
    fn files_that_are_no_programs_are_errors() {
        assert!(requirement(b"no program").is_err());
    }
}
