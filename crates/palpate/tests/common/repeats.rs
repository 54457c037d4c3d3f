//! How often statistical proofs are repeated.

/// `part` times, which `./test` has time for; `whole` times where `PALPATE_WHOLE` is set, as `validation/long_proofs.sh statistics` does.
pub(crate) fn repeats(part: u64, whole: u64) -> u64 {
    if std::env::var_os("PALPATE_WHOLE").is_some() { whole } else { part }
}
