//! What several integration tests share.

pub(crate) mod approved;
pub(crate) mod camera;
pub(crate) mod demo;
pub(crate) mod desk;
pub(crate) mod dots;
pub(crate) mod menu;
pub(crate) mod moments;
pub(crate) mod pictures;
pub(crate) mod read;
pub(crate) mod shapes;
