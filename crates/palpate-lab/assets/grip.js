// Will it hold: a calibration, and sliders over the grip of its material.

import { Cancelled, Lost, Refused, call, task } from "./api.js";
import { button, copied, drawn, el, progress, refusal, say, shown } from "./dom.js";
import { decimal } from "./number.js";

// The law of a material, the usual one first. What a person has chosen stays; before that it is the one that the analysis recommends.
export const lawChoice = (laws) => {
  const why = el("span", { className: "small", id: "law-why" });
  const select = el("select", { "aria-describedby": why.id, onchange: () => (isChosen = true) });
  let isChosen = false;
  const lay = (names, chosen) => select.replaceChildren(...names.map((name) => el("option", { value: name, selected: name === chosen }, name)));
  lay(laws, laws[0]);
  const recommend = (law) => {
    const { recommended, calibrated } = law ?? {};
    // A law that is recommended may be none of the usual ones, with one term for instance.
    const names = [...new Set([...laws, ...[calibrated, isChosen ? select.value : null].filter(Boolean)])];
    lay(names, isChosen ? select.value : calibrated ?? laws[0]);
    if (!recommended) why.textContent = "";
    else if (!calibrated) why.textContent = `The analysis recommends ${recommended}, which cannot be calibrated.`;
    else if (calibrated !== recommended) why.textContent = `The analysis recommends ${recommended}; ${calibrated} estimates its n with an interval.`;
    else why.textContent = `The analysis recommends ${recommended}.`;
  };
  return { box: el("p", { className: "actions" }, el("label", {}, "Law of the material ", select), why), value: () => select.value, recommend };
};

// A material of one record, or of several together.
export const calibration = (subjects, law, made) => {
  const box = el("div");
  const result = el("div", { "aria-live": "polite" });
  const begin = async () => {
    const running = task({ kind: "calibrate", subjects, options: { law: law.value() } }, { first: true, heard: (brief) => bar.show(brief) });
    const bar = progress(running.cancel);
    result.replaceChildren(bar);
    try {
      const { id, answer } = await running.done;
      result.replaceChildren(
        answer.material ? el("p", {}, "Material written: ", el("b", {}, answer.material)) : refusal({ message: "no material can be made of it: the remarks say why" }),
        el("ul", { className: "remarks" }, answer.remarks.map((remark) => el("li", {}, remark))),
        answer.figure ? drawn(answer.figure) : "",
        el("details", {}, el("summary", {}, "Parameters"), el("pre", { tabindex: "0" }, answer.text)),
        el("p", { className: "takeaway" }, el("a", { href: `api/tasks/${id}/files/calibration.json`, download: `${subjects[0].file.replace(/\.[^.]*$/, "")}-calibration.json` }, "Calibration, JSON")),
        lines(answer.lines));
      if (answer.material) {
        say(`Material written: ${answer.material}`);
        made(answer.material);
      }
    } catch (error) {
      if (error instanceof Lost) return;
      result.replaceChildren(error instanceof Cancelled ? el("p", {}, "Cancelled.") : refusal(error));
      const bad = subjects.filter(({ file }) => subjects.length > 1 && error.message?.includes(file)).map(({ file }) => file);
      if (bad.length) result.append(el("p", { className: "note-line" }, `Correct what is stated of ${bad.join(", ")}, or leave it out by its box above.`));
    }
  };
  box.append(law.box, el("p", { className: "actions" }, button(subjects.length > 1 ? `Calibrate ${subjects.length} records together` : "Calibrate on the whole record", begin, { disabled: !subjects.length })), result);
  return { box, begin };
};

export const lines = (of) => of && el("details", { className: "lines" }, el("summary", {}, "The same on the command line and in Python"),
  el("p", { className: "small" }, "To be run in the folder of the records."), of.shell ? copied("Command line", of.shell) : el("p", { className: "small" }, "One command cannot do it: the records have descriptions of their own."), copied("Python", of.python));

