//! `estampe render`: renders a model to an image.
//!
//! ```text
//! arguments -> input (read, parse) -> renderer (prepare, geometry, raster, read back)
//!           -> encode -> output (complete or not at all), report
//!           or passes (data of the same camera, several files)
//!           or cameras (a picture or passes for each camera of a file)
//! ```

mod appearance_names;
mod arguments;
mod camera_check;
mod cameras;
mod command;
mod draw;
mod illumination;
mod illumination_values;
mod overlays;
mod passes;
mod pbr;
mod picture;
mod report;
mod section;
mod shadows;
mod surface_shader;
mod surfaces;
mod texture_detail;
mod watch;

pub(crate) use arguments::RenderArgs;
pub(crate) use cameras::{
    CamerasArgs, NamedCamera, read as read_cameras, schema as schema_of_cameras,
};
pub(crate) use command::run;
pub(crate) use draw::{STAGES, check_output, device, draw, drawn_bytes, encoded, frame};
pub(crate) use draw::{frame_options, image_format, prepare};
pub(crate) use passes::{Files, PassArgs, PassFile, PassFormat, PassName, Sources};
pub(crate) use picture::{PictureArgs, ReportArgs};
pub(crate) use report::write as write_report;
pub(crate) use report::{
    Report, counts, output_name, output_path, rounded_milliseconds, write_json,
};
pub(crate) use texture_detail::PictureDetail;
