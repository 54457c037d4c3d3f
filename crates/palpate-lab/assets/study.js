// A test on the page: its record, its body, its laws, its grip; a file of many tests as a table; several records beside each other.

import { Cancelled, Lost, call, task } from "./api.js";
import { button, drawn, el, progress, refusal, say, shown } from "./dom.js";
import { calibration, gripPanel, lawChoice, lines } from "./grip.js";
import { Description, PhaseFigure, bodyForm, columnTable, holdTable, textForm } from "./record.js";

// Rows of a record whose laws are compared in a second step.
const LONG = 20000;

const card = (id, heading, ...children) => el("section", { className: "card", "aria-labelledby": `${id}-heading` }, el("h2", { id: `${id}-heading` }, heading), el("div", { id }, ...children));
const failed = (error) => (error instanceof Cancelled ? el("p", {}, "Cancelled.") : refusal(error));

// Runs a task into a box: its progress first, then what `show` makes of it. Of two runs into one box the later one counts.
const into = async (box, request, show, { first = true, keep = true } = {}) => {
  const run = (box.run = {});
  const running = task(request, { first, heard: (brief) => box.run === run && bar.show(brief) });
  const bar = progress(running.cancel);
  // What stood there stays until it is replaced, marked as of before.
  if (keep && box.firstChild) {
    box.classList.add("before");
    box.querySelector(":scope > .progress")?.remove();
    box.prepend(bar);
  } else box.replaceChildren(bar);
  try {
    const { id, answer } = await running.done;
    if (box.run !== run) return null;
    box.classList.remove("before");
    box.replaceChildren(...show(answer, id));
    return { id, answer };
  } catch (error) {
    if (box.run === run && !(error instanceof Lost)) {
      box.classList.remove("before");
      box.replaceChildren(failed(error));
    }
    return null;
  }
};

export class Study {
  constructor(subject, vocabulary, { opened, materialMade }) {
    Object.assign(this, { subject, vocabulary, opened, materialMade });
    this.description = new Description(subject, () => this.changed());
    this.record = el("div", { "aria-live": "off" });
    this.body = el("div");
    this.laws = el("div");
    this.creep = el("div");
    this.tests = el("div");
    this.grip = el("div");
    this.law = lawChoice(vocabulary.laws);
    this.answer = el("p", { className: "headline" });
    this.box = el("div", { className: "study" }, this.head(), this.cards = el("div"));
  }

  head() {
    const { file, part } = this.subject;
    return el("div", { className: "study-head" }, part !== null && el("p", { className: "crumb" }, button(`‹ ${file}`, () => this.opened({ file, part: null }), { className: "link" })), el("h2", { className: "title", tabindex: "-1" }, part ?? file), this.answer);
  }

  async start() {
    await this.description.load();
    this.cards.replaceChildren(card("record", "Record", this.record));
    await this.inspect();
  }

  // What is stated has changed: all that depends on it is made anew.
  async changed() {
    const open = [...this.cards.querySelectorAll("details[id]")].filter((one) => one.open).map((one) => one.id);
    if (this.gripBox?.firstChild && !this.outdated) this.grip.prepend(this.outdated = el("p", { className: "note-line" }, "What is stated has changed since this material was made: calibrate again."));
    await this.inspect(open);
  }

  // Where a person was working on what is made anew, and how to go on there.
  held() {
    const one = document.activeElement;
    if (!this.record.contains(one)) return () => {};
    const [id, label, text] = [one.id, one.getAttribute("aria-label"), one.matches("input[type=text]") ? one.value : null];
    const typed = text !== null && text !== one.defaultValue;
    return () => {
      const again = (id && document.getElementById(id)) || (label && [...this.record.querySelectorAll("[aria-label]")].find((other) => other.getAttribute("aria-label") === label && other.getClientRects().length));
      if (!again) return;
      if (typed && again.matches("input[type=text]")) again.value = text;
      again.focus({ preventScroll: true });
    };
  }

  async refresh() {
    const before = this.description.stated.text;
    await this.description.load();
    if (this.description.stated.text !== before) this.changed();
  }

