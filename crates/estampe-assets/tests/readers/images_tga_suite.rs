//! The TGA conformance suite and its reference PNGs.
#![expect(clippy::print_stdout, reason = "a file without a reference says so")]

/// Tests of data that is not part of the project: `cargo test -- --ignored shared_data::`.
mod shared_data {
    use estampe_assets::Limits;
    use estampe_assets::image::decode;
    use std::fs;
    use std::path::{Path, PathBuf};

    /// The reference of a TGA file: `NAME.tga.png`, or `SIZE_KIND.png` for
    /// `SIZE_KIND_ORIGIN_CODING.tga`; for the mapped `ucm8`, the reference of the true-colour
    /// `utc24`, which has the same image.
    fn reference_of(tga: &Path) -> Option<PathBuf> {
        let name = tga.file_name()?.to_str()?;
        let stem = tga.file_stem()?.to_str()?;
        let kind = stem.rsplitn(3, '_').last()?;
        [
            format!("{name}.png"),
            format!("{kind}.png"),
            name.replace("ucm8", "utc24") + ".png",
        ]
        .into_iter()
        .map(|name| tga.with_file_name(name))
        .find(|path| path.is_file())
    }

    #[test]
    #[ignore = "needs ../shared/data/tga"]
    fn every_file_equals_its_reference() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/tga");
        let entries = fs::read_dir(&folder);
        let entries = entries.unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        let mut compared = 0;
        for entry in entries {
            let path = entry.expect("a folder entry").path();
            if path.extension().is_none_or(|extension| extension != "tga") {
                continue;
            }
            let read = |path: &Path| {
                let bytes = fs::read(path).expect("a readable file");
                decode(&bytes, &Limits::default())
                    .unwrap_or_else(|e| panic!("{}: {e}", path.display()))
            };
            let image = read(&path);
            let Some(reference) = reference_of(&path) else {
                println!("{}: decodes, has no reference", path.display());
                continue;
            };
            let expected = read(&reference);
            assert_eq!(
                (image.width, image.height),
                (expected.width, expected.height)
            );
            let wrong = image
                .rgba
                .iter()
                .zip(&expected.rgba)
                .filter(|(a, b)| a != b)
                .count();
            assert_eq!(wrong, 0, "{}: {wrong} values differ", path.display());
            compared += 1;
        }
        assert!(compared >= 13, "only {compared} files have references");
    }
}
