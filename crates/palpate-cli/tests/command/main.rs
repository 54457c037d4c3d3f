//! The command as it is run: its words, files and exit codes.

mod bad_input;
mod batch;
mod calibrate;
mod commands;
mod common;
mod compare;
mod conditions;
mod depends;
mod export;
mod files;
mod grip;
mod inspect;
mod logs;
mod maps;
mod several_tests;
mod shards;
mod sweep;
mod watch;
