//! Frames of several passes and dispatches, with images between them, in WGSL alone.
//!
//! A scene of this kind is a [`Scene`](super::Scene) whose `frame` is a [`Frame`]: a WGSL module,
//! images, pipelines, and the steps of a frame in order. Numbers in it are indices into the scene's
//! buffers and textures and into the frame's images and pipelines; image [`PICTURE`] is what the
//! frame shows. `PreparedFrame` makes the objects of the device once, and records and submits all
//! steps each frame.
//!
//! ```text
//! let mut frame = Frame::new(size, TextureFormat::Bgra8Unorm, include_str!("../wgsl/name.wgsl"));
//! let half = frame.image(TextureFormat::Rgba16Float, [w / 2, h / 2]);
//! let draw = frame.pipeline(FramePipeline { vertex: "…", fragment: "…", bindings: …, .. });
//! frame.steps.push(Step::Pass(Pass { … }));        // any number of attachments and draws
//! frame.steps.push(Step::Dispatch(ComputeStep { entry_point: "…", bindings: …, workgroups: … }));
//! frame.screen_pass(combine, PICTURE);              // a full-screen triangle
//! Scene::of_frame("name", buffers, textures, frame)
//! ```

mod description;
mod objects;
mod prepared;

pub use description::{
    Binding, ColorTarget, ComputeStep, Frame, FrameDraw, FrameImage, FramePipeline, PICTURE, Pass,
    Step,
};
pub(crate) use prepared::PreparedFrame;
