// A record: its figure with the boundaries of holds, its columns, its body; each can be corrected.

import { Lost, call } from "./api.js";
import { button, drawn, el, refusal, say, shown } from "./dom.js";
import { decimal } from "./number.js";

const SECONDS = { s: 1, ms: 1e-3, "µs": 1e-6, min: 60, h: 3600, d: 86400, days: 86400 };
const SVG = "http://www.w3.org/2000/svg";
const make = (name, attributes, parent) => {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  parent.append(element);
  return element;
};

// Corrections are sent one after the other; what is wrong with one is shown where it was made.
export class Description {
  constructor(subject, changed) {
    Object.assign(this, { subject, changed, stated: { name: null, text: "", values: {} } });
  }
  async load() {
    this.stated = await call("POST", "api/described", this.subject);
  }
  async edit(edits, { alone = false, beside } = {}) {
    return this.send(() => call("POST", "api/edit", { subject: this.subject, alone, edits }), beside);
  }
  async replace(text, beside) {
    return this.send(() => call("POST", "api/state", { subject: this.subject, text }), beside);
  }
  async send(request, beside) {
    beside?.replaceChildren();
    try {
      const stated = await request();
      const differs = stated.text !== this.stated.text;
      this.stated = stated;
      if (differs) this.changed();
      return true;
    } catch (error) {
      if (error instanceof Lost) return false;
      (beside ?? document.getElementById("said")).replaceChildren(refusal(error));
      return false;
    }
  }
  get(...key) {
    return key.reduce((table, name) => table?.[name], this.stated.values);
  }
}

// The figure of the phases, with boundaries that can be moved.
export class PhaseFigure {
  constructor(html, record, commit) {
    Object.assign(this, { record, commit, box: drawn(html, "phases") });
    this.holds = record.phases.filter((phase) => phase.phase === "hold").map(({ start_s, end_s }) => [start_s, end_s]);
    this.handles = [];
    const [first, last] = record.time_s;
    const interval = record.sample_interval_s;
    this.decimals = Math.min(12, Math.max(0, 1 - Math.floor(Math.log10(interval || 1))));
    this.step = Math.max(interval, (last - first) / 400);
    for (const figure of this.box.querySelectorAll("figure"))
      for (const drawing of globalThis.palpate.drawings(figure)) this.equip(drawing);
  }

  equip(drawing) {
    drawing.panels.forEach((panel, number) => {
      const factor = SECONDS[panel.x.unit];
      if (!factor) return;
      this.holds.forEach((_, hold) => [0, 1].forEach((end) => this.handle(drawing, panel, factor, hold, end, number === 0)));
    });
    drawing.svg.addEventListener("view", () => this.place());
    this.place();
  }

