//! The cut into phases: as a table, a sparkline and a figure.

use std::fmt::Write as _;

use palpate::analysis::{AnalysisError, AnalysisOptions, Finding, corrected_watched, suspicious_signs};
use palpate::record::{Record, SignalReport};
use palpate::segment::{Phase, SegmentError, Segmentation, TouchEstimate, find_contact_of};
use palpate::watch::Watch;
use palpate_files::description::TestDescription;
use palpate_files::record::RecordFile;
use palpate_report::figure::Figure;
use palpate_report::number::significant;
use palpate_report::result::mode_word;
use palpate_report::sparkline::{sparkline, strip};
use palpate_report::spelling::with_flags;
use palpate_report::study::cut_figure;
use palpate_report::table::{Cell, Table};
use palpate_report::wrapped;

/// Characters of a sparkline: what fits into a narrow terminal beside its label.
const WIDTH: usize = 64;

/// A corrected record and its phases, or why there are none.
#[derive(Debug)]
pub(super) struct Cut {
    pub(super) record: Record,
    /// How many corrections were made before.
    before: usize,
    found: Result<Segmentation, SegmentError>,
    /// The description gives the holds.
    are_given: bool,
    /// That the clocks differ, or a column lags, if they do.
    skewed: Vec<Finding>,
    /// What the columns are like where clocks that differ are put right.
    pub(super) signals: Option<SignalReport>,
}

impl Cut {
    /// Corrects a record as the description asks and cuts it.
    pub(super) fn of(
        record: &Record,
        test: Option<&TestDescription>,
        watch: &mut dyn Watch,
    ) -> Result<Self, AnalysisError> {
        let options = test.map_or_else(AnalysisOptions::default, |test| test.analysis.clone());
        let before = record.corrections().len();
        let corrected = corrected_watched(record, &options, watch)?;
        Ok(Self {
            skewed: corrected.skew_finding().into_iter().chain(corrected.lag.map(Finding::from)).collect(),
            signals: corrected.aligned(record).map(|(_, signals)| signals),
            record: corrected.record,
            before,
            are_given: !options.given_holds.is_empty(),
            found: corrected.segmentation,
        })
    }

    /// The phases, if there are any.
    pub(super) fn found(&self) -> Option<&Segmentation> {
        self.found.as_ref().ok()
    }

    /// Why the holds that a description gives cannot be those of the record, if so.
    pub(super) fn refused(&self) -> Option<&SegmentError> {
        let given = |error: &&SegmentError| {
            use SegmentError::{GivenOutside, GivenOverlap, GivenShort};
            matches!(error, GivenOutside { .. } | GivenOverlap { .. } | GivenShort { .. })
        };
        self.found.as_ref().err().filter(given)
    }

    /// The cut as a figure; of a record without phases, its curves.
    pub(super) fn figure(&self) -> Figure {
        let segments = self.found().map_or(&[][..], |found| &found.segments);
        cut_figure(&self.record, segments, self.are_given, "cut")
    }

    /// What is wrong with the columns, as far as the phases show it.
    pub(super) fn findings(&self) -> Vec<Finding> {
        let hunts = self.found().and_then(|found| found.ripple).map(Finding::JawHunts);
        let signs = self.found().map(|_| suspicious_signs(&self.record));
        hunts.into_iter().chain(signs.into_iter().flatten()).chain(self.skewed.clone()).collect()
    }

    /// Sparklines, phases and first touch as text.
    pub(super) fn reported(&self, test: Option<&TestDescription>, file: &RecordFile) -> String {
        let mut out = self.sparklines();
        match &self.found {
            Ok(found) => {
                out.push_str(&self.phases(found));
                out.push_str(&self.contact(found, test));
            }
            Err(_) if self.refused().is_some() => {}
            Err(error) => {
                let _ = writeln!(out, "Phases: {error}");
            }
        }
        for found in self.findings() {
            let turned = match &found {
                Finding::SignSuspicious { column, .. } => file.with_other_sign(column).map(|option| {
                    format!("if so, add {option}, or set sign = -1 in [columns.{column}] of the test description")
                }),
                _ => None,
            };
            let remedy = turned.unwrap_or_else(|| with_flags(found.remedy()));
            out.push_str(&wrapped(&format!("{}; {remedy}", found.observation())));
        }
        out
    }

