//! The measures of fits: numbers published for other code's fits are found again, and `report peers` as a program.

#[path = "../examples/shared/geometry.rs"]
mod geometry;
mod numbers;
mod report;
