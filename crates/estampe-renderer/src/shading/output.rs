//! What happens to a lit colour before it is written: in the default light it recedes and keeps
//! headroom; then it is quantised, then fogged.

use super::backdrop::Backdrop;
use super::steps::quantised;
use estampe::{FragmentIn, Real, Vec3};

/// The last step of a surface's shader.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Output {
    /// What the default lights add, if they shine.
    pub presentation: Option<Presentation>,
    /// Number of levels of each channel, in linear light.
    pub levels: Option<u16>,
    pub fog: Option<Fog>,
}

impl Output {
    /// The colour that is written.
    #[inline(always)]
    pub fn color<R: Real>(&self, input: &FragmentIn<'_, R>, color: Vec3<R>) -> Vec3<R> {
        let mut color = color;
        if let Some(presentation) = &self.presentation {
            color = presentation.color(input, color);
        }
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
    pub fn opacity<R: Real>(&self, input: &FragmentIn<'_, R>, opacity: R) -> R {
        match &self.fog {
            Some(fog) => opacity.mix(input.real(1.0), fog.share(input)),
            None => opacity,
        }
    }
}

/// The default light becomes dimmer with the distance, so that parallel faces at different
/// distances differ, which no light of one direction shows; and bright colours keep headroom:
///
/// ```text
///   C = C·(1 − FALLOFF·t)                      t = 0 at the nearest point, 1 at the furthest
///   C = C − over + over·room ÷ (room + over)   over = max(C − SHOULDER, 0), room = 1 − SHOULDER
///
///    1 ┤            ____----     The slope is 1 at the shoulder, and white is never reached.
///      │       _.--´
/// 0.55 ┤    .-´                  Rejected: less light for all, which makes grey models dark.
///      └────┴──────────────
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Presentation {
    /// Distance along the view direction of the model's nearest point.
    pub nearest: f32,
    /// 1 ÷ the distance from there to its furthest point.
    pub per_distance: f32,
    /// Distance per unit of depth and at depth 0 in a parallel projection; in perspective the
    /// distance is w.
    pub orthographic: Option<[f32; 2]>,
}

impl Presentation {
    /// The share of the light that is lost at the model's furthest point.
    const FALLOFF: f32 = 0.38;
    /// The linear channel from which on colours are compressed.
    const SHOULDER: f32 = 0.55;

    /// The colour that is shown.
    #[inline(always)]
    pub fn color<R: Real>(&self, input: &FragmentIn<'_, R>, color: Vec3<R>) -> Vec3<R> {
        let distance = match self.orthographic {
            Some([per_depth, nearest]) => input.position.z * per_depth + nearest,
            None => input.real(1.0) / input.position.w,
        };
        let share = ((distance - self.nearest) * self.per_distance).saturate();
        let light = input.real(1.0) - share * Self::FALLOFF;
        let color = color * light;
        Vec3::new(shown(color.x), shown(color.y), shown(color.z))
    }
}

/// A channel with headroom.
#[inline(always)]
fn shown<R: Real>(channel: R) -> R {
    const ROOM: f32 = 1.0 - Presentation::SHOULDER;
    let over = (channel - Presentation::SHOULDER).max(0.0);
    channel - over + over * ROOM / (over + ROOM)
}

/// Fog that hides what is distant: C = (1 − γ)·C + γ·C_fog, γ = (‖p − eye‖ − start) ÷ (end − start)
/// clamped to 0..=1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fog {
    /// Linear colour.
    pub color: [f32; 3],
    /// The opaque gradient whose colour it has instead.
    pub backdrop: Option<Backdrop>,
    /// Distance up to which there is none.
    pub start: f32,
    /// 1 ÷ (end − start): at `end` there is nothing but fog.
    pub per_distance: f32,
    pub eye_distance: EyeDistance,
}

impl Fog {
    /// The colour behind the fog.
    #[inline(always)]
    pub fn color<R: Real>(&self, input: &FragmentIn<'_, R>, color: Vec3<R>) -> Vec3<R> {
        let share = self.share(input);
        let fog = match &self.backdrop {
            Some(backdrop) => share.out_of_line(
                #[inline(always)]
                || backdrop.color(input).xyz(),
            ),
            None => Vec3::uniform(share, self.color),
        };
        color.mix(fog, share)
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
pub enum EyeDistance {
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
