//! Options that messages name between `⟨` and `⟩`, spelled as those who read them write options.

/// A text with its options as `spell` writes a name and perhaps its value: of `⟨equilibrium=hertz⟩` these are `equilibrium` and `hertz`. The
/// option of another job than the one at hand has that in front: `⟨compare/creep⟩`.
#[must_use]
pub fn spelled(text: &str, spell: &dyn Fn(&str, Option<&str>) -> String) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, (option, after))) =
        rest.split_once('⟨').and_then(|(before, behind)| Some((before, behind.split_once('⟩')?)))
    {
        let (name, value) = option.split_once('=').map_or((option, None), |(name, value)| (name, Some(value)));
        out.push_str(before);
        out.push_str(&spell(name, value));
        rest = after;
    }
    out + rest
}

/// An option as the command takes it: `--poisson-ratio`, `--equilibrium hertz`, `palpate compare --creep`.
#[must_use]
pub fn flag(name: &str, value: Option<&str>) -> String {
    let (job, name) =
        name.rsplit_once('/').map_or((String::new(), name), |(job, name)| (format!("palpate {job} "), name));
    let value = value.map_or(String::new(), |value| format!(" {value}"));
    format!("{job}--{}{value}", name.replace('_', "-"))
}

/// A text with its options as the command takes them, as documents and reports name them.
#[must_use]
pub fn with_flags(text: &str) -> String {
    spelled(text, &flag)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_spelled_as_a_front_end_writes_them() {
        assert_eq!(with_flags("⟨poisson_ratio⟩ is for Hertz's law"), "--poisson-ratio is for Hertz's law");
        assert_eq!(with_flags("add ⟨equilibrium=hertz⟩"), "add --equilibrium hertz");
        assert_eq!(with_flags("(⟨compare/creep⟩), or"), "(palpate compare --creep), or");
        assert_eq!(with_flags("`⟨compare/loss=huber⟩` makes"), "`palpate compare --loss huber` makes");
        assert_eq!(with_flags("a ⟨ that is none"), "a ⟨ that is none");
        assert_eq!(spelled("by ⟨loss=huber⟩", &|name, _| name.to_owned()), "by loss");
    }
}
