//! Ctrl-C and the request to terminate: what is not finished is removed, then the process ends as it would have by itself.

#[cfg(unix)]
pub(crate) fn watch() {
    use palpate_jobs::output::abandon;
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    // Without handlers a signal ends the process all the same, and the next run removes what is left.
    let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else {
        return;
    };
    std::thread::spawn(move || {
        for signal in signals.forever() {
            abandon();
            // The shell hears by which signal it ended.
            let _ = emulate_default_handler(signal);
        }
    });
}

#[cfg(not(unix))]
pub(crate) fn watch() {}