  async inspect(open = []) {
    let goOn = () => {};
    const made = await into(this.record, { kind: "inspect", subject: this.subject }, (answer) => {
      goOn = this.held();
      return this.shownRecord(answer, open);
    });
    goOn();
    if (!made) return;
    const { tests } = made.answer.document;
    this.rows = tests[0]?.rows ?? 0;
    if (tests.length > 1) return this.many();
    if (!tests[0]?.record || tests[0].refused) {
      this.answer.replaceChildren();
      this.cards.replaceChildren(this.cards.firstChild);
      return;
    }
    if (this.cards.children.length === 1) {
      this.cards.append(card("body", "Body", this.body), card("laws", "Law, forecast and findings", this.laws), card("grip", "Will it hold?", this.grip));
      this.grip.replaceChildren(el("p", {}, "A grip needs a material: one set of parameters for the whole record, ramps and holds."), this.calibrated = calibration([this.subject], this.law, (name) => this.materialMade(name, this)).box, this.gripBox = el("div"));
    }
    // Fields that a person is working in stay as they are.
    if (!this.body.contains(document.activeElement)) this.body.replaceChildren(bodyForm(this.description, this.vocabulary));
    const modes = tests[0].record.phases.filter((phase) => phase.phase === "hold").map((phase) => phase.mode);
    const creeps = modes.includes("force");
    this.creepCard?.remove();
    if (creeps) this.laws.closest("section").after(this.creepCard = card("creep", "Creep", this.creep));
    await this.analyze();
    if (creeps) await this.creeps(modes.every((mode) => mode === "force"));
  }

  // Holds in which the machine held the force have laws of creep.
  async creeps(alone) {
    const made = await into(this.creep, { kind: "creep", subject: this.subject }, (answer, id) => {
      const file = (path) => `api/tasks/${id}/files/${path}`;
      const stem = this.subject.file.replace(/\.[^.]*$/, "");
      return [
        answer.left_out.map(({ reason, hint }) => refusal({ message: reason, hint })),
        drawn(answer.first, "first"),
        el("div", { className: "takeaway", role: "group", "aria-label": "Take away the creep" }, el("a", { href: file("report.html"), target: "_blank", rel: "noopener" }, "Report of the creep"), answer.files.includes("tables.xlsx") && el("a", { href: file("tables.xlsx"), download: `${stem}-creep.xlsx` }, "Workbook"), el("a", { href: file("comparison.json"), download: `${stem}-creep.json` }, "JSON")),
        lines(answer.lines),
      ].flat();
    });
    const lede = this.creep.querySelector(".lede")?.textContent;
    if (made && alone && lede) {
      // The refusal of relaxation names a command for what stands below.
      const help = this.laws.querySelector(":scope > .finding i")?.parentElement;
      if (help) help.textContent = "The displacement is fitted as creep, below.";
      this.answer.replaceChildren(lede);
      say(lede);
    }
  }

  shownRecord({ document: found, figure, draft, guess, notes }, open) {
    const inspected = found.tests[0];
    const folded = (id, title, content, isOpen = false) => el("details", { id, open: isOpen || open.includes(id) }, el("summary", {}, title), content);
    const skipped = found.skipped.length > 0 && el("p", { className: "small" }, `Besides: ${found.skipped.slice(0, 5).map(({ name, reason }) => `${name} (${reason})`).join("; ")}${found.skipped.length > 5 ? ` and ${found.skipped.length - 5} more` : ""}.`);
    if (found.tests.length !== 1) {
      const read = found.tests.find((test) => test.columns.some((column) => column.used_as.length)) ?? found.tests[0];
      return [el("p", {}, `${found.format}, ${found.tests.length} tests.`), skipped, folded("columns", "Columns and units, for all tests", columnTable(this.description, read, this.vocabulary, guess)), folded("text", "Test description, for all tests", textForm(this.description, draft))].filter(Boolean);
    }
    const record = inspected.record;
    const parts = [];
    if (inspected.refused) {
      parts.push(refusal(inspected.refused));
      if (this.description.get("phases", "hold")) parts.push(el("p", { className: "actions" }, button("Detect again", () => this.description.edit([{ key: ["phases", "hold"], value: null }], { alone: true }))));
    }
    if (record && !inspected.refused) {
      const [from, to] = record.time_s;
      const format = found.format.charAt(0).toUpperCase() + found.format.slice(1);
      parts.push(el("p", { className: "small" }, `${format}, ${inspected.rows} rows over ${shown(to - from, 5)} s. Drag the marks at the foot of the figure to move the boundaries of a hold, or type them below.`));
      const phases = figure && new PhaseFigure(figure, record, (holds) => table.commit(holds));
      const table = holdTable(this.description, inspected, phases);
      if (phases) parts.push(phases.box);
      for (const text of [...record.findings, ...notes]) parts.push(el("p", { className: "note-line" }, text));
      if (record.corrections.length) parts.push(el("p", { className: "small" }, `Done: ${record.corrections.join("; ")}.`));
      parts.push(folded("holds", `Holds (${record.phases.filter((one) => one.phase === "hold").length})`, table.box, true));
    }
    const guesses = inspected.columns.flatMap((column) => column.used_as).filter((use) => !use.column_is_stated).length;
    parts.push(folded("columns", guesses ? `Columns and units (${guesses} guessed by name)` : "Columns and units", columnTable(this.description, inspected, this.vocabulary, guess), !record));
    parts.push(folded("text", "Test description as text", textForm(this.description, draft)));
    if (skipped) parts.push(skipped);
    return parts;
  }

