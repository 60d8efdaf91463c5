//! Textures of every dimension are created by their rules.

use estampe_texture::{
    LevelData, Limits, MipGeneration, TexelData, TexelDescriptor, TextureDimension, TextureError,
    TextureFormat,
};

pub(super) fn make(descriptor: TexelDescriptor) -> Result<TexelData, TextureError> {
    descriptor.create(&[], MipGeneration::None, &Limits::default())
}

pub(super) fn flat() -> TexelDescriptor {
    TexelDescriptor::new_2d(4, 4, TextureFormat::Rgba8Unorm)
}

fn block() -> TexelDescriptor {
    TexelDescriptor {
        dimension: TextureDimension::D3,
        depth_or_layers: 4,
        ..flat()
    }
}

fn row() -> TexelDescriptor {
    TexelDescriptor {
        dimension: TextureDimension::D1,
        height: 1,
        ..flat()
    }
}

/// Descriptors, and whether an error is that of the rule that they break.
type Broken = (TexelDescriptor, fn(&TextureError) -> bool);

fn broken() -> Vec<Broken> {
    use TextureError as E;
    let (block, row) = (block(), row());
    vec![
        (
            TexelDescriptor { width: 0, ..flat() },
            (|e| matches!(e, E::Empty { .. })) as fn(&E) -> bool,
        ),
        (
            TexelDescriptor {
                height: 16_385,
                ..flat()
            },
            |e| matches!(e, E::TooLarge { limit: 16_384, .. }),
        ),
        (
            TexelDescriptor {
                width: 2049,
                ..block
            },
            |e| matches!(e, E::TooLarge { limit: 2048, .. }),
        ),
        (
            TexelDescriptor {
                depth_or_layers: 257,
                ..flat()
            },
            |e| matches!(e, E::Slices { most: 256, .. }),
        ),
        (
            TexelDescriptor {
                depth_or_layers: 0,
                ..flat()
            },
            |e| matches!(e, E::Slices { .. }),
        ),
        (
            TexelDescriptor {
                depth_or_layers: 2049,
                ..block
            },
            |e| matches!(e, E::Slices { most: 2048, .. }),
        ),
        (TexelDescriptor { height: 2, ..row }, |e| {
            matches!(e, E::Slices { height: 2, .. })
        }),
        (
            TexelDescriptor {
                format: TextureFormat::Bc1RgbaUnorm,
                ..block
            },
            |e| matches!(e, E::NotFlat { .. }),
        ),
        (
            TexelDescriptor {
                format: TextureFormat::Depth32Float,
                ..row
            },
            |e| matches!(e, E::NotFlat { .. }),
        ),
        (
            TexelDescriptor {
                mip_level_count: 4,
                ..flat()
            },
            |e| matches!(e, E::LevelCount { most: 3, actual: 4 }),
        ),
        (
            TexelDescriptor {
                mip_level_count: 0,
                ..flat()
            },
            |e| matches!(e, E::LevelCount { .. }),
        ),
        (
            TexelDescriptor {
                sample_count: 3,
                ..flat()
            },
            |e| matches!(e, E::Samples { samples: 3 }),
        ),
        (
            TexelDescriptor {
                sample_count: 4,
                mip_level_count: 2,
                ..flat()
            },
            |e| matches!(e, E::Samples { .. }),
        ),
        (
            TexelDescriptor {
                width: 16_384,
                height: 16_384,
                depth_or_layers: 256,
                ..flat()
            },
            |e| matches!(e, E::TooManyTexels { .. }),
        ),
    ]
}

/// Rows: F2, N1.
#[test]
fn rules_that_are_broken_are_named() {
    for (descriptor, is_expected) in broken() {
        let error = make(descriptor).expect_err("a broken rule");
        assert!(is_expected(&error), "{error:?} of {descriptor:?}");
        assert!(error.to_string().len() > 20);
    }
    for descriptor in [
        flat().with_all_levels(),
        block().with_all_levels(),
        row().with_all_levels(),
        TexelDescriptor {
            depth_or_layers: 256,
            ..flat()
        },
        TexelDescriptor {
            sample_count: 16,
            ..flat()
        },
        TexelDescriptor {
            width: 16_384,
            height: 1,
            ..flat()
        },
    ] {
        let texture = make(descriptor).expect("within the rules");
        assert!(texture.texels.iter().all(|word| *word == 0));
    }
}

#[test]
fn rows_that_overlap_or_end_early_are_refused() {
    let bytes = [7; 64];
    let create =
        |data: LevelData<'_>| flat().create(&[data], MipGeneration::None, &Limits::default());
    let tight = LevelData::tight(&bytes);
    assert!(create(tight).is_ok());
    for (data, is_layout) in [
        (
            LevelData {
                bytes_per_row: Some(15),
                ..tight
            },
            true,
        ),
        (
            LevelData {
                rows_per_image: Some(3),
                ..tight
            },
            true,
        ),
        (
            LevelData {
                bytes_per_row: Some(17),
                ..tight
            },
            false,
        ),
        (LevelData::tight(&bytes[..63]), false),
        (
            LevelData {
                bytes_per_row: Some(u32::MAX),
                rows_per_image: Some(u32::MAX),
                ..tight
            },
            false,
        ),
    ] {
        let error = create(data).expect_err("short");
        let is_row_layout = matches!(
            error,
            TextureError::RowLayout {
                bytes_per_row: 16,
                ..
            }
        );
        assert_eq!(is_row_layout, is_layout, "{error:?}");
    }
    let both = [tight, tight];
    let error = flat().create(&both, MipGeneration::None, &Limits::default());
    assert!(matches!(
        error,
        Err(TextureError::LevelCount { most: 1, actual: 2 })
    ));
}
