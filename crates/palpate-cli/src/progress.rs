//! Progress on anything over a second, on standard error, where it is a terminal.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use palpate::watch::{Cancelled, Progress, Watch};

use crate::terminal::clean;

/// Work that is shown only once it has lasted a second.
const QUIET: Duration = Duration::from_secs(1);

/// A bar over what is counted, or a line that says what is being done; both vanish at the end. Nothing is ever cancelled: Ctrl-C ends the
/// process.
#[derive(Default)]
pub(crate) struct Bars {
    now: Option<(String, Instant, ProgressBar)>,
}

impl Bars {
    fn begin(&mut self, progress: Progress<'_>) {
        self.clear();
        let bar = match progress.total {
            None => ProgressBar::new_spinner(),
            Some(total) => {
                // It counts from the start, so that the time left is right when the bar appears.
                let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
                if let Ok(style) = ProgressStyle::with_template("{msg} {bar:30} {human_pos}/{human_len} {eta}") {
                    bar.set_style(style);
                }
                bar.set_position(progress.done);
                // What was done before took no time of ours, and the rest is not as quick.
                bar.reset_eta();
                bar
            }
        };
        bar.set_message(clean(progress.task).into_owned());
        if progress.total.is_none() {
            bar.enable_steady_tick(QUIET);
        }
        self.now = Some((progress.task.to_owned(), Instant::now(), bar));
    }

    fn clear(&mut self) {
        if let Some((_, _, bar)) = self.now.take() {
            bar.finish_and_clear();
        }
    }
}

impl Watch for Bars {
    fn report(&mut self, progress: Progress<'_>) -> Result<(), Cancelled> {
        if progress.total.is_some_and(|total| progress.done >= total) {
            self.clear();
            return Ok(());
        }
        if self.now.as_ref().is_none_or(|(task, _, _)| task != progress.task) {
            self.begin(progress);
        }
        if let (Some((_, since, bar)), Some(_)) = (&self.now, progress.total) {
            if bar.is_hidden() && since.elapsed() > QUIET {
                bar.set_draw_target(ProgressDrawTarget::stderr());
            }
            bar.set_position(progress.done);
        }
        Ok(())
    }
}

impl Drop for Bars {
    fn drop(&mut self) {
        self.clear();
    }
}
