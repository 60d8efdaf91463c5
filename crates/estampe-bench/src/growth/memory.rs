//! Memory per triangle and per pixel: the process's resident memory before and after drawing.
//!
//! All data and devices are created first and kept to the end: an allocator without free memory of
//! its own has to request new memory from the system. A device keeps its memory too, so that a
//! larger frame adds only the difference.

use super::fans::{Work, square};
use super::meshes::{CLASSES, SizeClass, mesh};
use crate::BenchError;
use crate::frame::PreparedScene;
use crate::stages::SIZE;
use estampe::{Device, DeviceDescriptor, Level};

/// Memory of the triangles of a size class.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TriangleMemory {
    /// The size class.
    pub class: SizeClass,
    /// Bytes per triangle, for frames that fit into one draw batch.
    pub each: f64,
}

/// The measurements, in bytes.
#[derive(Debug, Clone, PartialEq)]
pub struct Memory {
    /// By size class.
    pub triangles: Vec<TriangleMemory>,
    /// A frame of a million triangles of the smallest class.
    pub one_million: f64,
    /// A frame of four million triangles, which are several draw batches.
    pub four_millions: f64,
    /// Each pixel of a target of RGBA8 and 32-bit depth.
    pub pixel: f64,
}

/// Bytes of a pixel's colour and depth.
const PIXEL_BYTES: f64 = 8.0;

impl Memory {
    /// Measures; `None` if the system does not report resident memory.
    ///
    /// # Errors
    /// [`BenchError`] if a device cannot be created.
    pub fn measure(level: Level) -> Result<Option<Self>, BenchError> {
        const FEW: u32 = 10;
        const MILLION: u32 = 1_000_000;
        if resident_bytes().is_none() {
            return Ok(None);
        }
        let classes = CLASSES.map(|class| [FEW, MILLION].map(|count| mesh(class, count)));
        let many = mesh(CLASSES[0], 4 * MILLION);
        let devices = [one_thread(level)?, one_thread(level)?, one_thread(level)?];
        let mut kept = Vec::new();
        let mut triangles = Vec::new();
        let (mut one_million, mut four_millions) = (0.0, 0.0);
        for (number, (class, scenes)) in CLASSES.into_iter().zip(&classes).enumerate() {
            let mut few = PreparedScene::new(&devices[number], &scenes[0], SIZE)?;
            let mut million = PreparedScene::new(&devices[number], &scenes[1], SIZE)?;
            growth_of(&mut few);
            let growth = growth_of(&mut million);
            triangles.push(TriangleMemory {
                class,
                each: growth / f64::from(MILLION - FEW),
            });
            kept.extend([few, million]);
            if number == 0 {
                let mut many = PreparedScene::new(&devices[number], &many, SIZE)?;
                one_million = growth;
                four_millions = growth + growth_of(&mut many);
                kept.push(many);
            }
        }
        let clear = Work::Clear.scene();
        let mut small = PreparedScene::new(&devices[0], &clear, square(1024))?;
        let mut large = PreparedScene::new(&devices[0], &clear, square(4096))?;
        let pixels = |side: u32| f64::from(side) * f64::from(side);
        let [of_small, of_large] = [&mut small, &mut large].map(resident_by_drawing);
        drop(kept);
        Ok(Some(Self {
            triangles,
            one_million,
            four_millions,
            pixel: (of_large - of_small) / (pixels(4096) - pixels(1024)),
        }))
    }
}

fn one_thread(level: Level) -> Result<Device, BenchError> {
    Ok(Device::new(&DeviceDescriptor {
        threads: 1,
        level,
        ..DeviceDescriptor::default()
    })?)
}

/// The memory by which the device grows when it draws a mesh, without its target.
fn growth_of(scene: &mut PreparedScene<'_>) -> f64 {
    // The first frame touches the target's memory; rows of tiles are complete.
    let target = f64::from(SIZE.width * SIZE.height.next_multiple_of(64)) * PIXEL_BYTES;
    resident_by_drawing(scene) - target
}

/// The increase of resident memory by drawing.
fn resident_by_drawing(scene: &mut PreparedScene<'_>) -> f64 {
    let before = resident_bytes().unwrap_or_default();
    scene.draw();
    scene.draw();
    resident_bytes().unwrap_or_default() - before
}

/// Resident memory of this process.
fn resident_bytes() -> Option<f64> {
    field_bytes(&std::fs::read_to_string("/proc/self/status").ok()?, "VmRSS")
}

/// A field of `/proc/self/status` (proc_pid_status(5)) in bytes; the file has units of 1024 bytes.
fn field_bytes(status: &str, name: &str) -> Option<f64> {
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    let number = line.trim_start_matches(':').split_whitespace().next()?;
    Some(number.parse::<f64>().ok()? * 1024.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_found_by_name() {
        let status = "Name:\tx\nVmHWM:\t    2048 kB\nVmRSS:\t    1024 kB\n";
        assert_eq!(field_bytes(status, "VmRSS"), Some(1_048_576.0));
        assert_eq!(field_bytes(status, "VmHWM"), Some(2_097_152.0));
        assert_eq!(field_bytes(status, "VmSwap"), None);
    }
}
