//! The command as it is run: its words, files and exit codes.

mod bad_input;
mod batch;
mod calibrate;
mod commands;
mod common;
mod compare;
mod depends;
mod grip;
mod inspect;
mod several_tests;
mod sweep;
mod watch;
