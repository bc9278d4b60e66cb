//! Enums that number what a scene lists, so that a list and the names of its entries cannot disagree.

/// Declares an enum beside what its values stand for: `Name: Type { Value = what it stands for, … }`. `Name::all()` is
/// the list of all, and a value as a `usize` is its index there.
#[macro_export]
macro_rules! numbered {
    ($(#[$doc:meta])* $name:ident: $of:ty { $($value:ident = $meant:expr),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum $name {
            $($value),+
        }

        impl $name {
            /// What the values stand for, in their order.
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