  handle(drawing, panel, factor, hold, end, reachable) {
    const group = make("g", { class: "handle" }, panel.group);
    if (reachable) {
      const label = `${end ? "End" : "Start"} of hold ${hold + 1}`;
      for (const [key, value] of Object.entries({ tabindex: "0", role: "slider", "aria-label": label, "aria-orientation": "horizontal" })) group.setAttribute(key, value);
      group.addEventListener("keydown", (event) => this.typed(event, hold, end));
      group.addEventListener("blur", () => this.settle());
    } else group.setAttribute("aria-hidden", "true");
    make("rect", { y: panel.top, height: panel.bottom - panel.top, width: 9, class: "grip" }, group);
    make("line", { y1: panel.top, y2: panel.bottom, class: "edge" }, group);
    make("path", { class: "knob" }, group);
    group.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      event.preventDefault();
      event.stopPropagation();
      group.setPointerCapture(event.pointerId);
      // Of marks that lie on each other the nearest is meant, wherever the finger lands.
      const [start] = drawing.place(event);
      const away = (one) => Math.abs(panel.x.shows(panel.x.position(this.holds[one.hold][one.end] / factor)) - start);
      const meant = this.handles.filter((one) => one.panel === panel).sort((a, b) => away(a) - away(b))[0];
      const move = (moved) => {
        const [x] = drawing.place(moved);
        this.move(meant.hold, meant.end, panel.x.value(panel.x.hidden(x)) * factor);
      };
      const up = () => {
        group.removeEventListener("pointermove", move);
        this.settle();
      };
      group.addEventListener("pointermove", move);
      group.addEventListener("pointerup", up, { once: true });
      group.addEventListener("pointercancel", up, { once: true });
    });
    this.handles.push({ group, panel, factor, hold, end });
  }

  typed(event, hold, end) {
    const steps = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 };
    if (event.key === "Enter") return this.settle();
    if (!(event.key in steps)) return;
    event.preventDefault();
    event.stopPropagation();
    const step = event.ctrlKey ? this.record.sample_interval_s : this.step;
    this.move(hold, end, this.holds[hold][end] + steps[event.key] * step * (event.shiftKey ? 10 : 1));
  }

  // A boundary stays within the record and between its neighbours.
  move(hold, end, time) {
    const [first, last] = this.record.time_s;
    const interval = this.record.sample_interval_s;
    const [before, after] = [this.holds[hold - 1]?.[1], this.holds[hold + 1]?.[0]];
    const low = end ? this.holds[hold][0] + 2 * interval : before === undefined ? first : before + interval;
    const high = end ? (after === undefined ? last : after - interval) : this.holds[hold][1] - 2 * interval;
    const within = Math.min(Math.max(time, low), high);
    // The ends of the record are times of samples, which rounding would miss.
    this.holds[hold][end] = within === first || within === last ? within : +within.toFixed(this.decimals);
    this.moved = true;
    this.place();
    this.heard?.(hold);
  }

  settle() {
    if (!this.moved) return;
    this.moved = false;
    this.commit(this.holds);
  }

  place() {
    for (const { group, panel, factor, hold, end } of this.handles) {
      const time = this.holds[hold][end];
      const x = panel.x.shows(panel.x.position(time / factor));
      const seen = x >= panel.left - 0.5 && x <= panel.right + 0.5;
      group.setAttribute("visibility", seen ? "visible" : "hidden");
      group.children[0].setAttribute("x", x - 4.5);
      group.children[1].setAttribute("x1", x);
      group.children[1].setAttribute("x2", x);
      const side = end ? -1 : 1;
      group.children[2].setAttribute("d", `M${x} ${panel.bottom}v-7h${5 * side}l${-5 * side} 7`);
      if (group.hasAttribute("role")) {
        const [first, last] = this.record.time_s;
        for (const [key, value] of Object.entries({ valuemin: first, valuemax: last, valuenow: time, valuetext: `${shown(time, 6)} s` })) group.setAttribute(`aria-${key}`, value);
      }
    }
  }
}

// The time in a description, s: its unit is one of those that the figures have.
const timeOf = (text) => {
  const [, number, unit] = /^\s*([-+.\deE]+)\s*(\S*)/.exec(text) ?? [];
  return Number(number) * (SECONDS[unit] ?? 1);
};
const seconds = (time) => `${String(time)} s`;

