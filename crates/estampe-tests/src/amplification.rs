//! Draws with tessellation and geometry shaders, on the fast path and by the oracle.

use crate::geometry::{Vertex, vertex_buffer, vertex_layout};
use crate::inspection;
use estampe::{
    ColorAttachment, Device, Draw, PixelHistory, RenderPass, RenderPipelineDescriptor, Statistics,
    TessellationState, Texture, TextureDescriptor,
};
use estampe_reference::{ClipVertex, State, Target, TargetState, geometry_shader, tessellation};
use estampe_types::shader::{
    ControlIn, EvaluationIn, GeometryIn, GeometryPrimitive, GeometryProgram, GeometryShader,
    GeometryShaderProgram, GeometryTopology, PatchIn, TessellationLevels,
    TessellationShaderProgram, VertexOut,
};
use estampe_types::state::{
    BlendState, ColorTargetState, PrimitiveState, PrimitiveTopology, TessellationDomain,
    TessellationMode,
};
use estampe_types::{
    Bindings, BufferData, FragmentIn, FragmentOut, IndexFormat, TextureFormat, Vec4, VertexIn,
};
use std::ops::Range;
use std::sync::Arc;

/// Passes its second attribute to the fragments as their colour. The alpha depends on the
/// instance.
#[derive(Debug, Clone, Copy)]
pub struct Passing;

estampe_types::shader! {
    impl Shader for Passing {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = Vec4<R>;

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (mut position, mut values): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Vec4<R>> {
            let moved = input.instance_index.to_real() * 0.125;
            position.x += moved;
            values.z += moved;
            VertexOut::new(position, values)
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, values: Vec4<R>) -> FragmentOut<R> {
            FragmentOut::color(values)
        }
    }
}

/// Divides a patch; the level of an edge is the sum of those of its ends, which are in their
/// values' w.
#[derive(Debug, Clone, Copy)]
pub struct Dividing {
    /// The domain of the pipeline's mode.
    pub domain: TessellationDomain,
    /// The inner levels.
    pub inner: [f32; 2],
    /// How much the surface is bent.
    pub bend: f32,
    /// If set, all vertices have this point size, and a clip distance.
    pub point_size: Option<f32>,
}

estampe_types::shader! {
    impl TessellationShader for Dividing {
        type Input<R: Real> = Vec4<R>;
        type Control<R: Real> = (Vec4<R>, Vec4<R>);
        type Patch<R: Real> = R;
        type Output<R: Real> = Vec4<R>;
        const CONTROL_POINTS: usize = 4;

        fn control<R: Real>(&self, input: ControlIn<'_, R, Vec4<R>>) -> (Vec4<R>, Vec4<R>) {
            // The last point of patches of three is repeated.
            let point = input.points.get(input.index);
            (point.position, point.varyings)
        }

        fn patch<R: Real>(
            &self,
            input: PatchIn<'_, R, (Vec4<R>, Vec4<R>)>,
        ) -> (TessellationLevels<R>, R) {
            let mut level = [input.zero; 4];
            for (corner, level) in level.iter_mut().enumerate() {
                *level = input.points.get(corner).1.w;
            }
            let [a, b, c, d] = level;
            let outer = match self.domain {
                TessellationDomain::Triangles => [b + c, c + a, a + b, a],
                TessellationDomain::Quads => [d + a, a + b, b + c, c + d],
                TessellationDomain::Isolines => [a + b, c + d, a, a],
            };
            let [u, v] = self.inner;
            let inner = [a.splat(u), a.splat(v)];
            let number = input.primitive_index.to_real();
            (TessellationLevels { outer, inner }, number)
        }

        fn evaluate<R: Real>(
            &self,
            input: EvaluationIn<'_, R, (Vec4<R>, Vec4<R>)>,
            number: R,
        ) -> VertexOut<R, Vec4<R>> {
            let at = input.coordinates;
            let (u, v) = (at.x, at.y);
            let weights = match self.domain {
                TessellationDomain::Triangles => [at.x, at.y, at.z, input.zero],
                _ => {
                    let (s, t) = (1.0 - u, 1.0 - v);
                    [s * t, u * t, u * v, s * v]
                }
            };
            let (mut position, mut values) = input.points.get(0);
            position *= weights[0];
            values *= weights[0];
            for (corner, weight) in weights.into_iter().enumerate().skip(1) {
                // Of the last corner by a number that lanes choose.
                let (place, value) = if corner == 3 {
                    input.points.get_at(input.zero.splat_int(3))
                } else {
                    input.points.get(corner)
                };
                position += place * weight;
                values += value * weight;
            }
            position.x += position.y * position.y * self.bend;
            values.x += (number * 0.37).fract() * 0.25;
            values.w = input.zero.splat(0.75);
            let out = VertexOut::new(position, values);
            match self.point_size {
                Some(size) => out
                    .with_point_size(input.zero.splat(size))
                    .with_clip_distance(0, position.x + position.w * 0.5),
                None => out,
            }
        }
    }
}

