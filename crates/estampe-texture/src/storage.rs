//! Storage textures: creation, loads, stores and readback.
//!
//! Threads draw tiles in parallel, so texels are atomic words. Their ordering is relaxed: until the
//! pass has ended, a fragment may or may not see what another one stored. A store takes a mask of
//! lanes, because helper invocations and discarded fragments must not store.

use crate::view::{Answers, answer, by_sixteen, packet, packet_of_ints};
use crate::{LevelData, MipGeneration, TexelDescriptor, TextureError};
use estampe_format::TexelCodec;
use estampe_simd::{LANES, Packet};
use estampe_types::{
    Int, Limits, Real, StorageTexture, TexelData, TexelEncoding, TextureFormat, Vec4,
};

/// Creates a storage texture from data, or of zeros without data. It has one mip level and one
/// sample; its format is a colour format that is neither sRGB nor compressed nor of a shared
/// exponent.
///
/// # Errors
/// [`TextureError`] when the descriptor breaks a rule, bytes are missing, or memory is short.
pub fn create_storage_texture(
    descriptor: &TexelDescriptor,
    data: Option<LevelData<'_>>,
    limits: &Limits,
) -> Result<StorageTexture, TextureError> {
    let format = descriptor.format;
    if !is_storable(format) {
        return Err(TextureError::NotStorable { format });
    }
    descriptor.check(limits)?;
    if descriptor.mip_level_count != 1 {
        return Err(TextureError::LevelCount {
            most: 1,
            actual: descriptor.mip_level_count as usize,
        });
    }
    let samples = descriptor.sample_count;
    if samples != 1 {
        return Err(TextureError::Samples { samples });
    }
    let size = (descriptor.width, descriptor.height);
    let slices = descriptor.depth_or_layers;
    let made = StorageTexture::zeros(format, size, descriptor.dimension, slices);
    let made = made.ok_or_else(|| {
        let texels = u64::from(size.0) * u64::from(size.1) * u64::from(slices);
        TextureError::OutOfMemory {
            // A texel takes at least one word.
            bytes: texels * u64::from(format.block_bytes().max(4)),
        }
    })?;
    if let Some(data) = data {
        let given = descriptor.create(&[data], MipGeneration::None, limits)?;
        for (index, word) in given.texels.iter().enumerate() {
            made.store(index, *word);
        }
    }
    Ok(made)
}

/// Returns true if shaders can store texels of a format: colours without blocks, sRGB or shared
/// exponent.
#[must_use]
pub fn is_storable(format: TextureFormat) -> bool {
    format.is_color()
        && !format.is_compressed()
        && !format.is_srgb()
        && format.encoding() != TexelEncoding::SharedExponent
}

/// Loads the texel (x, y) of a slice (`textureLoad`); zeros outside the texture. Integer formats
/// give the [bits](Real::to_bits).
#[inline(always)]
pub fn storage_load<I: Int>(texture: &StorageTexture, at: [I; 3]) -> Vec4<I::Real> {
    let like = at[0].to_real();
    like.out_of_line(
        #[inline(always)]
        || {
            by_sixteen(
                like,
                #[inline(always)]
                |first| load_lanes(texture, &Places::new(at, first, u64::MAX)),
            )
        },
    )
}

/// Stores the texel (x, y) of a slice for the lanes of the mask (`textureStore`); nothing outside
/// the texture. Numbers are encoded as in render targets; integer formats store the bits of the
/// value.
#[inline(always)]
pub fn storage_store<R: Real>(
    texture: &StorageTexture,
    mask: R::SelectMask,
    at: [R::Int; 3],
    value: Vec4<R>,
) {
    value.x.out_of_line(
        #[inline(always)]
        || {
            for first in (0..R::LANES).step_by(LANES) {
                let places = Places::new(at, first, R::mask_bits(mask) >> first);
                let texels = [
                    packet(value.x, first),
                    packet(value.y, first),
                    packet(value.z, first),
                    packet(value.w, first),
                ];
                store_lanes(texture, &places, &texels);
            }
        },
    );
}

