//! How a sample's map stores depth, and what it falls back to where an adapter cannot.

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
    /// A colour map of 8 bits a channel, whose channels are all the same grey: 256 levels.
    Grey8,
    /// A depth texture of 32-bit floats, for comparison samplers.
    Depth32,
}

impl SampleFormat {
    /// What is tried in turn where one cannot be drawn to, the best first.
    const FALLBACKS: [Self; 3] = [Self::R32Float, Self::R16Float, Self::Rgba8Packed];

    /// The format of a name in the samples' options; 32-bit floats for any other name.
    pub(crate) fn of(id: &str) -> Self {
        match id {
            "r16f" => Self::R16Float,
            "rgba8" => Self::Rgba8Packed,
            "grey8" => Self::Grey8,
            _ => Self::R32Float,
        }
    }

    /// Its name for people.
    pub const fn label(self) -> &'static str {
        match self {
            Self::R32Float => "32-bit float",
            Self::R16Float => "16-bit float",
            Self::Rgba8Packed => "8-bit RGBA, packed",
            Self::Grey8 => "8-bit colour",
            Self::Depth32 => "32-bit depth",
        }
    }

    /// The texture that it is stored in.
    pub const fn texture(self) -> wgpu::TextureFormat {
        match self {
            Self::R32Float => wgpu::TextureFormat::R32Float,
            Self::R16Float => wgpu::TextureFormat::R16Float,
            Self::Rgba8Packed | Self::Grey8 => wgpu::TextureFormat::Rgba8Unorm,
            Self::Depth32 => wgpu::TextureFormat::Depth32Float,
        }
    }

    /// Whether it is a depth texture, which casters are drawn into without colours.
    pub const fn is_depth(self) -> bool {
        matches!(self, Self::Depth32)
    }

    /// Whether an adapter can draw to it.
    pub fn is_renderable(self, adapter: &wgpu::Adapter) -> bool {
        let usages = adapter.get_texture_format_features(self.texture()).allowed_usages;
        usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING)
    }

    /// This format, or the first worse one that can be drawn to, and then a line that says so.
    /// `is_renderable` is asked for each. Only float formats have something to fall back to.
    pub fn or_fallback(self, is_renderable: impl Fn(Self) -> bool) -> (Self, Option<String>) {
        let later = Self::FALLBACKS.iter().skip_while(|format| **format != self).copied();
        let found = later.clone().find(|format| is_renderable(*format)).unwrap_or(Self::Rgba8Packed);
        if found == self || later.count() == 0 {
            return (self, None);
        }
        let message =
            format!("This adapter cannot draw to a map of {}: {} takes its place", self.label(), found.label());
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
