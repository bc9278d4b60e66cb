//! The `with_*` methods of settings.

/// Implements one `with_*` method per field of a settings struct, or of a part of it.
macro_rules! setters {
    ($settings:ident.$part:ident { $($method:ident $field:ident: $value:ty),+ $(,)? }) => {
        impl $settings {
            $(
                #[doc = concat!("Sets `", stringify!($part), ".", stringify!($field), "`.")]
                #[must_use]
                pub const fn $method(mut self, $field: $value) -> Self {
                    self.$part.$field = $field;
                    self
                }
            )+
        }
    };
    ($settings:ident { $($method:ident $field:ident: $value:ty),+ $(,)? }) => {
        impl $settings {
            $(
                #[doc = concat!("Sets [`", stringify!($field), "`](Self::", stringify!($field), ").")]
                #[must_use]
                pub const fn $method(mut self, $field: $value) -> Self {
                    self.$field = $field;
                    self
                }
            )+
        }
    };
}

pub(super) use setters;
