//! Records, descriptions and materials of the folder.

use std::sync::Arc;

use axum::Json;
use axum::body::Body;
use axum::extract::{Path, State};
use axum::response::{IntoResponse, Response};
use http_body_util::BodyExt;
use palpate_files::description::{Edit, machines, parse_material, schema_test, shapes};
use palpate_files::naming::Quantity;
use palpate_jobs::{Calibrate, ErrorKind, JobError};
use palpate_report::document::Software;
use serde::Deserialize;
use serde_json::{Value, json};
use tokio::sync::mpsc;

use super::refusal::{Refusal, aside};
use super::{Lab, Server};
use crate::folder::{Stated, Subject};
use crate::tasks::{grip_range, material_of};

/// Pieces of an upload that wait for the disk.
const PIECES: usize = 16;

/// The words of descriptions: shapes with their sizes, quantities with their units, machines, and what each key means; and the laws of a
/// calibration, the usual one first.
pub(super) async fn vocabulary() -> Json<Value> {
    let units = |quantity: Quantity| {
        let units: Vec<&str> = quantity.dimension().units().iter().map(|(symbol, _)| *symbol).collect();
        json!({ "name": quantity.to_string(), "units": units })
    };
    let Calibrate { law, alternatives, .. } = Calibrate::default();
    Json(json!({
        "laws": std::iter::once(law).chain(alternatives.into_iter().filter(|other| *other != law)).map(|law| law.to_string()).collect::<Vec<_>>(),
        "version": Software::this().release(),
        "quantities": Quantity::ALL.map(units),
        "shapes": shapes(),
        "machines": machines().iter().map(|machine| json!({ "name": machine.name, "about": machine.about() })).collect::<Vec<_>>(),
        "schema": schema_test(),
    }))
}

/// What is in the folder.
pub(super) async fn folder(State(server): Lab) -> Result<Json<Value>, Refusal> {
    let found = aside(&server, |server| {
        let (revision, changed, _) = server.tasks.since(u64::MAX);
        let folder = &server.folder;
        Ok(json!({
            "revision": revision,
            "folder": changed,
            "path": folder.path().display().to_string(),
            "temporary": folder.is_temporary(),
            "files": folder.records(),
            "materials": folder.materials(),
        }))
    });
    Ok(Json(found.await?))
}

/// Takes a file, piece by piece.
pub(super) async fn upload(
    State(server): Lab,
    Path(name): Path<String>,
    mut body: Body,
) -> Result<Json<Value>, Refusal> {
    let (sender, mut pieces) = mpsc::channel::<Result<axum::body::Bytes, ()>>(PIECES);
    let disk = {
        let server = Arc::clone(&server);
        tokio::task::spawn_blocking(move || {
            let mut upload = server.folder.upload(&name)?;
            while let Some(piece) = pieces.blocking_recv() {
                match piece {
                    Ok(piece) => upload.write(&piece)?,
                    Err(()) => return Err(JobError::from(palpate::watch::Cancelled)),
                }
            }
            upload.finish()
        })
    };
    while let Some(frame) = body.frame().await {
        let piece = frame.map_err(drop).and_then(|frame| frame.into_data().map_err(drop));
        let broken = piece.is_err();
        // A disk that takes no more says why below.
        if sender.send(piece).await.is_err() || broken {
            break;
        }
    }
    drop(sender);
    let broken = |_| JobError::new(ErrorKind::Record, "the upload ended unexpectedly", None);
    let name = disk.await.map_err(broken).flatten().map_err(|error| Refusal::of(&error, &server.folder))?;
    server.tasks.folder_changed();
    Ok(Json(json!({ "name": name })))
}

/// What is stated about a test.
pub(super) async fn described(State(server): Lab, Json(subject): Json<Subject>) -> Result<Json<Stated>, Refusal> {
    Ok(Json(aside(&server, move |server| server.folder.stated(&subject)).await?))
}

/// Changes of a description.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Change {
    subject: Subject,
    /// Whether they are of this test alone, where its file holds several.
    #[serde(default)]
    alone: bool,
    edits: Vec<Edit>,
}

pub(super) async fn edit(State(server): Lab, Json(change): Json<Change>) -> Result<Json<Stated>, Refusal> {
    let edit = move |server: &Server| server.folder.edit(&change.subject, change.alone, &change.edits);
    let stated = aside(&server, edit).await?;
    server.tasks.folder_changed();
    Ok(Json(stated))
}

/// A whole description.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Statement {
    subject: Subject,
    text: String,
}

pub(super) async fn state(State(server): Lab, Json(statement): Json<Statement>) -> Result<Json<Stated>, Refusal> {
    let stated = aside(&server, move |server| server.folder.state(&statement.subject, &statement.text)).await?;
    server.tasks.folder_changed();
    Ok(Json(stated))
}

/// What a material allows.
pub(super) async fn material(State(server): Lab, Path(name): Path<String>) -> Result<Json<Value>, Refusal> {
    Ok(Json(aside(&server, move |server| Ok(grip_range(&material_of(&server.folder, &name)?))).await?))
}

/// Takes a material file.
pub(super) async fn keep_material(
    State(server): Lab,
    Path(name): Path<String>,
    text: String,
) -> Result<Response, Refusal> {
    let keep = move |server: &Server| {
        let material = parse_material(&text, std::path::Path::new(&name))?;
        server.folder.keep_material(&name, &material)
    };
    let name = aside(&server, keep).await?;
    server.tasks.folder_changed();
    Ok(Json(json!({ "name": name })).into_response())
}