// A slider with a field for its value; of several decades by its logarithm.
const slider = ({ id, label, unit, low, high, value, log = false, scale = 1, digits = 3, most = Infinity }, moved) => {
  const STEPS = 1000;
  const to = (x) => (log ? (Math.log(x / low) / Math.log(high / low)) * STEPS : ((x - low) / (high - low)) * STEPS);
  const from = (step) => (log ? low * (high / low) ** (step / STEPS) : low + (step / STEPS) * (high - low));
  const state = { value };
  const text = (shownDigits = digits) => String(+(state.value * scale).toPrecision(shownDigits));
  const wrong = el("span", { className: "wrong", id: `${id}-wrong`, role: "alert" });
  const range = el("input", { type: "range", id, min: "0", max: String(STEPS), step: "1", value: String(to(value)), oninput: () => { set(+from(+range.value).toPrecision(digits), range); moved(); } });
  const field = el("input", { type: "text", inputmode: "decimal", "aria-label": `${label}, ${unit || "number"}`, value: text(), "aria-describedby": wrong.id, onchange: () => {
    const typed = decimal(field.value);
    const found = typed.value / scale;
    const fits = Number.isFinite(found) && found > 0 && found < most;
    if (!fits) return refuse(typed.wrong ?? `expected a number above 0${Number.isFinite(most) ? ` and below ${most * scale}` : ""}`);
    set(found, field);
    return moved();
  } });
  // The answer stays that of the value before: the field says so.
  const refuse = (why) => {
    field.setAttribute("aria-invalid", "true");
    wrong.textContent = `${why}. The answer is that of ${[text(), unit].join(" ").trim()}.`;
  };
  const set = (found, by) => {
    state.value = found;
    if (by !== range) range.value = String(to(found));
    // What was typed stands as it was read.
    field.value = by === field ? text(12) : text();
    field.removeAttribute("aria-invalid");
    wrong.textContent = "";
    range.setAttribute("aria-valuetext", `${text()} ${unit}`);
  };
  set(value, null);
  return { state, set: (found) => set(found, null), box: el("div", { className: "slider" }, el("label", { for: id }, label), range, el("span", { className: "value" }, field, el("span", { className: "unit" }, unit)), wrong) };
};

