//! Readers of models and images.

mod gltf;
mod hostile;
mod images_hostile;
mod images_tga_suite;
mod models_data;
mod models_obj;
mod models_obj_limits;
mod models_obj_materials;
mod models_off;
mod models_ply;
mod models_speed;
mod models_stl;
mod models_utf16;
mod models_written;
mod textures_elsewhere;
mod threemf;
