//! The order of the stages: a page to cells, cells to outlines, outlines to a font.

mod alike;
mod build;
mod by_hand;
mod cache;
pub mod convert;
mod corrections;
mod doubt;
mod labels;
mod letter;
mod letters;
mod outputs;
mod page;
pub mod picture;
mod printing;
mod problem;
pub mod project;
mod record;
pub mod reference;
mod repeats;
mod report;
mod watch;

pub use build::{Built, World, build, pages, sheet_letters, sheets_without_result};
pub use cache::{Nothing, Store};
pub use doubt::Doubt;
pub use letter::Letter;
pub use letters::{Matched, match_letters};
pub use outputs::{Outputs, outputs, proof};
pub use page::Page;
pub use printing::sheets;
pub use problem::{Place, Problem};
pub use project::{Project, ProjectError};
pub use repeats::Repeated;
pub use report::{CellRemark, Composed, PageRow, Remark, Removed, Report, Row};
pub use watch::{Stage, Unwatched, Watch};
