//! Tasks, what changed, what they made.

use std::sync::Arc;
use std::time::Duration;

use axum::Json;
use axum::extract::{Path, Query, State};
use axum::http::header;
use axum::response::{IntoResponse, Response};
use palpate::watch::Unwatched;
use palpate_jobs::{BatchedTest, ErrorKind, JobError, PlanGrip};
use palpate_report::figure::PictureFormat;
use palpate_report::page::{Block, fragment};
use palpate_report::study::{StudyError, tried_figure};
use palpate_report::table::{Cell, CsvLocale, Table};
use serde::Deserialize;
use serde_json::{Value, json};

use super::Lab;
use super::refusal::{Refusal, aside};
use super::zipped::zipped;
use crate::tasks::{Brief, Made, PictureChoice, Request, material_of};

/// How long a page waits for a change before it asks again.
const PATIENCE: Duration = Duration::from_secs(20);
/// Changes within this time are heard together.
const TOGETHER: Duration = Duration::from_millis(25);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Start {
    request: Request,
    /// Whether it goes before those that wait.
    #[serde(default)]
    first: bool,
}

/// Starts a task, or finds the one that does the same.
pub(super) async fn start(State(server): Lab, Json(start): Json<Start>) -> Result<Json<Value>, Refusal> {
    let id = aside(&server, move |server| Ok(server.tasks.add(start.request, start.first))).await?;
    Ok(Json(json!({ "id": id })))
}

#[derive(Deserialize)]
pub(super) struct Since {
    revision: u64,
}

/// The tasks that changed; waits for a change where there is none.
pub(super) async fn changes(State(server): Lab, Query(since): Query<Since>) -> Json<Value> {
    let mut heard = server.tasks.heard();
    let changed = heard.wait_for(|revision| *revision > since.revision);
    if tokio::time::timeout(PATIENCE, changed).await.is_ok() {
        tokio::time::sleep(TOGETHER).await;
    }
    let (revision, folder, tasks) = server.tasks.since(since.revision);
    Json(json!({ "revision": revision, "folder": folder, "tasks": tasks }))
}

pub(super) async fn find(State(server): Lab, Path(id): Path<u64>) -> Result<Json<Value>, Refusal> {
    let (brief, made): (Brief, _) = server.tasks.find(id).ok_or_else(|| Refusal::unknown("task"))?;
    let answer = made.map_or(Value::Null, |made| made.answer.clone());
    Ok(Json(json!({ "task": brief, "answer": answer })))
}

pub(super) async fn cancel(State(server): Lab, Path(id): Path<u64>) -> Result<Json<Value>, Refusal> {
    if server.tasks.cancel(id) { Ok(Json(json!({}))) } else { Err(Refusal::unknown("task")) }
}

#[derive(Deserialize)]
pub(super) struct From {
    #[serde(default)]
    from: usize,
}

/// The tests of a batch that are done, from one on.
pub(super) async fn rows(
    State(server): Lab,
    Path(id): Path<u64>,
    Query(from): Query<From>,
) -> Result<Json<Vec<BatchedTest>>, Refusal> {
    server.tasks.rows(id, from.from).map(Json).ok_or_else(|| Refusal::unknown("task"))
}

/// All rows of a batch as a table to take away.
pub(super) async fn rows_csv(State(server): Lab, Path(id): Path<u64>) -> Result<Response, Refusal> {
    let tests = server.tasks.rows(id, 0).ok_or_else(|| Refusal::unknown("task"))?;
    let names = BatchedTest::columns();
    let mut table = Table::new("holds", "Holds");
    for name in &names {
        table = table.column(name, name, "");
    }
    for row in tests.iter().flat_map(|test| &test.rows) {
        table = table.row(names.iter().map(|name| cell(row.get(name))).collect());
    }
    Ok(attached("holds.csv", table.to_csv(CsvLocale::En).into_bytes()))
}

fn cell(value: Option<&Value>) -> Cell {
    match value {
        Some(Value::Number(number)) => match number.as_i64() {
            Some(whole) => Cell::Integer(whole),
            None => Cell::Number(number.as_f64().unwrap_or(f64::NAN), 6),
        },
        Some(Value::String(text)) => Cell::text(text.as_str()),
        Some(Value::Bool(is)) => Cell::text(is.to_string()),
        _ => Cell::text(""),
    }
}

