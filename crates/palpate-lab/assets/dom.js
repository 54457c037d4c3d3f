// Elements of the page. Texts are texts: only what the lab itself has escaped becomes markup.

// An element with attributes, listeners (`onclick`) and children.
export const el = (name, attributes = {}, ...children) => {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key === "className") element.className = value;
    else if (key in element && typeof value !== "string") element[key] = value;
    else element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
};

// Figures and tables that the lab has drawn, alive. Each comes with numbers of its own, which mean nothing beside those of others.
let boxes = 0;
export const drawn = (html, className = "") => {
  const box = el("div", { className });
  box.innerHTML = html;
  boxes += 1;
  box.querySelectorAll("[id]").forEach((one) => (one.id = `box-${boxes}-${one.id}`));
  box.querySelectorAll("[aria-labelledby]").forEach((one) => one.setAttribute("aria-labelledby", `box-${boxes}-${one.getAttribute("aria-labelledby")}`));
  box.querySelectorAll("figcaption > b:first-child, .caption > b:first-child").forEach((one) => one.remove());
  globalThis.palpate.enliven(box);
  return box;
};

export const button = (text, onclick, attributes = {}) => el("button", { type: "button", onclick, ...attributes }, text);

// A number with some digits, as tables write it.
export const shown = (value, digits = 4) => {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const [mantissa, power] = value.toExponential(digits - 1).split("e");
  if (+power < -3 || +power > 5) return `${mantissa}×10${[...String(+power)].map((c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]).join("")}`;
  return value.toPrecision(digits).replace(/e.*/, "").replace("-", "−");
};

export const bytes = (count) => {
  const [value, unit] = count < 1e3 ? [count, "bytes"] : count < 1e6 ? [count / 1e3, "kB"] : count < 1e9 ? [count / 1e6, "MB"] : [count / 1e9, "GB"];
  return `${unit === "bytes" ? value : value.toPrecision(3)} ${unit}`;
};

// Says something to those who do not see the page change.
export const say = (text) => { document.getElementById("said").textContent = text; };

// A text to be copied as it stands.
export const copied = (title, text) => {
  const copy = button("Copy", async () => {
    try {
      await navigator.clipboard.writeText(text);
      copy.textContent = "Copied";
    } catch {
      const range = document.createRange();
      range.selectNodeContents(code);
      getSelection().removeAllRanges();
      getSelection().addRange(range);
      copy.textContent = "Selected";
    }
    setTimeout(() => (copy.textContent = "Copy"), 1500);
  }, { "aria-label": `Copy: ${title}` });
  const code = el("code", {}, text);
  return el("div", { className: "copied" }, el("div", { className: "copied-head" }, el("span", {}, title), copy), el("pre", { tabindex: "0", role: "region", "aria-label": title }, code));
};

// What went wrong, and what helps.
export const refusal = ({ message, hint }) =>
  el("div", { className: "finding warning", role: "group", "aria-label": "Error" }, el("p", {}, el("span", { className: "word" }, "error"), ` ${message}`), hint && el("p", {}, el("i", {}, "What helps: "), hint));

// How far a task is, with a way to end it.
export const progress = (cancel) => {
  const bar = el("progress", { "aria-label": "Progress" });
  const text = el("span");
  const box = el("div", { className: "progress" }, bar, text, cancel && button("Cancel", cancel));
  box.show = ({ state, task, done, total }) => {
    text.textContent = state === "waiting" ? "waiting for other work" : task ?? "";
    if (state === "running" && total) Object.assign(bar, { max: total, value: done });
    else bar.removeAttribute("value");
  };
  return box;
};