/// Emits vertices around those of its primitive, in strips whose lengths differ from primitive to
/// primitive. Kinds of primitives are numbers: points, lines, triangles, and two with adjacency;
/// points, line strips and triangle strips.
#[derive(Debug, Clone, Copy)]
pub struct Emitting<const READS: usize, const MAKES: usize, const MAX: usize, const TIMES: usize>;

estampe_types::shader! {
    impl<const READS: usize, const MAKES: usize, const MAX: usize, const TIMES: usize>
        GeometryShader for Emitting<READS, MAKES, MAX, TIMES>
    {
        type Input<R: Real> = Vec4<R>;
        type Output<R: Real> = Vec4<R>;
        const INPUT: GeometryPrimitive = [
            GeometryPrimitive::Points,
            GeometryPrimitive::Lines,
            GeometryPrimitive::Triangles,
            GeometryPrimitive::LinesAdjacency,
            GeometryPrimitive::TrianglesAdjacency,
        ][READS];
        const OUTPUT: GeometryTopology = [
            GeometryTopology::PointList,
            GeometryTopology::LineStrip,
            GeometryTopology::TriangleStrip,
        ][MAKES];
        const MAX_VERTICES: usize = MAX;
        const INVOCATIONS: usize = TIMES;

        fn geometry<R: Real, E: Emit<R, Vec4<R>>>(
            &self,
            input: GeometryIn<'_, R, Vec4<R>>,
            out: &mut E,
        ) {
            let corners = input.points.count();
            let number = input.primitive_index.to_real();
            let length = input.points.get(0).varyings.x.saturate() * MAX as f32 + 2.0;
            // Two more than there may be.
            for vertex in 0..MAX + 2 {
                let point = input.points.get(vertex % corners);
                let along = ((vertex * 7 + input.invocation * 3) % 11) as f32 / 11.0 - 0.5;
                let across = ((vertex * 5 + input.invocation) % 13) as f32 / 13.0 - 0.5;
                let mut position = point.position;
                position.x += position.w * (along * 0.25);
                position.y += position.w * (across * 0.25);
                let mut values = point.varyings;
                values.y += (number * 0.29).fract() * 0.25;
                values.w = input.zero.splat(0.6);
                let lanes = length.gt(vertex as f32);
                out.emit(lanes, VertexOut::new(position, values));
                if vertex % 5 == 4 {
                    out.end_primitive(point.varyings.y.lt(0.5));
                }
            }
        }
    }
}

/// A draw and its target of one RGBA8 attachment.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The topology and the rest of the primitive state.
    pub primitive: PrimitiveState,
    /// The vertices.
    pub vertices: Vec<Vertex>,
    /// The bytes of the index buffer, if there is one.
    pub indices: Option<(IndexFormat, Vec<u8>)>,
    /// The range of vertices or indices.
    pub elements: Range<u32>,
    /// The range of instances.
    pub instances: Range<u32>,
    /// Added to each index.
    pub base_vertex: i32,
    /// Blending.
    pub blend: Option<BlendState>,
    /// Tessellation, with the vertices of a patch.
    pub tessellation: Option<(TessellationMode, u32, Dividing)>,
}