// Holds as a table of times.
export const holdTable = (description, inspected, figure) => {
  const record = inspected.record;
  const written = description.get("phases", "hold") ?? [];
  const stated = written.length > 0;
  const wrong = el("div");
  const phases = record.phases.filter((phase) => phase.phase === "hold");
  // The stated hold that each of the record is, with all its keys; they may stand in any order.
  const inOrder = [...written].sort((a, b) => timeOf(a.from) - timeOf(b.from));
  const own = (i) => (inOrder.length === phases.length ? inOrder[i] : undefined) ?? {};
  const kept = (i) => ({ of: i, times: [phases[i].start_s, phases[i].end_s] });
  const all = () => phases.map((_, i) => kept(i));
  const state = (holds) => {
    const value = holds.map(({ of, times }) => {
      const before = of === null ? {} : own(of);
      const time = (key, end) => (before[key] !== undefined && times[end] === kept(of).times[end] ? before[key] : seconds(times[end]));
      return { ...before, from: time("from", 0), to: time("to", 1) };
    });
    return description.edit([{ key: ["phases", "hold"], value: value.length ? value : null }], { alone: true, beside: wrong });
  };
  const rows = phases.map((phase, i) => {
    const input = (end) => el("input", {
      type: "text", inputmode: "decimal", value: String(figure ? figure.holds[i][end] : [phase.start_s, phase.end_s][end]),
      "aria-label": `${end ? "End" : "Start"} of hold ${i + 1}, in seconds`, "data-end": String(end),
      onchange: (event) => {
        const { value: time, wrong: why } = decimal(event.target.value.replace(/s\s*$/, ""));
        event.target.setAttribute("aria-invalid", String(why !== undefined));
        if (why) return wrong.replaceChildren(refusal({ message: `${end ? "End" : "Start"} of hold ${i + 1}, in seconds: ${why}` }));
        const holds = all();
        holds[i].times[end] = time;
        const [field, before] = [event.target, String([phase.start_s, phase.end_s][end])];
        state(holds).then((taken) => { if (!taken) field.value = before; });
      },
    });
    const held = { displacement: "displacement", force: "force", neither: "neither" }[phase.mode] ?? "";
    return el("tr", {},
      el("th", { scope: "row" }, String(i + 1)),
      el("td", {}, input(0)), el("td", {}, input(1)),
      el("td", {}, held, phase.doubtful && el("span", { className: "guess" }, "doubtful")),
      el("td", {}, button("Remove", () => state(all().filter((_, j) => j !== i)), { className: "quiet", "aria-label": `Remove hold ${i + 1}`, disabled: phases.length === 1 })));
  });
  const add = () => {
    // In the widest stretch that no hold takes.
    const [first, last] = record.time_s;
    const ends = [[first, first], ...phases.map((one) => [one.start_s, one.end_s]), [last, last]];
    const gaps = ends.slice(1).map(([start], i) => [ends[i][1], start]);
    const [from, to] = gaps.sort((a, b) => b[1] - b[0] - (a[1] - a[0]))[0];
    const inner = (share) => +(from + share * (to - from)).toPrecision(6);
    const holds = [...all(), { of: null, times: [inner(0.25), inner(0.75)] }].sort((a, b) => a.times[0] - b.times[0]);
    state(holds);
  };
  const table = el("table", { className: "holds-table" },
    el("caption", {}, stated ? "Holds as stated" : "Holds as detected"),
    el("thead", {}, el("tr", {}, ["Hold", "From (s)", "To (s)", "Held", "Change"].map((head) => el("th", { scope: "col" }, head)))),
    el("tbody", {}, rows));
  if (figure) figure.heard = (hold) => [0, 1].forEach((end) => { const field = rows[hold].querySelector(`[data-end="${end}"]`); if (field) field.value = String(figure.holds[hold][end]); });
  return {
    commit: (times) => state(times.map((one, of) => ({ of, times: one }))),
    box: el("div", {}, phases.length ? el("div", { className: "scroll", tabindex: "0", role: "region", "aria-label": "Holds" }, table) : el("p", {}, "No hold was detected. Add one, or state what is a hold by hand."),
      el("p", { className: "actions" }, button("Add a hold", add), stated && button("Detect again", () => description.edit([{ key: ["phases", "hold"], value: null }], { alone: true, beside: wrong }), { className: "quiet" })), wrong),
  };
};

