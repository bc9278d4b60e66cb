//! Enums that number the entries of a scene's lists, so that a list and the names of its entries cannot
//! disagree.

/// Declares an enum with a value for each entry of a list: `Name: Type { Variant = value, … }`. `Name::all()`
/// returns the list of values. A variant as a `usize` is its index there.
#[macro_export]
macro_rules! numbered {
    ($(#[$doc:meta])* $name:ident: $of:ty { $($value:ident = $meant:expr),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum $name {
            $($value),+
        }

        impl $name {
            /// Returns the values of all variants, in their order.
            pub(crate) fn all() -> Vec<$of> {
                vec![$($meant),+]
            }
        }

        impl From<$name> for usize {
            fn from(value: $name) -> Self {
                value as Self
            }
        }
    };
}

pub use numbered;
