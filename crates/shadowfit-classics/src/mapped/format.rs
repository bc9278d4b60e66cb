//! Depth formats of a sample's map, and fallbacks for adapters without them.

/// Format of a sample's map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum SampleFormat {
    /// One channel of a 32-bit float.
    #[default]
    R32Float,
    /// One channel of a 16-bit float.
    R16Float,
    /// Four channels of 8 bits that hold the bits of a 32-bit float.
    Rgba8Packed,
    /// A colour map of 8 bits per channel. All channels hold the same grey, with 256 levels.
    Grey8,
    /// A depth texture of 32-bit floats, for comparison samplers.
    Depth32,
}

impl SampleFormat {
    /// Fallback formats, best first.
    const FALLBACKS: [Self; 3] = [Self::R32Float, Self::R16Float, Self::Rgba8Packed];

    /// Returns the format with a name in the samples' options, or 32-bit floats for any other name.
    pub(crate) fn of(id: &str) -> Self {
        match id {
            "r16f" => Self::R16Float,
            "rgba8" => Self::Rgba8Packed,
            "grey8" => Self::Grey8,
            _ => Self::R32Float,
        }
    }

    /// Returns the name for people.
    pub const fn label(self) -> &'static str {
        match self {
            Self::R32Float => "32-bit float",
            Self::R16Float => "16-bit float",
            Self::Rgba8Packed => "8-bit RGBA, packed",
            Self::Grey8 => "8-bit colour",
            Self::Depth32 => "32-bit depth",
        }
    }

    /// Returns the texture format that stores it.
    pub const fn texture(self) -> wgpu::TextureFormat {
        match self {
            Self::R32Float => wgpu::TextureFormat::R32Float,
            Self::R16Float => wgpu::TextureFormat::R16Float,
            Self::Rgba8Packed | Self::Grey8 => wgpu::TextureFormat::Rgba8Unorm,
            Self::Depth32 => wgpu::TextureFormat::Depth32Float,
        }
    }

    /// Returns whether it is a depth texture. Casters are drawn into depth textures without colours.
    pub const fn is_depth(self) -> bool {
        matches!(self, Self::Depth32)
    }

    /// Returns whether an adapter can draw to it.
    pub fn is_renderable(self, adapter: &wgpu::Adapter) -> bool {
        let usages = adapter.get_texture_format_features(self.texture()).allowed_usages;
        usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING)
    }

    /// Returns this format, or else the next worse format for which `is_renderable` returns true, with a
    /// message about it. Only float formats have fallbacks.
    pub fn or_fallback(self, is_renderable: impl Fn(Self) -> bool) -> (Self, Option<String>) {
        let later = Self::FALLBACKS.iter().skip_while(|format| **format != self).copied();
        let found = later.clone().find(|format| is_renderable(*format)).unwrap_or(Self::Rgba8Packed);
        if found == self || later.count() == 0 {
            return (self, None);
        }
        let message =
            format!("This adapter cannot draw to a map of {}: {} is used instead", self.label(), found.label());
        (found, Some(message))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_format_that_cannot_be_drawn_to_gives_way_to_the_next_one_with_a_message() {
        let (format, message) = SampleFormat::R32Float.or_fallback(|_| true);
        assert_eq!((format, message), (SampleFormat::R32Float, None));
        let (format, message) = SampleFormat::R32Float.or_fallback(|format| format != SampleFormat::R32Float);
        assert_eq!(format, SampleFormat::R16Float);
        let message = message.expect("a person is told");
        assert!(message.contains("32-bit float") && message.contains("16-bit float"), "{message}");
        let (format, _) = SampleFormat::R32Float.or_fallback(|format| format == SampleFormat::Rgba8Packed);
        assert_eq!(format, SampleFormat::Rgba8Packed);
        let (format, message) = SampleFormat::R16Float.or_fallback(|format| format == SampleFormat::R32Float);
        assert_eq!(format, SampleFormat::Rgba8Packed, "nothing falls back to a better format");
        assert!(message.is_some());
        assert_eq!(SampleFormat::Grey8.or_fallback(|_| false), (SampleFormat::Grey8, None));
    }
}
