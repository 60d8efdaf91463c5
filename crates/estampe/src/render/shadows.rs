//! The options of shadows.

use super::appearance_names::ShadingName;
use crate::failure::Failure;
use clap::Args;
use estampe_renderer::{Ground, RenderOptions};

/// Shadows, and the ground.
#[derive(Debug, Clone, Args)]
pub(crate) struct ShadowArgs {
    /// Let lights cast shadows: with --shading pbr, phong and toon
    ///
    /// Without --light the key light casts them, and of an --hdri its brightest side. With --light
    /// the first four lights do, unless they are within the model.
    #[arg(long, help_heading = "Shadows")]
    shadow: bool,

    /// Stand the model on a ground that shows nothing but its soft shadow
    ///
    /// The shadow is what the model hides of the light from all around: that of --hdri, else the
    /// studio's. On a background of none it is black with an alpha, for pictures that are laid over
    /// others.
    #[arg(long, help_heading = "Shadows")]
    ground: bool,
}

impl ShadowArgs {
    /// Refuses shadows on shadings without light at every pixel.
    pub(super) fn check(&self, shading: ShadingName) -> Result<(), Failure> {
        let is_lit = matches!(
            shading,
            ShadingName::Auto | ShadingName::Pbr | ShadingName::Phong | ShadingName::Toon
        );
        if self.shadow && !is_lit {
            return Err(Failure::Usage(
                "--shadow needs light at every pixel: choose --shading pbr, phong or toon, or omit \
                 --shadow"
                    .to_owned(),
            ));
        }
        Ok(())
    }

    /// The renderer's options with these.
    pub(super) fn apply(&self, options: RenderOptions) -> RenderOptions {
        RenderOptions {
            shadows: self.shadow,
            ground: if self.ground {
                Ground::Shadow
            } else {
                Ground::None
            },
            ..options
        }
    }
}
