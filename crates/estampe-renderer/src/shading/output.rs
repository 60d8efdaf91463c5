//! What happens to a lit colour before it is written: it is quantised, then fogged.

use super::steps::quantised;
use estampe::{FragmentIn, Real, Vec3};

/// The last step of a surface's shader.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Output {
    /// Number of levels of each channel, in linear light.
    pub(crate) levels: Option<u16>,
    pub(crate) fog: Option<Fog>,
}

impl Output {
    /// The colour that is written.
    #[inline(always)]
    pub(crate) fn color<R: Real>(&self, input: &FragmentIn<'_, R>, color: Vec3<R>) -> Vec3<R> {
        let mut color = color;
        if let Some(levels) = self.levels {
            color = Vec3::new(
                quantised(color.x, levels),
                quantised(color.y, levels),
                quantised(color.z, levels),
            );
        }
        match &self.fog {
            Some(fog) => fog.color(input, color),
            None => color,
        }
    }

    /// The opacity of a surface behind the fog, which is opaque.
    #[inline(always)]
    pub(crate) fn opacity<R: Real>(&self, input: &FragmentIn<'_, R>, opacity: R) -> R {
        match &self.fog {
            Some(fog) => opacity.mix(input.real(1.0), fog.share(input)),
            None => opacity,
        }
    }
}

/// Fog that hides what is distant: C = (1 − γ)·C + γ·C_fog, γ = (‖p − eye‖ − start) ÷ (end − start)
/// clamped to 0..=1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fog {
    /// Linear colour.
    pub(crate) color: [f32; 3],
    /// Distance up to which there is none.
    pub(crate) start: f32,
    /// 1 ÷ (end − start): at `end` there is nothing but fog.
    pub(crate) per_distance: f32,
    pub(crate) eye_distance: EyeDistance,
}

impl Fog {
    /// The colour behind the fog.
    #[inline(always)]
    pub(crate) fn color<R: Real>(&self, input: &FragmentIn<'_, R>, color: Vec3<R>) -> Vec3<R> {
        let share = self.share(input);
        color.mix(Vec3::uniform(share, self.color), share)
    }

    #[inline(always)]
    fn share<R: Real>(&self, input: &FragmentIn<'_, R>) -> R {
        let distance = self.eye_distance.of(input);
        ((distance - self.start) * self.per_distance).saturate()
    }
}

/// The distance of a fragment from the eye, from its position in the window, so that no shader has
/// a varying for it.
///
/// In perspective, (x/w, y/w) and 1/w give the view position w·(a·X + b, c·Y + d, −1). In parallel
/// projection all rays begin at the plane through the eye, and the distance is linear in depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum EyeDistance {
    /// a, b and c, d.
    Perspective {
        /// Slope of the ray per pixel to the right, and at the window's left edge.
        x: [f32; 2],
        /// Slope of the ray per pixel downwards, and at the window's upper edge.
        y: [f32; 2],
    },
    /// Distance per unit of depth, and at depth 0.
    Orthographic([f32; 2]),
}

impl EyeDistance {
    #[inline(always)]
    fn of<R: Real>(&self, input: &FragmentIn<'_, R>) -> R {
        let at = input.position;
        match *self {
            Self::Perspective { x, y } => {
                let ray = Vec3::new(at.x * x[0] + x[1], at.y * y[0] + y[1], input.real(1.0));
                ray.length() / at.w
            }
            Self::Orthographic([per_depth, nearest]) => at.z * per_depth + nearest,
        }
    }
}
