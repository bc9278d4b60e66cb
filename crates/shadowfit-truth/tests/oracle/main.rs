//! Pictures whose truth and whose errors are known in closed form.

mod classes;
mod scenes;
mod shadows;
