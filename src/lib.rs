//! khatt (Arabic خط: line, handwriting, typeface) turns scanned sheets of drawn Arabic and Latin
//! letters into fonts.
//!
//! ```text
//! bytes ─ scan ─► Cell ─ trace ─► Contour ─ corner ─► Spans ─ fit ─► Fitted ─ refine ─► Fitted
//!                                                                                  │
//! Files ◄─ write ─ Font ◄─ quadratic (TrueType only) ─ Font ◄─ assemble ─ Outline ◄─ finish
//! ```
//!
//! Each arrow is a folder of that name; the nouns are [`types`]; [`pipeline`] alone knows the order.
//! The methods inside `corner`, `fit`, `quadratic`, `code` and `recognise` come from the papers below.
//!
#![doc = include_str!("papers.md")]

pub mod assemble;
pub mod code;
pub mod corner;
pub mod finish;
pub mod fit;
pub mod numeric;
pub mod pipeline;
pub mod quadratic;
pub mod read;
pub mod recognise;
pub mod refine;
pub mod scan;
pub mod template;
pub mod trace;
pub mod types;
pub mod write;