  // Of a long record the latency law comes first; the comparison of all laws takes several times as long.
  async analyze() {
    const options = this.rows > LONG ? [{ compare: false }, {}] : [{}];
    for (const one of options) if (!(await this.analyzed(one))) return;
  }

  async analyzed(options) {
    const made = await into(this.laws, { kind: "analyze", subject: this.subject, options }, (answer, id) => {
      const file = (path) => `api/tasks/${id}/files/${path}`;
      const stem = this.subject.file.replace(/\.[^.]*$/, "");
      const report = el("details", { id: "report", ontoggle: () => { if (report.open && !report.querySelector("iframe")) report.append(el("iframe", { src: file("report.html"), title: `Report of ${answer.title}`, sandbox: "allow-scripts allow-popups allow-downloads" })); } }, el("summary", {}, "Whole report"));
      const many = (format) => el("a", { href: `api/tasks/${id}/pictures.zip?format=${format}`, download: `${stem}-figures-${format}.zip` }, `All figures, ${format.toUpperCase()}`);
      const summary = ["pdf", "svg", "png"].map((format) => el("a", { href: file(`figures/summary.${format}`), download: `${stem}-summary.${format}` }, `Figure, ${format.toUpperCase()}`));
      return [
        drawn(answer.first, "first answer"), report,
        el("div", { className: "takeaway", role: "group", "aria-label": "Take away" }, el("a", { href: file("report.html"), download: `${stem}-report.html` }, "Report"), answer.files.includes("tables.xlsx") && el("a", { href: file("tables.xlsx"), download: `${stem}.xlsx` }, "Workbook"), el("a", { href: file("analysis.json"), download: `${stem}.json` }, "JSON"), summary, many("pdf"), this.description.stated.text && button("Test description", () => this.saveText(`${this.subject.file}.test.toml`, this.description.stated.text), { className: "link" })),
        lines(answer.lines),
      ];
    });
    const lede = this.laws.querySelector(".lede")?.textContent ?? "";
    this.answer.replaceChildren(lede);
    this.law.recommend(made?.answer.law);
    if (made) say(lede);
    return made;
  }