impl Scene {
    /// A draw of all vertices, blended over a transparent target.
    #[must_use]
    pub fn new(size: [u32; 2], topology: PrimitiveTopology, vertices: Vec<Vertex>) -> Self {
        Self {
            size,
            primitive: PrimitiveState {
                topology,
                ..PrimitiveState::default()
            },
            elements: 0..u32::try_from(vertices.len()).expect("few vertices"),
            vertices,
            indices: None,
            instances: 0..1,
            base_vertex: 0,
            blend: Some(BlendState::ALPHA_BLENDING),
            tessellation: None,
        }
    }

    /// The image on a device.
    ///
    /// # Panics
    /// If the API refuses the scene, which is then a fault of the test.
    pub fn draw<G: GeometryShader + Clone>(
        &self,
        device: &Device,
        geometry: Option<&G>,
    ) -> (Vec<u8>, Statistics) {
        self.with_pass(device, geometry, |pass, image| {
            let statistics = device.render(pass).expect("the pass fits");
            (
                device.read_texture(image).expect("it was drawn"),
                statistics,
            )
        })
    }

    /// Compares the history of a pixel with the image: of the last one that differs from the first
    /// pixel, or one in the middle. Returns it.
    ///
    /// # Panics
    /// If the history does not follow from record to record, or ends with another pixel.
    pub fn inspect_one<G: GeometryShader + Clone>(
        &self,
        device: &Device,
        geometry: Option<&G>,
        image: &[u8],
    ) -> PixelHistory {
        let mut pixels = image.chunks(4);
        let first = pixels.next();
        let shown = pixels.rposition(|pixel| Some(pixel) != first);
        let at = shown.map_or(image.len() / 8, |at| at + 1);
        let column_row = [at % self.size[0] as usize, at / self.size[0] as usize];
        let pixel = column_row.map(|at| u32::try_from(at).expect("a small image"));
        let history = self.with_pass(device, geometry, |pass, _| {
            device.inspect(pass, pixel).expect("the pass fits")
        });
        let drawn = image[at * 4..][..4].to_vec();
        inspection::follow(&history).unwrap_or_else(|how| panic!("pixel {pixel:?}: {how}"));
        assert_eq!(history.texels, [Some(drawn)], "pixel {pixel:?}: {self:?}");
        // The target was cleared to zeros.
        let is_covered = !history.primitives.is_empty();
        assert!(is_covered || image[at * 4..][..4] == [0; 4], "{self:?}");
        self.check_origins(&history, geometry.is_some());
        history
    }

    /// Every primitive tells of each stage what it was made of.
    fn check_origins(&self, history: &PixelHistory, has_geometry: bool) {
        for primitive in &history.primitives {
            let origin = primitive.origin.as_ref().expect("it was made");
            assert!(self.instances.contains(&primitive.instance));
            assert_eq!(origin.emitted.is_some(), has_geometry);
            let Some((_, patch_points, _)) = &self.tessellation else {
                assert_eq!(origin.tessellated, None);
                continue;
            };
            assert_eq!(origin.vertices.len(), *patch_points as usize);
            let made = origin.tessellated.as_ref().expect("it was tessellated");
            if !has_geometry {
                // The provoking vertex comes first.
                let mut of_patch: Vec<_> = made.vertices.iter().map(|one| one.clip).collect();
                let drawn: Vec<_> = primitive.vertices.iter().map(|one| one.clip).collect();
                while of_patch != drawn {
                    of_patch.rotate_left(1);
                    assert_ne!(of_patch[0], made.vertices[0].clip, "{primitive:?}");
                }
            }
        }
    }

