//! The cache of maps: its plans, executed on a model and measured.

mod bad_input;
mod fixtures;
mod histories;
mod model;
mod streams;