  saveText(name, text) {
    const link = el("a", { href: URL.createObjectURL(new Blob([text], { type: "text/plain" })), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  showGrip(panel) {
    this.outdated?.remove();
    this.outdated = null;
    this.gripBox.replaceChildren(panel);
  }

  // A file of several tests: a row each as they are done, a map where they have positions.
  async many() {
    if (this.cards.children.length === 1) this.cards.append(card("body", "Body of all tests", this.body), card("tests", "Tests", this.tests));
    if (!this.body.contains(document.activeElement)) this.body.replaceChildren(bodyForm(this.description, this.vocabulary));
    await testTable(this);
  }
}

const COLUMNS = [
  ["exponent", "n", 1, ""], ["relative_rate_per_s", "Relative rate", 1, "1/s"], ["rate_coefficient_per_s", "v", 1, "1/s"], ["equilibrium_force_n", "Equilibrium force", 1, "N"],
  ["force_start_n", "Force at start", 1, "N"], ["force_end_n", "at end", 1, "N"], ["loading_modulus_pa", "E of loading", 1, "Pa"], ["x_m", "x", 1e6, "µm"], ["y_m", "y", 1e6, "µm"],
];
// Of these the data may leave the value open.
const OF_LAW = new Set(["exponent", "relative_rate_per_s", "rate_coefficient_per_s", "equilibrium_force_n"]);
// More rows than this make pages slow; the table that is taken away has them all.
const MOST_ROWS = 1000;

const testTable = async (study) => {
  const run = (study.tests.run = {});
  const rows = [];
  const [body, head] = [el("tbody"), el("thead")];
  let order = { column: -1, falls: false };
  // The coefficient of forces has a unit that depends on n: it stands beside those of strains alone.
  const has = (first, key) => first?.[key] !== null && first?.[key] !== undefined && (key !== "rate_coefficient_per_s" || first.signal === "strain");
  const columns = () => COLUMNS.filter(([key]) => rows.some(({ first }) => has(first, key)));
  const compared = (a, b) => {
    if (order.column < 0) return a.index - b.index;
    const key = shownColumns[order.column - 1]?.[0];
    const value = ({ first, name }) => (order.column === 0 ? name : has(first, key) ? first[key] : null);
    const [x, y] = [value(a), value(b)];
    const missing = (one) => one === null || one === undefined;
    if (missing(x) || missing(y)) return missing(x) - missing(y);
    return (typeof x === "string" ? x.localeCompare(y, "en", { numeric: true }) : x - y) * (order.falls ? -1 : 1);
  };
  let shownColumns = [];
  const sorter = (text, column, unit) => el("th", { scope: "col", className: column ? "n" : "" }, button(text, () => { order = { column, falls: order.column === column && !order.falls }; lay(); }), unit && el("span", { className: "unit" }, ` (${unit})`));
  const layHead = () => {
    shownColumns = columns();
    rows.forEach((row) => (row.line = null));
    const held = head.contains(document.activeElement) && document.activeElement.textContent;
    head.replaceChildren(el("tr", {}, sorter("Test", 0), el("th", { scope: "col", className: "n" }, "Holds"), shownColumns.map(([, text, , unit], i) => sorter(text, i + 1, unit))));
    if (held) [...head.querySelectorAll("button")].find((one) => one.textContent === held)?.focus({ preventScroll: true });
  };
  // The table in its order; a row is made once for the same columns.
  let laid = -Infinity;
  const lay = () => {
    if (columns().length !== shownColumns.length || !head.firstChild) layHead();
    [...head.querySelectorAll("th:has(button)")].forEach((one, column) => { if (order.column === column) one.setAttribute("aria-sort", order.falls ? "descending" : "ascending"); else one.removeAttribute("aria-sort"); });
    const held = document.activeElement;
    body.replaceChildren(...[...rows].sort(compared).slice(0, MOST_ROWS).map(lineOf));
    if (body.contains(held)) held.focus({ preventScroll: true });
    laid = performance.now();
  };
  // Rows that come go to the end, unless the table is sorted: then it is laid anew, now and then.
  const grow = (fresh) => {
    if (columns().length !== shownColumns.length || !head.firstChild) return lay();
    if (order.column < 0) return body.append(...fresh.slice(0, Math.max(0, MOST_ROWS - body.children.length)).map(lineOf));
    if (performance.now() - laid > 500) lay();
  };
  const lineOf = (row) => (row.line ??= line(row));
  const cell = (first, key, factor) => {
    if (has(first, key)) return shown(first[key] * factor);
    return OF_LAW.has(key) && first?.termination?.endsWith("_at_bound") ? "at bound" : "–";
  };
  const line = ({ name, first, holds, refused }) => el("tr", {},
    el("th", { scope: "row" }, button(name, () => study.opened({ file: study.subject.file, part: name }), { className: "link" })),
    el("td", { className: "n" }, String(holds)),
    refused ? el("td", { colSpan: Math.max(1, shownColumns.length), className: "small" }, refused.message) : shownColumns.map(([key, , factor]) => el("td", { className: "n" }, cell(first, key, factor))));
  const row = (test) => {
    const holds = new Set(test.rows.map(({ hold }) => hold).filter((hold) => hold !== null)).size;
    return { index: test.index, name: test.name ?? `test ${test.index + 1}`, first: test.rows.find(({ recommended }) => recommended === 1) ?? test.rows.find(({ law }) => law === "latency") ?? test.rows[0] ?? null, holds, refused: test.refused };
  };
  let asked = 0;
  let reading = Promise.resolve();
  const read = () => (reading = reading.then(async () => {
    const id = await running.id;
    const fresh = await call("GET", `api/tasks/${id}/rows?from=${asked}`);
    if (study.tests.run !== run || !fresh.length) return;
    asked += fresh.length;
    const made = fresh.map(row);
    rows.push(...made);
    grow(made);
  }));
  const running = task({ kind: "batch", subject: study.subject, options: {} }, { first: true, heard: (brief) => { if (study.tests.run !== run) return; bar.show(brief); if (brief.rows > asked) read(); } });
  const bar = progress(running.cancel);
  const [before, after] = [el("div"), el("div")];
  study.answer.replaceChildren();
  study.tests.replaceChildren(bar, before, el("div", { className: "scroll tall", tabindex: "0", role: "region", "aria-label": "Tests of the file" }, el("table", { id: "each" }, head, body)), after);
  try {
    const { id, answer } = await running.done;
    await read();
    if (study.tests.run !== run) return;
    bar.remove();
    lay();
    before.append(drawn(answer.first, "first"));
    if (answer.refused) before.append(el("p", { className: "note-line" }, `Of ${rows.length} tests ${answer.refused} could not be analysed: their rows say why.`));
    study.answer.replaceChildren(before.querySelector(".lede")?.textContent ?? "");
    say(`${rows.length} tests are analysed. ${study.answer.textContent}`);
    after.append(el("div", { className: "takeaway" }, el("a", { href: `api/tasks/${id}/rows.csv`, download: `${study.subject.file.replace(/\.[^.]*$/, "")}-holds.csv` }, "Table, CSV")), lines(answer.lines));
    if (rows.length > MOST_ROWS) after.prepend(el("p", { className: "small" }, `The first ${MOST_ROWS} of ${rows.length} rows in this order; the table that is taken away has all.`));
    if (answer.quantities.length) after.append(await mapView(id, answer.quantities, answer.shown));
  } catch (error) {
    if (study.tests.run === run && !(error instanceof Lost)) bar.replaceWith(failed(error));
  }
};

const mapView = async (id, quantities, usual) => {
  const [box, wrong] = [el("div"), el("div")];
  const show = async (quantity) => {
    wrong.replaceChildren();
    try {
      const { figure } = await call("GET", `api/tasks/${id}/map?quantity=${encodeURIComponent(quantity)}`);
      box.replaceChildren(drawn(figure));
    } catch (error) { wrong.replaceChildren(refusal(error)); }
  };
  const choice = el("select", { onchange: (event) => show(event.target.value) }, quantities.map((name) => el("option", { value: name, selected: name === usual }, name)));
  await show(usual);
  return el("div", { id: "map" }, el("p", {}, el("label", {}, "Map of ", choice)), box, wrong);
};

// Several records beside each other, or one material of them all.
export const together = (subjects, vocabulary, { opened, materialMade }) => {
  const [compared, calibrated, grip] = [el("div"), el("div"), el("div")];
  const study = { showGrip: (panel) => grip.replaceChildren(panel) };
  const box = el("div", { className: "study" },
    el("div", { className: "study-head" }, el("h2", { className: "title", tabindex: "-1" }, `${subjects.length} records`), el("p", { className: "small" }, subjects.map(({ file }) => file).join(", "))),
    card("compared", "Beside each other", compared),
    card("material", "One material", el("p", {}, "Parameters that the records share are estimated together; the material is that of another specimen of the batch."), calibrated, grip));
  // Of those that count; one that cannot be calibrated is left out by its box.
  const counted = new Set(subjects);
  const law = lawChoice(vocabulary.laws);
  const choice = (subject) => el("li", {}, el("label", { className: "check" }, el("input", { type: "checkbox", checked: true, onchange: (event) => { if (event.target.checked) counted.add(subject); else counted.delete(subject); lay(); } }), subject.file));
  const boxes = el("ul", { className: "counted", "aria-label": "Records that count" }, subjects.map(choice));
  const lay = () => calibrated.replaceChildren(boxes, calibration(subjects.filter((one) => counted.has(one)), law, (name) => materialMade(name, study)).box);
  lay();
  const start = () => into(compared, { kind: "compare", subjects }, (answer, id) => [
    el("iframe", { src: `api/tasks/${id}/files/index.html`, title: "Comparison of the records", sandbox: "allow-scripts allow-popups allow-downloads" }),
    el("div", { className: "takeaway" }, el("a", { href: `api/tasks/${id}/files/index.html`, target: "_blank", rel: "noopener" }, "In a tab of its own"), answer.files.includes("tables.xlsx") && el("a", { href: `api/tasks/${id}/files/tables.xlsx`, download: "comparison.xlsx" }, "Workbook"), answer.files.includes("specimens.json") && el("a", { href: `api/tasks/${id}/files/specimens.json`, download: "specimens.json" }, "JSON")),
    lines(answer.lines),
  ]);
  return { box, start, refresh: () => {} };
};

// A material alone: its grip.
export const materialView = (name) => {
  const grip = el("div");
  const box = el("div", { className: "study" }, el("div", { className: "study-head" }, el("h2", { className: "title", tabindex: "-1" }, name)), card("grip", "Will it hold?", grip));
  return { box, refresh: () => {}, start: async () => { try { grip.replaceChildren(await gripPanel(name)); } catch (error) { if (!(error instanceof Lost)) grip.replaceChildren(refusal(error)); } } };
};
