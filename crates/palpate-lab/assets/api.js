// Requests to the lab, and its tasks.

const base = new URL(".", location.href);

// What the lab refuses, with what helps.
export class Refused extends Error {
  constructor({ message, hint }, status) {
    super(message);
    Object.assign(this, { hint, status });
  }
}
// A task that was ended.
export class Cancelled extends Error {}
// The lab does not answer.
export class Lost extends Error {}

let lost = false;
const show = (text) => {
  const box = document.getElementById("lost");
  box.hidden = !text;
  box.textContent = text ?? "";
};
const ended = () => {
  if (lost) return;
  lost = true;
  show("The lab has ended, or was started anew. Start it again with “palpate lab”, and open the address that it prints; what lies in the folder is kept.");
};

export const address = (path) => new URL(path, base).href;

// A lab that was started anew has another address, and answers this one with a text.
const isForeign = (status, type) => status === 404 && !type?.startsWith("application/json");
const read = async (answer) => {
  if (isForeign(answer.status, answer.headers.get("content-type"))) {
    ended();
    throw new Lost();
  }
  if (lost) show(null);
  lost = false;
  if (answer.ok) return answer.json();
  let found = null;
  try { found = await answer.json(); } catch { found = { message: `the lab answered with ${answer.status}` }; }
  throw new Refused(found, answer.status);
};

export const call = async (method, path, body) => {
  const options = { method };
  if (body !== undefined) Object.assign(options, { headers: { "content-type": "application/json" }, body: JSON.stringify(body) });
  let answer;
  try {
    answer = await fetch(address(path), options);
  } catch {
    ended();
    throw new Lost();
  }
  return read(answer);
};

// Sends a file; `heard` gets the share that has arrived.
export const send = (file, heard) => new Promise((resolve, reject) => {
  const request = new XMLHttpRequest();
  request.open("PUT", address(`api/files/${encodeURIComponent(file.name)}`));
  request.upload.addEventListener("progress", (event) => heard(event.loaded / Math.max(1, event.total)));
  request.addEventListener("error", () => reject(new Lost("the upload was interrupted")));
  request.addEventListener("load", () => {
    let found = { message: `the lab answered with ${request.status}` };
    try { found = JSON.parse(request.responseText); } catch { /* as above */ }
    if (request.status === 200) return resolve(found.name);
    if (isForeign(request.status, request.getResponseHeader("content-type"))) ended();
    reject(new Refused(found, request.status));
  });
  request.send(file);
});

export const putText = async (path, text) => {
  let answer;
  try { answer = await fetch(address(path), { method: "PUT", headers: { "content-type": "text/plain" }, body: text }); } catch { ended(); throw new Lost(); }
  return read(answer);
};

// Tasks that this page waits for, by number.
const waiting = new Map();
const hear = (brief) => {
  const listener = waiting.get(brief.id);
  if (!listener) return;
  if (brief.state === "waiting" || brief.state === "running") return listener.heard(brief);
  waiting.delete(brief.id);
  listener.end(brief);
};

// A task: `heard` gets how far it is, `done` what it made. `cancel` ends it.
export const task = (request, { first = false, heard = () => {} } = {}) => {
  const begun = call("POST", "api/tasks", { request, first }).then(({ id }) => id);
  const done = begun.then((id) => new Promise((resolve, reject) => {
    const end = async (brief) => {
      heard(brief);
      if (brief.state === "failed") return reject(new Refused(brief, 422));
      if (brief.state === "cancelled") return reject(new Cancelled());
      try {
        const { answer } = await call("GET", `api/tasks/${id}`);
        resolve({ id, answer });
      } catch (error) { reject(error); }
    };
    const others = waiting.get(id);
    // The same task twice on one page: both hear of it.
    waiting.set(id, others ? { heard: (brief) => { others.heard(brief); heard(brief); }, end: (brief) => { others.end(brief); end(brief); } } : { heard, end });
    call("GET", `api/tasks/${id}`).then(({ task: brief }) => hear(brief), (error) => { waiting.delete(id); reject(error); });
  }));
  return { done, id: begun, cancel: () => begun.then((id) => call("DELETE", `api/tasks/${id}`)) };
};

// Hears of changes for as long as the page is open; `changed` is called when the folder has changed.
export const listen = async (revision, folder, changed) => {
  for (;;) {
    try {
      const found = await call("GET", `api/changes?revision=${revision}`);
      revision = found.revision;
      found.tasks.forEach(hear);
      if (found.folder !== folder) {
        folder = found.folder;
        changed();
      }
    } catch (error) {
      if (!(error instanceof Lost)) ended();
      await new Promise((resolve) => setTimeout(resolve, 2000));
    }
  }
};
