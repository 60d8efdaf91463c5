//! Where the light is computed, and what is interpolated: the light of the vertices (Gouraud
//! 1971), that of the face (flat), or the normal (Phong 1975).

use super::bump::BumpMap;
use super::lighting::{Illumination, SurfacePoint};
use super::shadow::Visibilities;
use super::terms::Reflectance;
use super::{VertexTransforms, shading_normal};
use estampe::{Attributes, FragmentIn, Real, Varyings, Vec2, Vec3};

/// Where the light is computed: a part of a [`Surface`](super::surface::Surface).
pub trait Interpolation: Send + Sync + 'static {
    /// What a vertex has beside its position.
    type Attributes<R: Real>: Attributes<R>;
    /// What is interpolated.
    type Varyings<R: Real>: Varyings<R>;

    /// The transforms of vertices.
    fn transforms(&self) -> &VertexTransforms;

    /// The varyings of a vertex, given its position in unit space.
    fn vertex<R: Real>(
        &self,
        position: Vec3<R>,
        attributes: Self::Attributes<R>,
    ) -> Self::Varyings<R>;

    /// The lit colour of a fragment. Bump maps have an effect where normals are interpolated.
    fn fragment<R: Real>(
        &self,
        base: Vec3<R>,
        bump: Option<(&BumpMap, Vec2<R>)>,
        varyings: Self::Varyings<R>,
        input: &FragmentIn<'_, R>,
    ) -> Vec3<R>;
}

/// Light at every fragment, with the interpolated normal.
#[derive(Debug, Clone)]
pub struct AtFragments {
    pub transforms: VertexTransforms,
    pub reflectance: Reflectance,
}

impl Interpolation for AtFragments {
    type Attributes<R: Real> = Vec3<R>; // normal
    type Varyings<R: Real> = (Vec3<R>, Vec3<R>); // view position, normal

    fn transforms(&self) -> &VertexTransforms {
        &self.transforms
    }

    #[inline(always)]
    fn vertex<R: Real>(&self, position: Vec3<R>, normal: Vec3<R>) -> (Vec3<R>, Vec3<R>) {
        (
            self.transforms.view(position),
            self.transforms.normal(normal),
        )
    }

    #[inline(always)]
    fn fragment<R: Real>(
        &self,
        base: Vec3<R>,
        bump: Option<(&BumpMap, Vec2<R>)>,
        (view, normal): (Vec3<R>, Vec3<R>),
        input: &FragmentIn<'_, R>,
    ) -> Vec3<R> {
        let to_eye = self.transforms.eye_direction(view);
        let mut normal = shading_normal(normal, to_eye, input.front_facing);
        let maps = &self.reflectance.lights.shadow_maps;
        let visibilities = Visibilities::at(maps, input, view, normal);
        if let Some((map, uv)) = bump {
            normal = input.zero.out_of_line(
                #[inline(always)]
                || map.perturb(normal, view, uv, input.front_facing),
            );
        }
        let point = SurfacePoint {
            position: view,
            normal,
            to_eye,
            visibilities,
        };
        self.reflectance.color(base, self.reflectance.light(point))
    }
}

/// Light at the vertices. The facing of a triangle is known only after vertex shading, so light is
/// computed for both sides, and the fragment selects one.
#[derive(Debug, Clone)]
pub struct AtVertices {
    pub transforms: VertexTransforms,
    pub reflectance: Reflectance,
    pub viewer: Viewer,
}

/// From where light at the vertices is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Viewer {
    /// From the eye.
    Eye,
    /// From infinitely far away, so that all vertices of a face have the same light, and in
    /// directional light all faces of a plane.
    Infinity,
}

/// Light on both sides: diffuse and added light of the front, then of the back.
type BothSides<R> = (Vec3<R>, Vec3<R>, Vec3<R>, Vec3<R>);

impl Interpolation for AtVertices {
    /// Normal, and the point in unit space at which the light is computed: the vertex, or the
    /// middle of its face.
    type Attributes<R: Real> = (Vec3<R>, Vec3<R>);
    type Varyings<R: Real> = BothSides<R>;

    fn transforms(&self) -> &VertexTransforms {
        &self.transforms
    }

    #[inline(always)]
    fn vertex<R: Real>(
        &self,
        _position: Vec3<R>,
        (normal, lit_at): (Vec3<R>, Vec3<R>),
    ) -> BothSides<R> {
        let position = self.transforms.view(lit_at);
        let to_eye = match self.viewer {
            Viewer::Eye => self.transforms.eye_direction(position),
            Viewer::Infinity => Vec3::uniform(position.x, [0.0, 0.0, 1.0]),
        };
        let yes = to_eye.x.splat_mask(true);
        let normal = shading_normal(self.transforms.normal(normal), to_eye, yes);
        let point = SurfacePoint {
            position,
            normal,
            to_eye,
            // Shadows have edges between vertices.
            visibilities: Visibilities::all(position.x.splat(1.0)),
        };
        let light = |normal: Vec3<R>| {
            normal.x.out_of_line(
                #[inline(always)]
                || self.reflectance.light(SurfacePoint { normal, ..point }),
            )
        };
        let (front, back) = (light(normal), light(-normal));
        (front.diffuse, front.added, back.diffuse, back.added)
    }

    #[inline(always)]
    fn fragment<R: Real>(
        &self,
        base: Vec3<R>,
        _bump: Option<(&BumpMap, Vec2<R>)>,
        (front, front_added, back, back_added): BothSides<R>,
        input: &FragmentIn<'_, R>,
    ) -> Vec3<R> {
        let front_facing = input.front_facing;
        let light = Illumination {
            diffuse: Vec3::select(front_facing, front, back),
            added: Vec3::select(front_facing, front_added, back_added),
        };
        self.reflectance.color(base, light)
    }
}
