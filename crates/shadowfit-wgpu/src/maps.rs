//! Shadow maps on the GPU: textures, uniforms, bind groups, passes, and separate layers for static casters.

pub(crate) mod cached_maps;
pub(crate) mod shadow_map;
pub(crate) mod static_layers;
pub(crate) mod texture;
pub(crate) mod uniform;
pub(crate) mod view;

pub use cached_maps::{DrawRegion, ShadowPass};
pub use shadow_map::ShadowMap;
pub use texture::MapTexture;
pub use uniform::{CasterUniform, FadingUniform, MapUniform, ReceiverUniform};
pub use view::MapView;
