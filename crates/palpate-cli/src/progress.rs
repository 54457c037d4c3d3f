//! Progress on anything over a second, on standard error, where it is a terminal.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Work that is shown only once it has lasted a second.
const QUIET: Duration = Duration::from_secs(1);

/// A bar over the bytes of a file.
pub(crate) struct Reading {
    since: Instant,
    name: String,
    bar: Option<ProgressBar>,
}

impl Reading {
    pub(crate) fn new(name: impl Into<String>) -> Self {
        Self {
            since: Instant::now(),
            name: name.into(),
            bar: None,
        }
    }

    pub(crate) fn update(&mut self, done: u64, total: u64) {
        if self.bar.is_none() && self.since.elapsed() > QUIET {
            let bar = ProgressBar::new(total);
            if let Ok(style) = ProgressStyle::with_template("{msg} {bar:30} {bytes}/{total_bytes} {eta}") {
                bar.set_style(style);
            }
            bar.set_message(self.name.clone());
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            bar.set_position(done);
        }
    }
}

impl Drop for Reading {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A bar over things that are counted, which may begin with some of them done.
pub(crate) struct Counting {
    since: Instant,
    bar: ProgressBar,
}

impl Counting {
    pub(crate) fn new(name: &'static str, done: u64, total: u64) -> Self {
        // It counts from the start, so that the time left is right when the bar appears.
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{msg} {bar:30} {human_pos}/{human_len} {eta}") {
            bar.set_style(style);
        }
        bar.set_message(name);
        // What was done before took no time of ours, and the rest is not as quick.
        bar.set_position(done);
        bar.reset_eta();
        Self {
            since: Instant::now(),
            bar,
        }
    }

    pub(crate) fn update(&self, done: u64) {
        if self.bar.is_hidden() && self.since.elapsed() > QUIET {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_position(done);
    }
}

impl Drop for Counting {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A line that says what is being done; it appears after a second and vanishes at the end.
pub(crate) struct Working(ProgressBar);

impl Working {
    pub(crate) fn new(what: impl Into<String>) -> Self {
        let bar = ProgressBar::new_spinner().with_message(what.into());
        bar.enable_steady_tick(QUIET);
        Self(bar)
    }
}

impl Drop for Working {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
