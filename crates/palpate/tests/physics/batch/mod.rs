//! Many contacts at once against one at a time.

mod accuracy;