// Sliders of mass, friction, time and squeeze; verdict, probability and band follow.
export const gripPanel = async (material) => {
  const range = await call("GET", `api/materials/${encodeURIComponent(material)}`);
  const friction = 0.6;
  // A load that half of the force of the test carries.
  const mass = +Math.max(1e-6, (0.5 * range.largest_force_n * 2 * friction) / 9.80665 / 2).toPrecision(2);
  const verdict = el("p", { className: "verdict", role: "status" });
  const misfit = el("p", { className: "note-line against", role: "status", hidden: true });
  const figure = el("div", { className: "try-figure" });
  const facts = el("p", { className: "small" });
  const line = el("div");
  const plan = el("div", { "aria-live": "polite" });
  const sliders = {
    mass_kg: slider({ id: "grip-mass", label: "Mass", unit: mass < 1 ? "g" : "kg", scale: mass < 1 ? 1e3 : 1, low: mass / 30, high: mass * 10, value: mass, log: true }, () => moved()),
    friction: slider({ id: "grip-friction", label: "Friction μ", unit: "", low: 0.05, high: 1.5, value: friction, digits: 3 }, () => moved()),
    hold_s: slider({ id: "grip-hold", label: "Hold", unit: "s", low: 0.1, high: Math.max(1e4, 100 * range.longest_hold_s), value: 60, log: true }, () => moved()),
    squeeze_m: slider({ id: "grip-squeeze", label: "Squeeze", unit: range.deepest_m < 1e-4 ? "µm" : "mm", scale: range.deepest_m < 1e-4 ? 1e6 : 1e3, low: range.deepest_m / 50, high: 1.3 * range.deepest_m, value: +(0.6 * range.deepest_m).toPrecision(2), digits: 4 }, () => moved()),
    confidence: slider({ id: "grip-confidence", label: "Required probability", unit: "%", scale: 100, low: 0.5, high: 0.999, value: 0.95, digits: 3, most: 1 }, () => moved()),
  };
  const options = () => Object.fromEntries(Object.entries(sliders).map(([key, { state }]) => [key, state.value]));
  let [busy, again, open] = [false, false, false];
  // One question at a time; the last of those that came meanwhile is asked next.
  const moved = async () => {
    if (plan.firstChild) plan.classList.add("before");
    if (busy) return (again = true);
    busy = true;
    try {
      do {
        again = false;
        const found = await call("POST", `api/try/${encodeURIComponent(material)}`, options());
        show(found);
        await new Promise((resolve) => requestAnimationFrame(resolve));
      } while (again);
    } catch (error) {
      if (error instanceof Refused) {
        verdict.className = "verdict unknown";
        verdict.textContent = error.message;
        facts.textContent = error.hint ?? "";
        figure.replaceChildren();
        // The lines of the answer before would belong to another grip.
        open = line.firstChild?.open ?? open;
        line.replaceChildren();
      }
    } finally { busy = false; }
    if (again) moved();
  };
  const show = (found) => {
    // A yes by a law that the record contradicts is none to rely on.
    const isOpen = found.holds === null || (found.holds && found.misfit);
    verdict.className = `verdict ${isOpen ? "unknown" : found.holds ? "yes" : "no"}`;
    verdict.textContent = found.verdict;
    // What is against the law is of the material, whatever the sliders are set to: it is read out once.
    misfit.hidden = !found.misfit;
    if (misfit.textContent !== (found.misfit ?? "")) misfit.textContent = found.misfit ?? "";
    const [low, high] = found.end_force_interval_n ?? [NaN, NaN];
    facts.textContent = `Force at the end ${shown(found.end_force_n)} N (${shown(100 * found.confidence, 2)} % interval ${shown(low)} to ${shown(high)} N); needed ${shown(found.needed_force_n)} N; when the jaws stop ${shown(found.start_force_n)} N. ${found.extrapolations.map((one) => `Beyond the test: ${one}.`).join(" ")}`;
    figure.replaceChildren(drawn(found.figure));
    open = line.firstChild?.open ?? open;
    line.replaceChildren(lines(found.lines));
    line.firstChild.open = open;
    document.dispatchEvent(new CustomEvent("tried", { detail: found }));
  };
  const ask = async (least) => {
    const asked = options();
    if (least) delete asked.squeeze_m;
    const running = task({ kind: "grip", material, options: asked }, { first: true, heard: (brief) => bar.show(brief) });
    const bar = progress(running.cancel);
    plan.replaceChildren(bar);
    try {
      const { id, answer } = await running.done;
      if (least && answer.squeeze_m) {
        sliders.squeeze_m.set(Math.ceil(answer.squeeze_m * 1e7) / 1e7);
        await moved();
      }
      plan.classList.remove("before");
      const other = least && !answer.squeeze_m && el("p", { className: "note-line" }, "For this load the least squeeze belongs to another motion, stated below; the slider stays where it is.");
      plan.replaceChildren(other || "", el("p", {}, el("b", {}, answer.verdict)), answer.figure ? drawn(answer.figure) : "", el("ul", {}, answer.remarks.map((remark) => el("li", {}, remark))),
        el("p", { className: "takeaway" }, el("a", { href: `api/tasks/${id}/files/report.html`, target: "_blank", rel: "noopener" }, "Report of the grip"), el("a", { href: `api/tasks/${id}/files/tables.xlsx`, download: "grip.xlsx" }, "Workbook"), el("a", { href: `api/tasks/${id}/files/grip.json`, download: "grip.json" }, "JSON")));
      say(answer.verdict);
    } catch (error) {
      if (error instanceof Lost) return;
      plan.replaceChildren(error instanceof Cancelled ? el("p", {}, "Cancelled.") : refusal(error));
    }
  };
  const box = el("div", { className: "grip-panel" },
    el("div", { className: "sliders" }, Object.values(sliders).map(({ box: one }) => one), el("p", { className: "actions" }, button("Least squeeze that holds", () => ask(true)), button("Whole answer for this squeeze", () => ask(false), { className: "quiet" }))),
    el("div", { className: "tried" }, misfit, verdict, facts, figure), el("div", { className: "wide-cell" }, line, plan));
  await moved();
  return box;
};
