//! One of several slices of the runs of a sweep, and all slices as one table.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Instant;

use palpate::watch::{Progress, Watch};
use palpate_files::description::Sweep as SweptProtocol;
use palpate_files::parquet_table::{TableError, TableReader, TableWriter};

use super::{MARK, Parts, Sweep, Swept, digest, refused, table_of};
use crate::output::{Stage, unwritten_table};
use crate::shard::{Manifest, Places, Shard, ShardTable, finished};
use crate::store::Store;
use crate::{JobError, Outcome};

impl Sweep {
    /// Simulates the runs of one slice into the folder `out` of all slices, unless that is done.
    pub(super) fn run_slice(
        &self,
        sweep: &SweptProtocol,
        path: &Path,
        shard: Shard,
        out: Option<&Path>,
        figure: Option<&Path>,
        watch: &mut dyn Watch,
    ) -> Result<Outcome<Swept>, JobError> {
        let started = Instant::now();
        if figure.is_some() {
            let message = "expected no figure of a shard: a figure shows the runs of all";
            return Err(JobError::option(
                message,
                "merge the shards, and sweep again to the merged table with the figure",
            ));
        }
        let out = out.ok_or_else(|| {
            JobError::option(
                "expected the folder of the shards, found none",
                "name a folder that all shards share with ⟨out⟩",
            )
        })?;
        let places = Places::new(out, shard)?;
        let digest = digest(sweep)?;
        let store = Store::open(&places.journal(), "sweep", &format!("{digest} {shard}"), self.restart)?;
        let parts = Parts {
            sweep,
            path,
            store: &store,
        };
        let own = shard.range(parts.count());
        let runs = own.clone().map(|part| parts.runs(part)).map(|runs| runs.end - runs.start).sum();
        places.check_job("sweep")?;
        let mut manifest = Manifest {
            job: "sweep".to_owned(),
            shard,
            settings: digest.clone(),
            plan_sha256: digest,
            total: sweep.runs,
            inputs_sha256: None,
            tests: usize::try_from(runs).unwrap_or(usize::MAX),
            rows: usize::try_from(runs).unwrap_or(usize::MAX),
            failed: 0,
            compared: false,
            is_lasting: true,
            start: None,
            end: None,
            tables: BTreeMap::new(),
        };
        let table = places.table(ShardTable::Rows);
        let is_same = |found: &Manifest| {
            (found.shard, &found.settings, found.total) == (manifest.shard, &manifest.settings, manifest.total)
        };
        if !self.restart && finished(places).is_some_and(|found| is_same(&found)) {
            store.remove()?;
            return Ok(Swept::of(table, runs, runs, started)?.answered(true));
        }
        let (computed, done) = parts.computed(own, self.threads, watch)?;
        let mut stage = Stage::default();
        let written = parts.written(&mut stage, &table, &computed, &[])?;
        manifest.tables.insert(ShardTable::Rows, written.sha256()?);
        let refused = written.read().map_err(TableError::from).and_then(refused);
        manifest.failed =
            usize::try_from(refused.map_err(|error| unwritten_table(&table, &error))?.0).unwrap_or(usize::MAX);
        stage.bytes(&places.manifest(), &serde_json::to_vec_pretty(&manifest)?)?;
        stage.take(written)?;
        stage.commit()?;
        store.remove()?;
        // It is done whatever runs were refused, which all slices together are judged by.
        Ok(Swept::of(table, runs, done, started)?.answered(true))
    }
}

/// Writes the tables of all slices, in order and each whole, as one table: the bytes of a sweep of all runs.
pub(crate) fn merge(
    parts: &[(Places<'_>, Manifest)],
    out: &Path,
    watch: &mut dyn Watch,
) -> Result<Outcome<Swept>, JobError> {
    let started = Instant::now();
    let out = table_of(out, Some(out))?;
    let refused = |error: TableError| unwritten_table(&out, &error);
    let open = |places: &Places<'_>| -> Result<(PathBuf, TableReader), JobError> {
        let path = places.table(ShardTable::Rows);
        let file = File::open(&path).map_err(|error| JobError::unread(&path, &error))?;
        let table = TableReader::new(file).map_err(|error| unwritten_table(&path, &error))?;
        Ok((path, table))
    };
    let Some((places, first)) = parts.first() else {
        return Err(JobError::option("expected shards, found none", "name the folder of the shards"));
    };
    let fields = open(places)?.1.fields().to_vec();
    let mut stage = Stage::default();
    let mut file = stage.open(&out)?;
    let mut writer = TableWriter::new(&mut file, &fields).map_err(refused)?;
    let mut runs = 0;
    for (index, (places, _)) in parts.iter().enumerate() {
        watch.report(Progress::counted("merging", index, parts.len()))?;
        let (path, table) = open(places)?;
        for group in 0..table.groups() {
            let rows = table.read(group).map_err(|error| unwritten_table(&path, &error))?;
            writer.write(rows).map_err(refused)?;
        }
        runs += table.rows();
    }
    writer.finish(&[(MARK, &first.settings)]).map_err(refused)?;
    stage.take(file)?;
    stage.commit()?;
    Swept::of(out, runs, 0, started)
}
