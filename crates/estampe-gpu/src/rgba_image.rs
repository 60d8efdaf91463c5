//! Textures to and from `image::RgbaImage`: the feature `image`.

use crate::{Device, Texture, TextureDescriptor, TextureError, TextureFormat, rgba};
use image::RgbaImage;

/// # Images of the `image` crate
///
/// With the feature `image`.
impl Device {
    /// Creates a 2D texture of an image, with all mip levels. Colours of image files are sRGB:
    /// [`TextureFormat::Rgba8UnormSrgb`]; normal maps and other numbers are
    /// [`TextureFormat::Rgba8Unorm`].
    ///
    /// ```
    /// # use estampe::{Device, DeviceDescriptor, TextureFormat};
    /// let device = Device::new(&DeviceDescriptor::default())?;
    /// let image = image::RgbaImage::from_pixel(4, 2, image::Rgba([10, 20, 30, 255]));
    /// let texture = device.create_texture_from_image(&image, TextureFormat::Rgba8UnormSrgb)?;
    /// assert_eq!(texture.mip_level_count(), 3);
    /// assert_eq!(device.read_image(&texture)?, image);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`TextureError`] if the format is not rgba8unorm, bgra8unorm or their sRGB counterparts, or
    /// the image is empty or too large.
    pub fn create_texture_from_image(
        &self,
        image: &RgbaImage,
        format: TextureFormat,
    ) -> Result<Texture, TextureError> {
        let descriptor = TextureDescriptor::new_2d(image.width(), image.height(), format);
        let Some(is_bgra) = rgba::is_bgra(format) else {
            return Err(TextureError::Unsupported {
                texture: "a texture of an image".to_owned(),
                format,
                samples: 1,
                rule: "images become rgba8unorm, bgra8unorm or their sRGB counterparts",
            });
        };
        let descriptor = descriptor.with_all_levels();
        if !is_bgra {
            return self.create_texture_with_data(&descriptor, &[image.as_raw()]);
        }
        let mut texels = image.as_raw().clone();
        rgba::swap_red_and_blue(&mut texels);
        self.create_texture_with_data(&descriptor, &[&texels])
    }

    /// Reads the first mip level and layer of a texture as an image.
    ///
    /// # Errors
    /// [`TextureError`] if the format is not rgba8unorm, bgra8unorm or their sRGB counterparts, or
    /// the texture cannot be read, as for [`Device::read_texture`].
    pub fn read_image(&self, texture: &Texture) -> Result<RgbaImage, TextureError> {
        let texels = rgba::read(self, texture)?;
        let image = RgbaImage::from_raw(texture.width(), texture.height(), texels);
        Ok(image.expect("four bytes for each texel"))
    }
}
