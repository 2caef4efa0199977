//! Span → curves: several published answers to one question.
//!
//! | takes | gives |
//! |---|---|
//! | [`Span`], px, y up; a tolerance, px | [`Fitted`]: lines and cubics, ends exact |
//!
//! A room a method, each a struct of options that implements [`Fitter`]; [`Method`] is the menu.
//! No method reports its own residual as the error: the judge measures all of them alike.

pub mod gc2;
pub mod joint;
pub mod judge;
mod path;
pub mod periodic;
pub mod qbc;
pub mod timmer;
pub mod wls;

use crate::types::{Fitted, Span, Spans};
use kurbo::BezPath;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Why a fitter gives nothing.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FitError {
    /// An option is outside its range.
    #[error("{method}: {option} is {value}; {range}")]
    Option {
        /// key of the method
        method: &'static str,
        /// name of the option
        option: &'static str,
        /// value given
        value: String,
        /// what is allowed
        range: &'static str,
    },
}

impl FitError {
    /// A value that an option of a method must not have, and what is allowed.
    fn option(
        (method, option): (&'static str, &'static str),
        value: impl ToString,
        range: &'static str,
    ) -> Self {
        let value = value.to_string();
        Self::Option {
            method,
            option,
            value,
            range,
        }
    }
}

/// Fits curves through a span.
pub trait Fitter {
    /// Whether the options are in their ranges, as far as they tell without a span.
    ///
    /// # Errors
    /// One is not.
    fn check(&self) -> Result<(), FitError>;

    /// Curves within `tolerance_px` of the span if the method can; else its best, and the verdict says so.
    ///
    /// # Errors
    /// An option is outside its range. Degenerate spans are no error: they give their own polygon.
    fn fit(&self, span: Span<'_>, tolerance_px: f64) -> Result<Fitted, FitError>;

    /// One closed path around a whole contour that was cut at its corners. A method that fits the spans
    /// together may move the corners to where both their sides lead.
    ///
    /// # Errors
    /// As [`Fitter::fit`].
    fn contour(&self, spans: &Spans, tolerance_px: f64) -> Result<BezPath, FitError> {
        path::joined(self, spans, tolerance_px)
    }
}

/// The fitters one can choose, with their options.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "method", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Method {
    /// One global choice of nodes, then one refinement of all of them.
    Joint(joint::Joint),
    /// B-splines by weighted least squares.
    Wls(wls::Wls),
    /// B-splines at the least orthogonal distance.
    Periodic(periodic::Periodic),
    /// Splines with tension through knots inserted by chance.
    Gc2(gc2::Gc2),
    /// Timmer's cubics through knots inserted by chance.
    Timmer(timmer::Timmer),
    /// Quasi-Bézier curves.
    Qbc(qbc::Qbc),
    /// Quasi-Bézier curves with the stronger pull.
    QbcN(qbc::QbcN),
}

impl Default for Method {
    fn default() -> Self {
        Self::Joint(joint::Joint::default())
    }
}

impl Method {
    /// Every method with its default options.
    #[must_use]
    pub fn all() -> Vec<Self> {
        vec![
            Self::Joint(joint::Joint::default()),
            Self::Wls(wls::Wls::default()),
            Self::Periodic(periodic::Periodic::default()),
            Self::Gc2(gc2::Gc2::default()),
            Self::Timmer(timmer::Timmer::default()),
            Self::Qbc(qbc::Qbc::default()),
            Self::QbcN(qbc::QbcN::default()),
        ]
    }

    /// The word for it on the command line, in project files, snapshots and the bibliography.
    #[must_use]
    pub const fn key(&self) -> &'static str {
        match self {
            Self::Joint(_) => "joint",
            Self::Wls(_) => "wls",
            Self::Periodic(_) => "periodic",
            Self::Gc2(_) => "gc2",
            Self::Timmer(_) => "timmer",
            Self::Qbc(_) => "qbc",
            Self::QbcN(_) => "qbc-n",
        }
    }

    /// One line for `khatt methods`.
    #[must_use]
    pub const fn about(&self) -> &'static str {
        match self {
            Self::Joint(_) => "global choice of nodes, joint refinement (default)",
            Self::Wls(_) => {
                "B-spline by weighted least squares, smoothed by weight [samavati98 sec. 4]"
            }
            Self::Periodic(_) => {
                "B-spline at the least orthogonal distance, by BFGS [lumilios93 sec. 4]"
            }
            Self::Gc2(_) => "tension spline through knots by chance [rasheed05 sec. 3.1, 4.3]",
            Self::Timmer(_) => "Timmer cubic through knots by chance [rasheed05 sec. 3.3]",
            Self::Qbc(_) => "quasi-Bézier curves along tangents [sohel sec. III.A, eq. 5]",
            Self::QbcN(_) => "quasi-Bézier curves, stronger pull [sohel sec. III.A, eq. 9]",
        }
    }

    /// The method itself.
    #[must_use]
    pub fn fitter(&self) -> &dyn Fitter {
        match self {
            Self::Joint(f) => f,
            Self::Wls(f) => f,
            Self::Periodic(f) => f,
            Self::Gc2(f) => f,
            Self::Timmer(f) => f,
            Self::Qbc(f) => f,
            Self::QbcN(f) => f,
        }
    }
}
