//! The order of the stages: a page to cells, cells to outlines, outlines to a font.
//!
//! | room | what happens there |
//! |---|---|
//! | `project` | the project file is read |
//! | `build` | the whole way, in order, from a project to a font |
//! | `labels`, `corrections` | what the cells are said to hold, and where a user knows better |
//! | `matching`, `reference`, `doubt` | whether cells look like what they are said to hold |
//! | `source`, `batch`, `page`, `printing` | the pictures of a table become pages and their cells |
//! | `letter`, `picture`, `focus` | a cell becomes a letter, a picture closed curves |
//! | `cache`, `record` | what pages became is kept between runs |
//! | `repeats`, `average`, `level`, `alike` | letters are settled beside each other |
//! | `palette`, `by_hand` | what else the font is given: its colours, and what the user sets |
//! | `outputs`, `report`, `budget` | a font becomes files, and what was done is told |
//! | `convert` | the other way in: a font that was read becomes files of another format |
//! | `world`, `watch`, `problem` | files, listeners and what went wrong |

mod alike;
mod average;
mod batch;
mod budget;
mod build;
mod by_hand;
mod cache;
pub mod convert;
mod corrections;
mod doubt;
mod focus;
mod labels;
mod letter;
mod level;
mod matching;
mod outputs;
mod page;
mod palette;
pub mod picture;
mod printing;
mod problem;
pub mod project;
mod record;
pub mod reference;
mod repeats;
mod report;
mod source;
mod watch;
mod world;

pub use budget::Budget;
pub use build::{Built, build, pages, sheet_letters, sheets_without_result};
pub use doubt::Doubt;
pub use letter::Letter;
pub use matching::{Matched, match_letters};
pub use outputs::{Outputs, outputs, proof};
pub use page::Page;
pub use printing::sheets;
pub use problem::{Place, Problem};
pub use project::{Project, ProjectError};
pub use repeats::Repeated;
pub use report::{CellRemark, Composed, PageRow, Remark, Removed, Report, Row};
pub use watch::{Stage, Watch};
pub use world::{Inputs, Nothing, Store, World, digest, digest_of};