    /// Gives the pass of the scene, and its image, to `use_pass`.
    fn with_pass<G: GeometryShader + Clone, T>(
        &self,
        device: &Device,
        geometry: Option<&G>,
        use_pass: impl FnOnce(&RenderPass<'_>, &Texture) -> T,
    ) -> T {
        let geometry = geometry.map(|shader| -> Arc<dyn GeometryProgram> {
            Arc::new(GeometryShaderProgram::new(shader.clone()))
        });
        let tessellation =
            self.tessellation
                .map(|(mode, patch_points, shader)| TessellationState {
                    program: Arc::new(TessellationShaderProgram::new(shader)),
                    patch_points,
                    mode,
                });
        let pipeline = device
            .create_render_pipeline(&RenderPipelineDescriptor {
                tessellation,
                geometry,
                vertex_buffers: vec![vertex_layout()],
                primitive: self.primitive,
                depth_stencil: None,
                targets: vec![Some(ColorTargetState {
                    blend: self.blend,
                    ..TextureFormat::Rgba8Unorm.into()
                })],
                ..RenderPipelineDescriptor::new(Passing)
            })
            .expect("the stages fit");
        let image = texture(device, self.size);
        let words = vertex_buffer(&self.vertices).words().to_vec();
        let vertices = device.create_buffer_of_words(words).expect("a buffer");
        let indices = self.indices.as_ref().map(|(format, bytes)| {
            let buffer = device.create_buffer_with_contents(bytes).expect("a buffer");
            (estampe::BufferSlice::from(&buffer), *format)
        });
        let pass = RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
            draws: &[Draw {
                vertex_buffers: &[(&vertices).into()],
                index_buffer: indices.as_ref().map(|(slice, format)| (slice, *format)),
                instances: self.instances.clone(),
                base_vertex: self.base_vertex,
                ..Draw::new(&pipeline, self.elements.clone())
            }],
            ..RenderPass::default()
        };
        use_pass(&pass, &image)
    }

    /// The oracle's image, and the number of primitives.
    #[must_use]
    pub fn draw_by_oracle<G: GeometryShader + Clone>(
        &self,
        geometry: Option<&G>,
    ) -> (Vec<u8>, u64) {
        let [width, height] = self.size;
        let bindings = Bindings::default();
        let buffers = [(vertex_layout(), vertex_buffer(&self.vertices))];
        let indices = self
            .indices
            .as_ref()
            .map(|(format, bytes)| (*format, BufferData::from_bytes(bytes)));
        let draw = estampe_reference::Draw {
            buffers: &buffers,
            indices: indices.as_ref().map(|(format, buffer)| (*format, buffer)),
            vertices: self.elements.clone(),
            instances: self.instances.clone(),
            base_vertex: self.base_vertex,
            bindings: &bindings,
        };
        let mut state = State {
            primitive: self.primitive,
            targets: vec![TargetState {
                blend: self.blend,
                ..TargetState::default()
            }],
            ..State::new(width, height)
        };
        let mut input = match &self.tessellation {
            Some((mode, patch_points, shader)) => {
                let patches = (mode, *patch_points);
                tessellation::tessellate(&Passing, shader, patches, &state, &draw)
            }
            None => geometry_shader::input(&Passing, &state, &draw),
        };
        let mut corners = self
            .tessellation
            .map_or(1, |(mode, ..)| tessellation::corners_of(&mode));
        if let Some(shader) = geometry {
            let provoking = self.primitive.provoking_vertex;
            let emitted = geometry_shader::emit(shader, &input, provoking, &bindings);
            let all = emitted.into_iter().flat_map(|primitive| primitive.vertices);
            let all: Vec<ClipVertex> = all.collect();
            input = (all, Vec::new());
            corners = match G::OUTPUT {
                GeometryTopology::PointList => 1,
                GeometryTopology::LineStrip => 2,
                GeometryTopology::TriangleStrip => 3,
            };
        }
        state.primitive.primitive_restart = false;
        state.primitive.topology = match corners {
            1 => PrimitiveTopology::PointList,
            2 => PrimitiveTopology::LineList,
            _ => PrimitiveTopology::TriangleList,
        };
        let mut target = Target::new(width, height, 1, TextureFormat::Rgba8Unorm);
        target.clear([0.0; 4], 1.0);
        let counts =
            estampe_reference::draw_vertices(&mut target, &Passing, &state, &bindings, &input.0);
        (target.texels(0, 0), counts.primitives)
    }
}

/// A texture to draw into.
fn texture(device: &Device, [width, height]: [u32; 2]) -> Texture {
    let descriptor = TextureDescriptor::new_2d(width, height, TextureFormat::Rgba8Unorm);
    device.create_texture(&descriptor).expect("a small texture")
}
