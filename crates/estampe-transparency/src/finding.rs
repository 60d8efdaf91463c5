//! The pass that finds a layer: the shader and the pipeline of depths alone.

use crate::{DepthOrder, TransparencyError};
use estampe::state::{
    CompareFunction, MultisampleState, PrimitiveState, StencilFaceState, StencilOperation,
    StencilState, VertexBufferLayout,
};
use estampe::{
    BindGroup, BindGroupDescriptor, BindGroupLayout, BindGroupLayoutEntry, BindingResource,
    BindingType, Device, FragmentIn, FragmentOut, Mat4, RenderPipeline, RenderPipelineDescriptor,
    SampleType, Texture, TextureBindings, Vec3, VertexIn, VertexOut, ViewDimension,
};

/// The stencil value of samples in which a layer has a fragment.
pub(crate) const FOUND: u8 = 1;

/// Makes the pipelines that find layers, for [`PeelDraws::finding`](crate::PeelDraws).
#[derive(Debug, Clone)]
pub struct Finder {
    order: DepthOrder,
    samples: u32,
    layout: BindGroupLayout,
}

/// Fragments that are nearer than the depth in binding 0.
struct Nearer {
    clip_from_position: Mat4,
    order: DepthOrder,
    is_multisampled: bool,
}

estampe::shader! {
    impl Shader for Nearer {
        type Attributes<R: Real> = (Vec3<R>,); // position
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position,): (Vec3<R>,),
        ) -> VertexOut<R, ()> {
            VertexOut::new(self.clip_from_position.transform_point(position), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let [x, y] = [input.position.x.to_int(), input.position.y.to_int()];
            let zero = x.splat(0);
            // Per sample the position's depth is that of the sample, as its test has it.
            let sample = if self.is_multisampled { input.sample_index } else { zero };
            let behind = input.bindings.texture(0, 0).fetch([x, y, zero], zero, sample).x;
            // Clamped as the depths that are stored: rounding may leave 0..=1.
            let depth = input.position.z.max(0.0).min(input.real(1.0));
            FragmentOut::none().discard_unless(self.order.is_nearer(depth, behind))
        }
    }
}

impl Finder {
    /// The maker of pipelines for targets with this order of depths and this many samples.
    ///
    /// # Errors
    /// [`TransparencyError`] if the device's limits exclude a texture in a shader.
    pub fn new(
        device: &Device,
        order: DepthOrder,
        samples: u32,
    ) -> Result<Self, TransparencyError> {
        let layout = device.create_bind_group_layout(&[BindGroupLayoutEntry {
            binding: 0,
            ty: BindingType::Texture {
                sample_type: SampleType::Depth,
                view_dimension: ViewDimension::D2,
                multisampled: samples > 1,
            },
        }])?;
        Ok(Self {
            order,
            samples,
            layout,
        })
    }

    /// The pipeline that finds layers of draws whose location 0 is a position of three floats. It
    /// has the vertex buffers of the blending pipeline, of which it reads location 0 alone.
    ///
    /// The blending pipeline must have the same primitive state, and must compute its clip position
    /// from the same vertices as `clip_from_position.transform_point(position)`.
    ///
    /// # Errors
    /// [`TransparencyError`] if the vertex buffers or the primitive state are not valid.
    pub fn pipeline(
        &self,
        device: &Device,
        clip_from_position: Mat4,
        mut vertex_buffers: Vec<VertexBufferLayout>,
        primitive: PrimitiveState,
    ) -> Result<RenderPipeline, TransparencyError> {
        for buffer in &mut vertex_buffers {
            buffer
                .attributes
                .retain(|attribute| attribute.shader_location == 0);
        }
        let shader = Nearer {
            clip_from_position,
            order: self.order,
            is_multisampled: self.samples > 1,
        };
        let stencil = StencilFaceState {
            pass_op: StencilOperation::Replace,
            compare: CompareFunction::Always,
            ..StencilFaceState::default()
        };
        let depth_stencil = estampe::state::DepthStencilState {
            stencil: Some(StencilState::from(stencil)),
            ..self.order.farthest().into()
        };
        Ok(device.create_render_pipeline(&RenderPipelineDescriptor {
            bind_group_layouts: vec![self.layout.clone()],
            vertex_buffers,
            primitive,
            depth_stencil: Some(depth_stencil),
            multisample: MultisampleState::new(self.samples),
            targets: Vec::new(),
            ..RenderPipelineDescriptor::new(shader)
        })?)
    }

    /// Binds the depths of the layer before.
    pub(crate) fn bind(
        &self,
        device: &Device,
        behind: &Texture,
    ) -> Result<BindGroup, TransparencyError> {
        Ok(device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &self.layout,
            entries: &[(0, BindingResource::Texture(behind.view()))],
        })?)
    }
}
