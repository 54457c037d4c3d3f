//! Files of every format, their descriptions, and the records that both make.

mod afm;
mod arrow_file;
mod contents;
mod description;
mod epoch;
mod record_file;
mod robot_log;
mod spreadsheet;
mod text;