/// The texel coordinates of up to sixteen lanes.
struct Places {
    at: [Packet<i32>; 3],
    count: usize,
    /// The lanes that store.
    mask: u64,
}

impl Places {
    #[inline(always)]
    fn new<I: Int>([x, y, slice]: [I; 3], first: usize, mask: u64) -> Self {
        Self {
            at: [
                packet_of_ints(x, first),
                packet_of_ints(y, first),
                packet_of_ints(slice, first),
            ],
            count: <I::Real as Real>::LANES.min(LANES),
            mask,
        }
    }

    fn of_lane(&self, lane: usize) -> [i32; 3] {
        self.at.each_ref().map(|of_lanes| of_lanes.0[lane])
    }
}

#[inline(never)]
fn load_lanes(texture: &StorageTexture, places: &Places) -> Answers {
    let mut texels = Answers::default();
    let codec = TexelCodec::new(stored(texture));
    for lane in 0..places.count {
        if let Some(index) = texture.index(places.of_lane(lane)) {
            let mut words = [0; 4];
            for (k, word) in words.iter_mut().enumerate().take(codec.words()) {
                *word = texture.load(index + k);
            }
            answer(&mut texels, lane, codec.decode(&words));
        }
    }
    texels
}

#[inline(never)]
fn store_lanes(texture: &StorageTexture, places: &Places, texels: &Answers) {
    let codec = TexelCodec::new(stored(texture));
    for lane in 0..places.count {
        if places.mask >> lane & 1 == 0 {
            continue;
        }
        if let Some(index) = texture.index(places.of_lane(lane)) {
            let texel = texels.each_ref().map(|of_lanes| of_lanes.0[lane]);
            for (k, word) in codec
                .encode(texel)
                .into_iter()
                .enumerate()
                .take(codec.words())
            {
                texture.store(index + k, word);
            }
        }
    }
}

/// The format in which texels are stored: R first.
pub(crate) fn stored(texture: &StorageTexture) -> TextureFormat {
    match texture.format() {
        TextureFormat::Bgra8Unorm => TextureFormat::Rgba8Unorm,
        format => format,
    }
}

/// Reads a storage texture back: the format's bytes in rows without padding, slice after slice.
#[must_use]
pub fn storage_bytes(texture: &StorageTexture) -> Vec<u8> {
    let size = texture.format().block_bytes() as usize;
    let count = texture.words_per_texel();
    let mut bytes = Vec::with_capacity(texture.len() / count.max(1) * size);
    for texel in (0..texture.len()).step_by(count.max(1)) {
        let mut of_texel = [0; 16];
        for (k, four) in of_texel
            .as_chunks_mut::<4>()
            .0
            .iter_mut()
            .enumerate()
            .take(count)
        {
            *four = texture.load(texel + k).to_le_bytes();
        }
        if texture.format().is_bgra() {
            of_texel.swap(0, 2);
        }
        bytes.extend_from_slice(&of_texel[..size]);
    }
    bytes
}

/// Copies a storage texture to a texture that can be sampled; `mips` says whether mip levels are
/// generated.
///
/// # Errors
/// [`TextureError`] when memory is short, or mip levels cannot be generated for the format.
pub fn storage_texture_to_texture(
    texture: &StorageTexture,
    mips: MipGeneration,
) -> Result<TexelData, TextureError> {
    let descriptor = TexelDescriptor {
        dimension: texture.shape().dimension,
        depth_or_layers: texture.shape().depth_or_layers,
        ..TexelDescriptor::new_2d(texture.width(), texture.height(), texture.format())
    };
    let descriptor = match mips {
        MipGeneration::None => descriptor,
        MipGeneration::Full => descriptor.with_all_levels(),
    };
    let bytes = storage_bytes(texture);
    let data = [LevelData::tight(&bytes)];
    descriptor.create(&data, mips, &Limits::default())
}