// Columns, what they are used as, and which of that is guessed.
export const columnTable = (description, inspected, vocabulary, guess) => {
  const wrong = el("div");
  const units = new Map(vocabulary.quantities.map(({ name, units: of }) => [name, of]));
  const names = inspected.columns.map((column) => column.name);
  const reference = (column) => (column.name && names.filter((name) => name === column.name).length === 1 ? column.name : column.number);
  const unused = [description.get("columns", "unused") ?? []].flat();
  const isUnused = (column) => unused.some((one) => one === column.number || one === column.name);
  const choices = [...vocabulary.quantities.map(({ name }) => name), "deflection"];
  // What is stated of a column counts too where the file cannot be read yet.
  const stated = (column) => {
    for (const quantity of choices) {
      const of = description.get("columns", quantity);
      if (!of || (of.column !== column.number && of.column !== column.name)) continue;
      return { quantity, role: quantity === "deflection" ? quantity : "values", unit: of.unit ?? column.unit ?? "", sign: of.sign ?? 1, column_is_stated: true, unit_is_stated: of.unit !== undefined };
    }
    return undefined;
  };
  // And what the file suggests, where something is missing to read it.
  const guessed = (column) => {
    if (inspected.columns.some((one) => one.used_as.length)) return undefined;
    for (const quantity of choices) {
      const of = guess?.columns?.[quantity];
      if (!of || description.get("columns", quantity) || (of.column !== column.number && of.column !== column.name)) continue;
      return { quantity, role: "values", unit: of.unit && of.unit !== "?" ? of.unit : column.unit ?? "", sign: 1, column_is_stated: false, unit_is_stated: false };
    }
    return undefined;
  };
  const rows = inspected.columns.map((column) => {
    const used = column.used_as[0] ?? stated(column) ?? guessed(column);
    const quantity = used ? (used.role === "deflection" ? "deflection" : used.role === "values" ? used.quantity : used.role) : "";
    const fixed = used && !["values", "deflection"].includes(used.role);
    const use = el("select", {
      "aria-label": `Use of column ${column.number}`, disabled: fixed,
      onchange: (event) => {
        const chosen = event.target.value;
        const edits = [];
        if (quantity) edits.push({ key: ["columns", quantity], value: null });
        if (chosen) edits.push({ key: ["columns", chosen], value: null }, { key: ["columns", chosen, "column"], value: reference(column) });
        // Without a word its name would be taken for what it is.
        const others = unused.filter((one) => one !== column.number && one !== column.name);
        const left = chosen ? others : [...others, reference(column)];
        if (String(left) !== String(unused)) edits.unshift({ key: ["columns", "unused"], value: left.length ? left : null });
        description.edit(edits, { beside: wrong });
      },
    }, ["", ...choices].map((name) => el("option", { value: name, selected: name === quantity }, name || "not used")), fixed && el("option", { selected: true }, used.role));
    const fieldUnits = units.get(quantity === "deflection" ? "displacement" : quantity) ?? [];
    const unit = used && !fixed && el("select", {
      "aria-label": `Unit of column ${column.number}`,
      onchange: (event) => {
        const edits = [{ key: ["columns", quantity, "unit"], value: event.target.value || null }];
        if (!used.column_is_stated) edits.unshift({ key: ["columns", quantity, "column"], value: reference(column) });
        description.edit(edits, { beside: wrong });
      },
    }, el("option", { value: "", selected: !used.unit_is_stated }, used.unit ? `${used.unit}${used.unit_is_stated ? "" : " (file)"}` : "choose a unit"), fieldUnits.map((name) => el("option", { value: name, selected: used.unit_is_stated && name === used.unit }, name)));
    const sign = used && !fixed && quantity !== "time" && el("label", { className: "check" }, el("input", {
      type: "checkbox", checked: used.sign < 0,
      onchange: (event) => {
        const edits = [{ key: ["columns", quantity, "sign"], value: event.target.checked ? -1 : null }];
        if (!used.column_is_stated) edits.unshift({ key: ["columns", quantity, "column"], value: reference(column) });
        description.edit(edits, { beside: wrong });
      },
    }), "turn sign");
    const guess = used && !used.column_is_stated && used.role === "values" && el("span", {}, el("span", { className: "guess" }, "guessed by name"), " ",
      button("Confirm", () => description.edit([{ key: ["columns", quantity, "column"], value: reference(column) }], { beside: wrong }), { className: "quiet", "aria-label": `Confirm the use of column ${column.number}` }));
    return el("tr", {},
      el("th", { scope: "row" }, String(column.number)), el("td", {}, column.name ?? "(no name)"), el("td", {}, column.unit ?? "–"),
      el("td", { className: "n" }, column.sample), el("td", {}, use), el("td", {}, unit), el("td", {}, sign), el("td", {}, guess || (isUnused(column) && el("span", { className: "small" }, "not used, as stated"))));
  });
  const timed = inspected.columns.some((column) => (column.used_as[0] ?? stated(column) ?? guessed(column))?.quantity === "time");
  const rate = !timed && el("label", {}, "Without a column of time: samples per second ", el("input", {
    type: "text", placeholder: "10 kHz", value: description.get("columns", "time", "rate") ?? "",
    onchange: (event) => {
      const value = event.target.value.trim();
      description.edit([{ key: ["columns", "time", "rate"], value: value === "" ? null : /^[\d.]+$/.test(value) ? `${value} Hz` : value }], { beside: wrong });
    },
  }));
  const machines = el("select", {
    "aria-label": "Machine with known conventions",
    onchange: (event) => description.edit([{ key: ["machine", "preset"], value: event.target.value || null }], { beside: wrong }),
  }, el("option", { value: "" }, "none stated"), vocabulary.machines.map(({ name, about }) => el("option", { value: name, title: about, selected: description.get("machine", "preset") === name }, name)));
  return el("div", {},
    el("div", { className: "scroll", tabindex: "0", role: "region", "aria-label": "Columns" }, el("table", {},
      el("thead", {}, el("tr", {}, ["Column", "Name", "Unit", "First value", "Used as", "Read in", "Sign", "Known"].map((head) => el("th", { scope: "col" }, head)))), el("tbody", {}, rows))),
    rate && el("p", {}, rate), el("p", {}, el("label", {}, "Machine ", machines)), wrong);
};

