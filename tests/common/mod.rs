//! What several integration tests share.

pub(crate) mod approved;
pub(crate) mod camera;
pub(crate) mod demo;
pub(crate) mod dots;
pub(crate) mod moments;
pub(crate) mod shapes;
