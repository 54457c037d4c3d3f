//! Style and script of a page, and the policy that forbids everything else.

use std::sync::LazyLock;

use base64::Engine as _;
use sha2::{Digest, Sha256};

/// The style of a page.
pub const STYLE: &str = include_str!("style.css");
/// Its script: readings, zooms and switches of figures, sorting of tables.
pub const SCRIPT: &str = include_str!("script.js");

/// The content security policy: this style, this script and pictures inside the page; no network, no frame, no form, no other script.
pub(super) static POLICY: LazyLock<String> = LazyLock::new(|| {
    format!(
        "default-src 'none'; style-src '{}'; script-src '{}'; img-src data:; base-uri 'none'; form-action 'none'",
        digest(STYLE),
        digest(SCRIPT)
    )
});

/// The digest by which a policy allows what stands between two tags.
fn digest(content: &str) -> String {
    format!("sha256-{}", base64::engine::general_purpose::STANDARD.encode(Sha256::digest(content)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_policy_names_style_and_script() {
        // echo -n "" | openssl dgst -sha256 -binary | base64
        assert_eq!(digest(""), "sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU=");
        assert!(POLICY.starts_with("default-src 'none'; ") && POLICY.matches("'sha256-").count() == 2);
        // What would end the element, or be read as another text than the one with this digest.
        for content in [STYLE, SCRIPT] {
            assert!(!content.contains("</") && !content.contains('\r') && !content.contains("<!--"));
        }
    }
}
