//! PDF from a drawn figure: lines as lines, text as text, and the typeface that it needs embedded.
//!
//! The drawing comes in as its SVG, so that both show the same; what no figure of ours draws (gradients, masks) is refused.
//!
//! | file | what |
//! |---|---|
//! | `font.rs` | subsets of the typeface, and what its glyphs are called |
//! | `page.rs` | the drawing as marks on a page |

mod font;
mod page;

use std::io::Write as _;

use flate2::{Compression, write::ZlibEncoder};
use page::Page;
use pdf_writer::{Filter, Finish as _, Name, Pdf, Rect, Ref, TextStr};

use super::tree::tree;
use crate::figure::content::FigureError;

/// Points per CSS pixel.
const POINT: f32 = 0.75;

/// PDF bytes of an SVG document; the same document always gives the same.
pub(crate) fn pdf(name: &str, svg: &str) -> Result<Vec<u8>, FigureError> {
    write(name, svg).map_err(|reason| FigureError::Pdf {
        figure: name.to_owned(),
        reason,
    })
}

fn write(name: &str, svg: &str) -> Result<Vec<u8>, String> {
    let tree = tree(svg).map_err(|error| error.to_string())?;
    let (width, height) = (POINT * tree.size().width(), POINT * tree.size().height());
    let mut page = Page::new([POINT, 0.0, 0.0, -POINT, 0.0, height]);
    page.group(tree.root())?;

    let mut pdf = Pdf::new();
    let mut next = Ref::new(1);
    let [catalog, pages, sheet, content, info] = [(); 5].map(|()| next.bump());
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([sheet]).count(1);
    pdf.document_info(info).title(TextStr(name)).producer(TextStr("palpate"));
    let Page {
        marks,
        fonts,
        images,
        alphas,
        ..
    } = page;
    let fonts = fonts.embed(&mut pdf, &mut next, tree.fontdb())?;
    let mut drawn = pdf.page(sheet);
    drawn.media_box(Rect::new(0.0, 0.0, width, height)).parent(pages).contents(content);
    let (image_refs, alpha_refs): (Vec<Ref>, Vec<Ref>) =
        (images.iter().map(|_| next.bump()).collect(), alphas.iter().map(|_| next.bump()).collect());
    let mut resources = drawn.resources();
    for (group, kind) in [(&fonts, 'F'), (&image_refs, 'I'), (&alpha_refs, 'A')] {
        if group.is_empty() {
            continue;
        }
        let mut named = match kind {
            'F' => resources.fonts(),
            'I' => resources.x_objects(),
            _ => resources.ext_g_states(),
        };
        for (index, reference) in group.iter().enumerate() {
            named.pair(Name(format!("{kind}{index}").as_bytes()), *reference);
        }
    }
    resources.finish();
    drawn.finish();
    pdf.stream(content, &packed(&marks.finish())).filter(Filter::FlateDecode);
    for (image, reference) in images.iter().zip(image_refs) {
        let pixels = packed(&image.rgb);
        let mut written = pdf.image_xobject(reference, &pixels);
        written.filter(Filter::FlateDecode);
        written.width(image.width).height(image.height).bits_per_component(8);
        written.color_space().device_rgb();
    }
    for ([fill, stroke], reference) in alphas.into_iter().zip(alpha_refs) {
        pdf.ext_graphics(reference).non_stroking_alpha(fill).stroking_alpha(stroke);
    }
    Ok(pdf.finish())
}

/// Bytes with less room.
fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    // Nothing refuses to be written to memory.
    let _ = encoder.write_all(bytes);
    encoder.finish().unwrap_or_default()
}