// A row of two quantities: between them a comma or semicolon; a comma between digits is a decimal one.
const cells = (line) => line.split(/[;\t]|,(?!\d)/).map((cell) => cell.trim());

const EXAMPLES = { radius: "35 mm", diameter: "20 mm", width: "10 mm", thickness: "2 mm", length: "50 mm", area: "100 mm^2", depth: "35 mm", half_angle: "35 deg", cone_angle: "2 deg", modulus: "28 kPa", poisson_ratio: "0.5" };
const ROWS = { widths: "0 mm, 12.5 mm\n12 mm, 4 mm\n37 mm, 4 mm\n49 mm, 12.5 mm", areas: "0 mm, 0 mm^2\n1 mm, 40 mm^2\n4 mm, 90 mm^2" };
const title = (key) => (key.charAt(0).toUpperCase() + key.slice(1)).replace(/_/g, " ").replace("Poisson ratio", "Poisson's ratio");

// The body: its shape, its sizes, and how the jaw meets it.
export const bodyForm = (description, vocabulary) => {
  const wrong = el("div", { "aria-live": "polite" });
  const specimen = description.get("specimen") ?? {};
  const about = vocabulary.schema.$defs.Specimen.properties;
  const shapes = vocabulary.schema.$defs.ShapeName.oneOf;
  const fields = el("div", { className: "fields" });
  const shape = el("select", { id: "shape", onchange: () => { lay(); commit(); } }, el("option", { value: "" }, "not stated: forces alone are analysed"), vocabulary.shapes.filter(({ name }) => name !== "none").map(({ name }) => el("option", { value: name, selected: (description.pending?.shape ?? specimen.shape) === name }, name)));
  // What was typed and could not be taken yet stays through other changes.
  const values = { ...specimen, ...description.pending?.values };
  const of = () => vocabulary.shapes.find(({ name }) => name === shape.value);
  const keys = () => (of() ? [...of().sizes, ...of().optional, "modulus", ...(of().is_tip || specimen.equilibrium === "hertz" ? ["poisson_ratio"] : [])] : []);
  const needed = (key) => of().sizes.includes(key) || (key === "poisson_ratio" && of().is_tip);
  const text = (key, value) => (Array.isArray(value) ? value.map((row) => row.join(", ")).join("\n") : value ?? "");

  function lay() {
    const known = shapes.find((one) => one.const === shape.value)?.description;
    fields.replaceChildren(known ? el("p", { className: "small" }, known) : "");
    for (const key of keys()) {
      const id = `size-${key}`;
      const change = (event) => { values[key] = event.target.value.trim(); commit(key); };
      let field = null;
      if (key === "base") field = el("select", { id, onchange: change }, ["", "bonded", "sliding"].map((name) => el("option", { value: name, selected: values.base === name }, name || "bonded (default)")));
      else if (ROWS[key]) field = el("textarea", { id, rows: 4, placeholder: ROWS[key], onchange: change }, text(key, values[key]));
      else field = el("input", { id, type: "text", autocomplete: "off", placeholder: EXAMPLES[key] ?? "", value: String(text(key, values[key])), onchange: change });
      const meaning = (about[key]?.description ?? "").split(". ")[0];
      fields.append(el("div", { className: "field" }, el("label", { for: id }, title(key), needed(key) ? "" : el("span", { className: "small" }, " optional")), field, el("span", { className: "small" }, ROWS[key] ? `${meaning} One row a line.` : meaning)));
    }
  }

  async function commit(changed) {
    const chosen = of();
    wrong.replaceChildren();
    description.pending = { shape: shape.value, values: { ...values } };
    const taken = (done) => { if (done) description.pending = null; };
    if (!chosen) return taken(await description.edit([{ key: ["specimen"], value: null }], { beside: wrong }));
    const missing = keys().filter((key) => needed(key) && !values[key]);
    const until = description.get("specimen") ? " Until then the body that is stated counts." : "";
    if (missing.length) return wrong.replaceChildren(el("p", { className: "note-line" }, `Needed for a ${chosen.name}: ${missing.map((key) => title(key).toLowerCase()).join(", ")}, with a unit such as “${EXAMPLES[missing[0]] ?? "35 mm"}”.${until}`));
    const wanted = new Map([["shape", chosen.name]]);
    for (const key of keys()) {
      const value = values[key];
      if (value === undefined || value === "") continue;
      if (key === "poisson_ratio" && decimal(String(value)).wrong) return wrong.replaceChildren(refusal({ message: `Poisson's ratio is a number from 0 to 0.5, found “${value}”` }));
      if (ROWS[key]) wanted.set(key, Array.isArray(value) ? value : value.split("\n").filter((line) => line.trim()).map(cells));
      else wanted.set(key, key === "poisson_ratio" ? decimal(String(value)).value : value);
    }
    // Of a body that is stated only what was changed here: another page may have changed the rest.
    if (changed && description.get("specimen", "shape") === chosen.name) return taken(await description.edit([{ key: ["specimen", changed], value: wanted.get(changed) ?? null }], { beside: wrong }));
    const old = Object.keys(description.get("specimen") ?? {}).filter((key) => !wanted.has(key) && key !== "equilibrium");
    return taken(await description.edit([...old.map((key) => ({ key: ["specimen", key], value: null })), ...[...wanted].map(([key, value]) => ({ key: ["specimen", key], value }))], { beside: wrong }));
  }

  const contact = (key, label, choices) => el("div", { className: "field" }, el("label", { for: `contact-${key}` }, label),
    el("select", { id: `contact-${key}`, onchange: (event) => description.edit([{ key: ["contact", key], value: event.target.value || null }], { beside: wrong }) },
      choices.map(([value, name]) => el("option", { value, selected: (description.get("contact", key) ?? "") === value }, name))));
  lay();
  return el("div", {},
    el("div", { className: "field" }, el("label", { for: "shape" }, "Shape"), shape), fields,
    el("div", { className: "fields" },
      contact("squeezed_from", "Squeezed from", [["", "by shape (default)"], ["two sides", "two sides"], ["one side", "one side"]]),
      contact("touch", "First touch", [["", "by shape (default)"], ["auto", "estimated"], ["as recorded", "as recorded"], ["threshold", "threshold"], ["loading curve", "loading curve"], ["two lines", "two lines"], ["hertz", "Hertz"], ["ratio of variances", "ratio of variances"]])),
    wrong);
};

// The description as text, for what has no field.
export const textForm = (description, draft) => {
  const wrong = el("div");
  const area = el("textarea", { className: "toml", rows: 14, spellcheck: "false", "aria-label": "Test description", oninput: () => { description.unsent = area.value; } }, description.unsent ?? description.stated.text);
  const apply = async () => { if (await description.replace(area.value, wrong)) description.unsent = null; };
  return el("div", {}, area,
    el("p", { className: "actions" }, button("Apply", apply), draft && button("Insert the draft of the file", () => { area.value = draft; description.unsent = draft; say("The draft stands in the text; Apply takes it."); }, { className: "quiet" }),
      description.stated.name && el("span", { className: "small" }, `${description.stated.name}`), typeof description.unsent === "string" && el("span", { className: "small" }, "Not applied yet.")), wrong);
};