#[derive(Deserialize)]
pub(super) struct Quantity {
    quantity: String,
}

/// A map of a quantity over the positions of the curves.
pub(super) async fn map(
    State(server): Lab,
    Path(id): Path<u64>,
    Query(of): Query<Quantity>,
) -> Result<Json<Value>, Refusal> {
    let made = made(&server.tasks, id)?;
    let html = aside(&server, move |_| {
        let map = made.map().ok_or_else(|| JobError::option("no curve has a position", ""))?;
        let block = Block::figure(&map.figure(&of.quantity, "map")?).map_err(StudyError::from)?;
        Ok(fragment(&[block]))
    });
    Ok(Json(json!({ "figure": html.await? })))
}

/// The figures of an analysed test in a format, as one file.
pub(super) async fn pictures(
    State(server): Lab,
    Path(id): Path<u64>,
    Query(choice): Query<PictureChoice>,
) -> Result<Response, Refusal> {
    let made = made(&server.tasks, id)?;
    let pictures = aside(&server, move |_| {
        let files = made.pictures(choice)?;
        zipped(&files)
    });
    let bytes = pictures.await?;
    Ok(attached("figures.zip", bytes))
}

/// A file that a task made; a figure of an analysed test in the format of its ending.
pub(super) async fn file(State(server): Lab, Path((id, path)): Path<(u64, String)>) -> Result<Response, Refusal> {
    let made = made(&server.tasks, id)?;
    let name = path.rsplit('/').next().unwrap_or_default().to_owned();
    let bytes = aside(&server, move |_| {
        if let Some(bytes) = made.file(&path) {
            return Ok(Some(bytes.to_vec()));
        }
        let Some(format) = PictureFormat::of(std::path::Path::new(&path)) else {
            return Ok(None);
        };
        let files = made.pictures(PictureChoice { format, column: None })?;
        Ok(files.iter().find(|(name, _)| *name == path).map(|(_, bytes)| bytes.clone()))
    });
    let bytes = bytes.await?.ok_or_else(|| Refusal::unknown("file"))?;
    if name.ends_with(".html") {
        // A report runs its own script and nothing else, as a page of no site: it cannot reach the lab.
        let policy = "sandbox allow-scripts allow-popups allow-downloads; frame-ancestors 'self'";
        let headers = [(header::CONTENT_TYPE, "text/html; charset=utf-8"), (header::CONTENT_SECURITY_POLICY, policy)];
        return Ok((headers, bytes).into_response());
    }
    Ok(attached(&name, bytes))
}

fn made(tasks: &crate::tasks::Tasks, id: u64) -> Result<Arc<Made>, Refusal> {
    tasks
        .find(id)
        .and_then(|(_, made)| made)
        .ok_or_else(|| Refusal::unknown("result: its record may have changed, or newer results have taken its place"))
}

/// A file to be saved, never shown: what stands in it is no part of the page. Its link on the page names it after the record.
fn attached(name: &str, bytes: Vec<u8>) -> Response {
    let kind = match name.rsplit('.').next() {
        Some("csv") => "text/csv; charset=utf-8",
        Some("json") => "application/json",
        Some("zip") => "application/zip",
        Some("pdf") => "application/pdf",
        Some("xlsx") => "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
        _ => "application/octet-stream",
    };
    let headers = [
        (header::CONTENT_TYPE, kind),
        (header::CONTENT_DISPOSITION, "attachment"),
        (header::CONTENT_SECURITY_POLICY, "default-src 'none'; sandbox"),
    ];
    (headers, bytes).into_response()
}

/// Whether a squeeze holds, while a person moves sliders.
pub(super) async fn try_squeeze(
    State(server): Lab,
    Path(material): Path<String>,
    Json(options): Json<PlanGrip>,
) -> Result<Json<Value>, Refusal> {
    let answer = aside(&server, move |server| {
        let tried = options.try_squeeze(&material_of(&server.folder, &material)?, &mut Unwatched)?;
        let block = Block::figure(&tried_figure(&tried)).map_err(StudyError::from)?;
        let mut answer = serde_json::to_value(&tried).map_err(|error| JobError::new(ErrorKind::Report, error, None))?;
        answer["figure"] = fragment(&[block]).into();
        answer["lines"] = serde_json::to_value(crate::lines::of_grip(&material, &options)).unwrap_or_default();
        Ok(answer)
    });
    Ok(Json(answer.await?))
}
