//! A drawn figure as the renderers understand it, with the typeface of all figures.

use std::sync::{Arc, LazyLock};

use resvg::usvg::{self, Options, Tree, fontdb};

/// The typeface, carried along so that pictures look alike on every machine.
static FONTS: LazyLock<Arc<fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(include_bytes!("../../../fonts/Arimo-Regular-subset.ttf").to_vec());
    fonts.load_font_data(include_bytes!("../../../fonts/Arimo-Bold-subset.ttf").to_vec());
    fonts.set_sans_serif_family("Arimo");
    fonts.set_serif_family("Arimo");
    Arc::new(fonts)
});

/// What a drawn figure shows.
pub(crate) fn tree(svg: &str) -> Result<Tree, usvg::Error> {
    let options = Options {
        fontdb: Arc::clone(&FONTS),
        ..Options::default()
    };
    Tree::from_str(svg, &options)
}
