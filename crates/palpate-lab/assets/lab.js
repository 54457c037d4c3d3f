// The page: files on one side, what was opened on the other.

import { Lost, call, listen, putText, send } from "./api.js";
import { button, bytes, el, refusal, say } from "./dom.js";
import { gripPanel } from "./grip.js";
import { Study, materialView, together } from "./study.js";

const byId = (id) => document.getElementById(id);
const state = { files: [], materials: [], vocabulary: null, open: null, shown: null, chosen: new Set() };

const show = (what, view) => {
  state.open = what;
  state.shown = view;
  byId("view").replaceChildren(view.box);
  list();
  view.box.querySelector(".title")?.focus({ preventScroll: true });
  if (byId("main").getBoundingClientRect().top < 0) byId("main").scrollIntoView();
  const started = view.start();
  started?.catch?.((error) => { if (!(error instanceof Lost)) byId("view").prepend(refusal(error)); });
};
const open = (subject) => show({ kind: "record", ...subject }, new Study(subject, state.vocabulary, { opened: open, materialMade }));
const openMaterial = (name) => show({ kind: "material", file: name }, materialView(name));
const openTogether = () => show({ kind: "together" }, together([...state.chosen].map((file) => ({ file, part: null })), state.vocabulary, { opened: open, materialMade }));
const materialMade = async (name, study) => {
  study.showGrip(await gripPanel(name));
};

const list = () => {
  const current = (kind, name) => (state.open?.kind === kind && state.open.file === name ? "page" : undefined);
  byId("list").replaceChildren(...state.files.map(({ name, bytes: size }) => el("li", {},
    el("input", { type: "checkbox", checked: state.chosen.has(name), "aria-label": `Choose ${name}`, onchange: (event) => { if (event.target.checked) state.chosen.add(name); else state.chosen.delete(name); list(); } }),
    button(name, () => open({ file: name, part: null }), { className: "entry-button", "aria-current": current("record", name) }), el("span", { className: "small" }, bytes(size)))));
  byId("materials").replaceChildren(...state.materials.map((name) => el("li", {}, el("span", { className: "tag" }, "material"), button(name, () => openMaterial(name), { className: "entry-button", "aria-current": current("material", name) }))));
  for (const id of ["list", "materials"]) byId(id).hidden = !byId(id).children.length;
  const count = state.chosen.size;
  byId("together").hidden = count < 2;
  byId("together").replaceChildren(button(`Compare ${count} records`, openTogether));
};

const reload = async () => {
  const found = await call("GET", "api/folder");
  Object.assign(state, { files: found.files, materials: found.materials });
  for (const name of state.chosen) if (!found.files.some((file) => file.name === name)) state.chosen.delete(name);
  byId("place").replaceChildren(found.temporary ? "Temporary folder: records and descriptions go when the lab ends. " : "", el("code", {}, found.path));
  list();
  return found;
};

// Uploads at a time. A browser has six connections to a host: the rest is for what the page does meanwhile.
const UPLOADS = 2;

// What was dropped: records go into the folder; a description is for the record that is open; a material is kept.
const take = async (files) => {
  let first = null;
  const waiting = [...files].map((file) => {
    const bar = el("progress", { max: 1, value: 0, "aria-label": `Upload of ${file.name}` });
    return { file, bar, entry: el("li", {}, el("span", {}, file.name), bar) };
  });
  byId("uploads").append(...waiting.map(({ entry }) => entry));
  const takeOne = async ({ file, bar, entry }) => {
    try {
      if (/\.toml$/i.test(file.name) && file.size < 1 << 20) {
        await takeText(file);
      } else {
        const name = await send(file, (share) => (bar.value = share));
        first ??= name;
        if (first === name) {
          await reload();
          open({ file: name, part: null });
        }
      }
      entry.remove();
    } catch (error) {
      entry.replaceChildren(refusal(error), button("Dismiss", () => entry.remove(), { className: "quiet" }));
    }
  };
  const oneByOne = async () => { while (waiting.length) await takeOne(waiting.shift()); };
  await Promise.all(Array.from({ length: UPLOADS }, oneByOne));
  await reload();
  if (files.length > 1) say(`${files.length} files have arrived.`);
};

const takeText = async (file) => {
  const text = await file.text();
  if (/^\s*\[calibration\]/m.test(text)) {
    const { name } = await putText(`api/materials/${encodeURIComponent(file.name)}`, text);
    await reload();
    return openMaterial(name);
  }
  if (!(state.shown instanceof Study)) throw new Error("a test description is for the record that is open: open a record first");
  const { subject } = state.shown;
  await call("POST", "api/state", { subject, text });
  return state.shown.refresh();
};

const begin = async () => {
  const over = (event) => {
    if (![...event.dataTransfer.types].includes("Files")) return;
    event.preventDefault();
    document.body.classList.toggle("dropping", event.type === "dragover");
  };
  for (const name of ["dragover", "dragleave"]) addEventListener(name, over);
  addEventListener("drop", (event) => {
    if (!event.dataTransfer.files.length) return;
    event.preventDefault();
    document.body.classList.remove("dropping");
    take(event.dataTransfer.files);
  });
  byId("choose").addEventListener("change", (event) => {
    take(event.target.files).finally(() => (event.target.value = ""));
  });
  state.vocabulary = await call("GET", "api/vocabulary");
  const found = await reload();
  if (found.files.length) open({ file: found.files[0].name, part: null });
  else byId("view").replaceChildren(el("div", { className: "welcome" }, el("h2", {}, "Drop a record"), el("p", {}, "A record holds time, force and, if possible, displacement: of a testing machine, a gripper, a microscope. The lab finds its holds, fits the laws of relaxation, says how sure they are and how long a grip would hold."), el("p", { className: "small" }, `palpate ${state.vocabulary.version}. Everything stays on this machine.`)));
  addEventListener("focus", () => reload().catch(() => {}));
  listen(found.revision, found.folder, () => {
    reload().catch(() => {});
    state.shown?.refresh?.();
  });
};

begin().catch((error) => { if (!(error instanceof Lost)) byId("view").replaceChildren(refusal(error)); });