    /// Displacement and force in one line each, and what the jaw does below them.
    fn sparklines(&self) -> String {
        let time = self.record.time();
        let mut out = String::new();
        if let Some(displacement) = self.record.displacement() {
            let _ = writeln!(out, "displacement  {}", sparkline(time, displacement, WIDTH));
        }
        let _ = writeln!(out, "force         {}", sparkline(time, self.record.force(), WIDTH));
        if let Ok(found) = &self.found {
            let stretches: Vec<(f64, f64, char)> = found
                .segments
                .iter()
                .map(|segment| {
                    let letter = match segment.phase {
                        Phase::Rest => '·',
                        Phase::Loading => '/',
                        Phase::Hold => '━',
                        Phase::Unloading => '\\',
                    };
                    // To where the next one begins, so that no gap is left between them.
                    let end = segment.end.min(time.len() - 1);
                    (time[segment.start], time[end], letter)
                })
                .collect();
            let line = strip(time[0], time[time.len() - 1], &stretches, WIDTH);
            let _ = writeln!(out, "phases        {}", line.trim_end());
            let _ = writeln!(out, "              ━ hold  / loading  \\ unloading  · rest");
        }
        out.push('\n');
        out
    }

    fn phases(&self, segmentation: &Segmentation) -> String {
        let record = &self.record;
        let (time, force) = (record.time(), record.force());
        let mut table = Table::of("phases", "Phases", &segmentation.segments)
            .column("Phase", "phase", "", |segment| Cell::text(format!("{:?}", segment.phase).to_lowercase()))
            .column("Held", "mode", "", |segment| Cell::text(segment.mode.map(mode_word).unwrap_or_default()))
            .column("From", "start_s", "s", |segment| Cell::Number(time[segment.start], 6))
            .column("To", "end_s", "s", |segment| Cell::Number(time[segment.end - 1], 6))
            .column("Samples", "samples", "", |segment| Cell::Integer(segment.len() as i64))
            .column("Displacement", "displacement_mm", "mm", |segment| {
                let end = record.displacement().map(|displacement| 1e3 * displacement[segment.end - 1]);
                Cell::number_or(end, 4, "not recorded")
            })
            .column("Force at start", "force_start_n", "N", |segment| Cell::Number(force[segment.start], 4))
            .column("Force at end", "force_end_n", "N", |segment| Cell::Number(force[segment.end - 1], 4))
            .table();
        for rupture in &segmentation.ruptures {
            table = table.note(Finding::Ruptured(*rupture).observation());
        }
        let mut out = table.to_plain_text();
        let done = &record.corrections()[self.before..];
        if !done.is_empty() {
            out.push('\n');
        }
        done.iter().for_each(|done| out.push_str(&wrapped(&format!("done: {done}"))));
        out
    }

    /// Where the body was first touched, if the jaw went through air before.
    fn contact(&self, segmentation: &Segmentation, test: Option<&TestDescription>) -> String {
        let body = test
            .and_then(|test| test.analysis.geometry.as_ref())
            .and_then(|geometry| geometry.specimen(1.0).ok());
        let choice = test.map(|test| test.analysis.touch).unwrap_or_default();
        let contact = find_contact_of(&self.record, segmentation, body.as_ref(), choice);
        let mut out = String::new();
        if contact.air_travel > 0.0 {
            let _ = writeln!(
                out,
                "\nfirst touch at {} mm, after {} mm through air; force zero {} N",
                significant(1e3 * contact.tare.displacement, 4),
                significant(1e3 * contact.air_travel, 3),
                significant(contact.tare.force, 3)
            );
        }
        if let Some(spread) = contact.spread {
            let rule =
                |rule: &TouchEstimate| format!("{} {} mm", rule.method.name(), significant(1e3 * rule.displacement, 4));
            let rules: Vec<String> = contact.estimates.iter().map(rule).collect();
            out.push_str(&wrapped(&format!(
                "the rules for first touch scatter by {} mm (robust standard deviation): {}",
                significant(1e3 * spread, 2),
                rules.join(", ")
            )));
        }
        out
    }
}
