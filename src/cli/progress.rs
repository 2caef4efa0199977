//! How far a run is, on a terminal; how long its stages took.

use super::Common;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use khatt::pipeline::{Stage, Watch};
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Work that is done sooner shows no bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// Time that each stage took, summed over threads.
pub(crate) type Times = BTreeMap<Stage, Duration>;

/// Watches a run.
#[derive(Debug)]
pub(crate) struct Progress {
    start: Instant,
    times: Arc<Mutex<Times>>,
    bar: ProgressBar,
    /// No bar is shown so far, and one may be.
    waiting: AtomicBool,
}

impl Progress {
    pub(crate) fn new(common: &Common) -> Self {
        let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} cells");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        Self {
            start: now(),
            times: Arc::default(),
            bar: ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::hidden())
                .with_style(style),
            waiting: AtomicBool::new(!common.quiet),
        }
    }

    /// Takes the bar away; gives the time so far and that of each stage.
    pub(crate) fn finish(&self) -> (Duration, Times) {
        self.bar.finish_and_clear();
        let times = self.times.lock().unwrap_or_else(PoisonError::into_inner);
        (self.start.elapsed(), times.clone())
    }

    /// The bar hides itself where there is no terminal.
    fn show(&self) {
        if self.start.elapsed() > PATIENCE && self.waiting.swap(false, Ordering::Relaxed) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }
}

#[expect(
    clippy::disallowed_methods,
    reason = "times are shown, and reach no result"
)]
fn now() -> Instant {
    Instant::now()
}

/// Adds its own lifetime to a stage's time.
#[derive(Debug)]
struct Timer {
    stage: Stage,
    start: Instant,
    times: Arc<Mutex<Times>>,
}

impl Drop for Timer {
    fn drop(&mut self) {
        let mut times = self.times.lock().unwrap_or_else(PoisonError::into_inner);
        *times.entry(self.stage).or_default() += self.start.elapsed();
    }
}

impl Watch for Progress {
    fn enter(&self, stage: Stage) -> Box<dyn Any> {
        self.show();
        Box::new(Timer {
            stage,
            start: now(),
            times: Arc::clone(&self.times),
        })
    }

    fn expect(&self, cells: usize) {
        self.bar
            .inc_length(u64::try_from(cells).unwrap_or(u64::MAX));
    }

    fn done(&self) {
        self.show();
        self.bar.inc(1);
    }
}
