//! Every example draws its picture in `docs/images/examples`, byte for byte, at the narrowest SIMD
//! level on one thread, and at the widest on two.
//!
//! The test of an example is in its file: a program of all examples would compile them twice.
//! `UPDATE_PICTURES=1 cargo test -p estampe-gpu --examples` writes the pictures anew: look at each
//! that changed.

use estampe::{Device, DeviceDescriptor, Level, Texture};
use std::error::Error;
use std::path::Path;

/// Compares the picture with `docs/images/examples/NAME.png`.
pub(crate) fn check(name: &str, picture: fn(&Device) -> Result<Texture, Box<dyn Error>>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/images/examples");
    let path = folder.join(format!("{name}.png"));
    let levels = Level::all_available();
    let narrowest = *levels.first().expect("there is a level");
    for (level, threads) in [(Level::best(), 2), (narrowest, 1)] {
        let device = Device::new(&DeviceDescriptor {
            threads,
            level,
            ..DeviceDescriptor::default()
        });
        let device = device.expect("the system starts two threads");
        let picture = picture(&device).expect("the example runs");
        let drawn = device.encode_png(&picture).expect("it can be encoded");
        if std::env::var_os("UPDATE_PICTURES").is_some() && threads == 2 {
            std::fs::write(&path, &drawn).expect("the picture can be written");
        }
        let expected = std::fs::read(&path).expect("the example has a picture");
        assert!(
            drawn == expected,
            "{name} draws another picture than {} at {level:?} on {threads} threads. If the \
             change is meant, write it anew: UPDATE_PICTURES=1 cargo test -p estampe-gpu --example {name}",
            path.display()
        );
    }
}
