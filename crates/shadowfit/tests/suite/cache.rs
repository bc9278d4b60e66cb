//! The cache of maps: its plans, carried out on a model and counted.

mod bad_input;
mod fixtures;
mod histories;
mod model;
mod streams;
