//! Subsets of the typeface, with what their glyphs are called so that text can be searched and copied.

use std::collections::BTreeMap;

use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Filter, Finish as _, Name, Pdf, Rect, Ref, Str};
use resvg::usvg::fontdb::{Database, ID};
use resvg::usvg::layout::PositionedGlyph;
use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, GlyphId, MetadataProvider as _};
use subsetter::{GlyphRemapper, subset};

use super::packed;

/// Codes are the numbers of glyphs in the subset.
const IDENTITY: SystemInfo<'_> = SystemInfo {
    registry: Str(b"Adobe"),
    ordering: Str(b"Identity"),
    supplement: 0,
};

/// The fonts of a figure, in the order in which they are met.
#[derive(Default)]
pub(super) struct Fonts(Vec<Used>);

/// The glyphs of a font that a figure shows.
struct Used {
    font: ID,
    glyphs: GlyphRemapper,
    /// What each stands for.
    texts: BTreeMap<u16, String>,
}

impl Fonts {
    /// The number of the font of a glyph, and its code there.
    pub(super) fn code(&mut self, glyph: &PositionedGlyph) -> Result<(usize, u16), String> {
        let index = self.0.iter().position(|used| used.font == glyph.font).unwrap_or_else(|| {
            self.0.push(Used {
                font: glyph.font,
                glyphs: GlyphRemapper::new(),
                texts: BTreeMap::new(),
            });
            self.0.len() - 1
        });
        let number = u16::try_from(glyph.id.0).map_err(|_| "a glyph beyond 65535".to_owned())?;
        let used = &mut self.0[index];
        let code = used.glyphs.remap(number);
        used.texts.entry(code).or_insert_with(|| glyph.text.clone());
        Ok((index, code))
    }

    /// Writes the fonts and returns where each is.
    pub(super) fn embed(self, pdf: &mut Pdf, next: &mut Ref, known: &Database) -> Result<Vec<Ref>, String> {
        self.0
            .into_iter()
            .map(|used| {
                let name = known.face(used.font).map_or_else(String::new, |face| face.post_script_name.clone());
                let written =
                    known.with_face_data(used.font, |data, index| used.embed(pdf, next, &name, (data, index)));
                written.unwrap_or_else(|| Err("a font that is not there".to_owned()))
            })
            .collect()
    }
}

impl Used {
    fn embed(&self, pdf: &mut Pdf, next: &mut Ref, name: &str, (data, index): (&[u8], u32)) -> Result<Ref, String> {
        let file = subset(data, index, &self.glyphs).map_err(|error| error.to_string())?;
        let font = FontRef::from_index(data, index).map_err(|error| error.to_string())?;
        let metrics = font.metrics(Size::unscaled(), LocationRef::default());
        let advances = font.glyph_metrics(Size::unscaled(), LocationRef::default());
        // Metrics of a PDF are in thousandths of the size.
        let scale = 1000.0 / f32::from(metrics.units_per_em);
        let widths = self
            .glyphs
            .remapped_gids()
            .map(|glyph| advances.advance_width(GlyphId::from(glyph)).unwrap_or_default() * scale);
        let name = format!("{}+{name}", self.tag());
        let name = Name(name.as_bytes());
        let [outer, inner, descriptor, stream, names] = [(); 5].map(|()| next.bump());
        pdf.type0_font(outer)
            .base_font(name)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(inner)
            .to_unicode(names);
        let mut written = pdf.cid_font(inner);
        written
            .subtype(CidFontType::Type2)
            .base_font(name)
            .system_info(IDENTITY)
            .font_descriptor(descriptor);
        written.default_width(0.0).cid_to_gid_map_predefined(Name(b"Identity"));
        written.widths().consecutive(0, widths);
        written.finish();
        let bounds = metrics.bounds.unwrap_or_default();
        pdf.font_descriptor(descriptor)
            .name(name)
            .flags(FontFlags::SYMBOLIC)
            .bbox(Rect::new(bounds.x_min * scale, bounds.y_min * scale, bounds.x_max * scale, bounds.y_max * scale))
            .italic_angle(0.0)
            .ascent(metrics.ascent * scale)
            .descent(metrics.descent * scale)
            .cap_height(metrics.cap_height.unwrap_or(metrics.ascent) * scale)
            .stem_v(if name.0.ends_with(b"Bold") { 140.0 } else { 80.0 })
            .font_file2(stream);
        pdf.stream(stream, &packed(&file)).filter(Filter::FlateDecode);
        let mut map = UnicodeCmap::new(Name(b"palpate"), IDENTITY);
        self.texts.iter().for_each(|(code, text)| map.pair_with_multiple(*code, text.chars()));
        pdf.cmap(names, &packed(&map.finish())).filter(Filter::FlateDecode);
        Ok(outer)
    }

    /// Six letters that tell subsets of one font apart.
    fn tag(&self) -> String {
        // FNV-1a over the glyphs.
        let mut hash = self
            .glyphs
            .remapped_gids()
            .fold(0xcbf2_9ce4_8422_2325_u64, |hash, glyph| (hash ^ u64::from(glyph)).wrapping_mul(0x0100_0000_01b3));
        let mut letter = || {
            let letter = b'A' + (hash % 26) as u8;
            hash /= 26;
            char::from(letter)
        };
        [(); 6].map(|()| letter()).iter().collect()
    }
}
