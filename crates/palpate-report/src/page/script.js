"use strict";
// Readings, zooms, switches and sorting for the figures and tables of a page. The page is complete without it. A page whose content
// changes calls `palpate.enliven` with what is new, and gets the drawings of a figure by `palpate.drawings`.
(() => {
  const SVG = "http://www.w3.org/2000/svg";
  document.documentElement.classList.add("live");
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];
  const make = (name, attributes, parent) => {
    const element = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    parent?.append(element);
    return element;
  };
  const html = (name, text = "", className = "") => Object.assign(document.createElement(name), { textContent: text, className });
  const superscript = (power) => String(power).replace("-", "⁻").replace(/\d/g, (digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit]);

  // A number with four significant digits, as tables write it.
  const shown = (value) => {
    const [mantissa, power] = value.toExponential(3).split("e");
    const text = power < -3 || power > 5 ? `${mantissa}×10${superscript(+power)}` : value.toPrecision(4).replace(/e.*/, "");
    return (power === "+4" || power === "+5" ? value.toFixed(0) : text).replace("-", "−");
  };

  // One axis of a panel: positions are points of the drawing, and zooms change its view of them.
  class Axis {
    constructor(panel, along, start, end) {
      const [scale, low, high, exponent, labelled] = panel.dataset[along].split(" ");
      Object.assign(this, { key: along + panel.dataset[along], start, end, exponent: +exponent, labelled: labelled === "1" });
      this.log = scale === "log";
      this.name = panel.dataset[`${along}Name`];
      this.unit = panel.dataset[`${along}Unit`];
      this.low = this.stretch(+low);
      this.high = this.stretch(+high);
      this.view = [start, end];
    }
    stretch(value) { return this.log ? Math.log10(value) : value; }
    // From a position of the unzoomed drawing to the value there, to the place where it is shown, and back.
    value(position) {
      const along = this.low + ((position - this.start) / (this.end - this.start)) * (this.high - this.low);
      return this.log ? 10 ** along : along;
    }
    position(value) {
      return this.start + ((this.stretch(value) - this.low) / (this.high - this.low)) * (this.end - this.start);
    }
    shows(position) { return this.start + ((position - this.view[0]) / (this.view[1] - this.view[0])) * (this.end - this.start); }
    hidden(place) { return this.view[0] + ((place - this.start) / (this.end - this.start)) * (this.view[1] - this.view[0]); }
    get zoomed() { return this.view[0] !== this.start || this.view[1] !== this.end; }
    reading(position) { return `${shown(this.value(position))} ${this.unit}`.trim(); }

    // Round values within the view with their labels, about so many.
    ticks(count) {
      const [low, high] = [this.value(this.view[0]), this.value(this.view[1])];
      if (this.log && high / low > 4) {
        const [first, last] = [Math.floor(Math.log10(low)), Math.ceil(Math.log10(high))];
        const of = (mantissas, every) => {
          const values = [];
          for (let power = first; power <= last; power++)
            if (power % every === 0) mantissas.forEach((m) => values.push(+`${m}e${power}`));
          return values.filter((value) => value >= low && value <= high);
        };
        const every = Math.max(1, Math.ceil((last - first) / count));
        const choices = [of([1, 2, 5], 1), of([1, 3], 1), of([1], 1), of([1], every)];
        const values = choices.find((found) => found.length <= count + 1) ?? choices[3];
        const plain = first >= -3 && last <= 5;
        const label = (value) => (plain ? String(value) : value.toExponential(0).replace(/e\+?/, "×10").replace(/×10(.*)/, (_, p) => `×10${superscript(p)}`).replace(/^1×/, ""));
        if (values.length > 1) return values.map((value) => [value, label(value)]);
      }
      const rough = (high - low) / count;
      const order = Math.floor(Math.log10(rough));
      const step = [1, 2, 5, 10].find((m) => m * 10 ** order >= rough) * 10 ** order;
      const decimals = Math.max(0, this.exponent - Math.floor(Math.log10(step) + 1e-9));
      const values = [];
      for (let i = Math.ceil(low / step); i * step <= high && values.length < 50; i++) values.push(i * step);
      return values.map((value) => [value, (value / 10 ** this.exponent).toFixed(Math.min(decimals, 12)).replace("-", "−")]);
    }
  }

  // A path as pieces of a letter with its numbers; dots in tenths become positions as others have them.
  const parsed = (path) => {
    const pieces = (path.getAttribute("d").match(/[a-zA-Z][^a-zA-Z]*/g) ?? []).map((piece) => [
      piece[0],
      (piece.slice(1).match(/-?(?:\d+\.?\d*|\.\d+)/g) ?? []).map(Number),
    ]);
    if (!path.hasAttribute("transform")) return pieces;
    let [x, y] = [0, 0];
    return pieces.map(([letter, [dx, dy]]) => {
      if (letter !== "m") return [letter, [0]];
      [x, y] = [x + dx, y + dy];
      return ["M", [x / 10, y / 10]];
    });
  };

  class Series {
    constructor(group) {
      this.group = group;
      this.label = group.dataset.series;
      this.points = group.classList.contains("points");
      this.line = group.classList.contains("line");
      this.paths = all("path", group).map((path) => ({ path, attributes: Object.fromEntries([...path.attributes].map((a) => [a.name, a.value])), pieces: parsed(path) }));
    }
    get visible() { return !this.group.classList.contains("series-off"); }
    get colour() {
      const { stroke, fill } = this.paths[0]?.attributes ?? {};
      return stroke ?? fill;
    }
    // Runs of positions: of a line each unbroken stretch, of points each alone.
    get runs() {
      return (this.cached ??= this.paths.flatMap(({ pieces }) => {
        const runs = [];
        // Error bars are no points.
        if (this.points && pieces.some(([letter]) => letter === "V")) return [];
        for (const [letter, numbers] of pieces) {
          if (letter === "M") runs.push([]);
          if (letter === "M" || letter === "L") for (let i = 0; i + 1 < numbers.length; i += 2) runs.at(-1).push([numbers[i], numbers[i + 1]]);
        }
        return runs;
      }));
    }
    // The position of it that is nearest to a place: of a line at that x, of points the closest.
    near(x, y) {
      let best = null;
      const take = (px, py, away) => { if (!best || away < best.away) best = { x: px, y: py, away, series: this }; };
      for (const run of this.runs) {
        if (this.points) run.forEach(([px, py]) => take(px, py, Math.abs(px - x) + 0.2 * Math.abs(py - y)));
        else
          for (let i = 1; i < run.length; i++) {
            const [[ax, ay], [bx, by]] = [run[i - 1], run[i]];
            if (Math.min(ax, bx) > x || Math.max(ax, bx) < x) continue;
            const py = ax === bx ? Math.min(Math.max(y, Math.min(ay, by)), Math.max(ay, by)) : ay + ((x - ax) / (bx - ax)) * (by - ay);
            take(x, py, Math.abs(py - y));
          }
      }
      return best;
    }
    draw(panel) {
      const { x, y } = panel;
      for (const { path, attributes, pieces } of this.paths) {
        if (!panel.zoomed) {
          Object.entries(attributes).forEach(([name, value]) => path.setAttribute(name, value));
          continue;
        }
        let [d, skips] = ["", false];
        for (const [letter, numbers] of pieces) {
          let moved = numbers;
          if (letter === "M" || letter === "L") moved = numbers.map((n, i) => (i % 2 ? y.shows(n) : x.shows(n)));
          if (letter === "H") moved = numbers.map((n) => x.shows(n));
          if (letter === "V") moved = numbers.map((n) => y.shows(n));
          // What is no line is not clipped: it goes where its centre does.
          if (letter === "M" && this.points) skips = !panel.contains(moved[0], moved[1]);
          if (!skips) d += letter + moved.map((n) => +n.toFixed(2)).join(" ");
        }
        path.setAttribute("d", d);
        if (attributes.transform) {
          path.removeAttribute("transform");
          path.setAttribute("stroke-width", attributes["stroke-width"] / 10);
        }
      }
    }
  }

  class Panel {
    constructor(group) {
      const [left, top, width, height] = group.dataset.area.split(" ").map(Number);
      Object.assign(this, { group, left, top, right: left + width, bottom: top + height });
      this.x = new Axis(group, "x", left, this.right);
      this.y = new Axis(group, "y", this.bottom, top);
      this.series = all(".line, .points, .band, .mark", group).map((one) => new Series(one));
      this.images = all("image", group);
      this.cursor = make("g", { "pointer-events": "none" }, group);
      // Somewhere to point at between the marks.
      group.prepend(make("rect", { x: left, y: top, width, height, fill: "#fff", "fill-opacity": 0 }));
    }
    contains(x, y) { return x >= this.left - 0.5 && x <= this.right + 0.5 && y >= this.top - 0.5 && y <= this.bottom + 0.5; }
    get zoomed() { return this.x.zoomed || this.y.zoomed; }

    draw() {
      this.series.forEach((one) => one.draw(this));
      for (const image of this.images) {
        const place = (axis) => axis.view.map((end, i) => axis.shows([axis.start, axis.end][i]));
        const [[x0, x1], [y1, y0]] = [place(this.x), place(this.y)];
        Object.entries({ x: x0, y: y0, width: x1 - x0, height: y1 - y0 }).forEach(([name, value]) => image.setAttribute(name, value));
      }
      this.group.classList.toggle("zoomed", this.zoomed);
      all(".fresh", this.group).forEach((old) => old.remove());
      if (!this.zoomed) return;
      const ticks = make("g", { class: "ticks fresh", fill: "#222", "font-size": 7 });
      let d = "";
      for (const [value, label] of this.x.ticks(Math.min(9, Math.max(2, (this.right - this.left) / 38)))) {
        const place = this.x.shows(this.x.position(value));
        d += `M${place} ${this.bottom}v3`;
        if (this.x.labelled) make("text", { x: place, y: this.bottom + 10.46, "text-anchor": "middle" }, ticks).textContent = label;
      }
      for (const [value, label] of this.y.ticks(Math.min(8, Math.max(2, (this.bottom - this.top) / 15)))) {
        const place = this.y.shows(this.y.position(value));
        d += `M${this.left} ${place}h-3`;
        make("text", { x: this.left - 5, y: place + 2.52, "text-anchor": "end" }, ticks).textContent = label;
      }
      make("path", { d, stroke: "#222", "stroke-width": 0.6, fill: "none" }, ticks);
      this.group.prepend(ticks);
    }

    // What is read at a place of the drawing, shown in the panel.
    read(placeX, placeY) {
      this.cursor.replaceChildren();
      const [x, y] = [this.x.hidden(placeX), this.y.hidden(placeY)];
      const drawn = this.series.filter((one) => one.visible && (one.points || one.line));
      const points = drawn.filter((one) => one.points).map((one) => one.near(x, y)).filter(Boolean);
      const nearest = points.sort((a, b) => a.away - b.away)[0];
      const scale = (this.x.end - this.x.start) / (this.x.view[1] - this.x.view[0]);
      const at = nearest && Math.abs(nearest.x - x) * scale < 8 ? nearest.x : x;
      const found = drawn.map((one) => one.near(at, y)).filter((one) => one && Math.abs(one.x - at) * scale < 3);
      const place = this.x.shows(at);
      make("path", { d: `M${place} ${this.top}V${this.bottom}`, stroke: "#777", "stroke-width": 0.5 }, this.cursor);
      for (const one of found) {
        const [cx, cy] = [this.x.shows(one.x), this.y.shows(one.y)];
        if (this.contains(cx, cy)) make("circle", { cx, cy, r: 2.2, fill: "#fff", stroke: one.series.colour, "stroke-width": 1.2 }, this.cursor);
      }
      return { at, found };
    }
  }

  // The label with what is read, one for the page.
  const label = html("div", "", "reading");
  label.setAttribute("role", "status");
  label.hidden = true;
  document.body.append(label);

  class Drawing {
    constructor(svg, figure) {
      Object.assign(this, { svg, figure });
      this.panels = all(".panel", svg).map((group) => new Panel(group));
      svg.addEventListener("pointermove", (event) => this.moved(event));
      svg.addEventListener("pointerleave", () => this.drag || this.silent());
      svg.addEventListener("pointerdown", (event) => this.pressed(event));
      svg.addEventListener("pointerup", (event) => this.released(event));
      svg.addEventListener("pointercancel", () => this.dropped());
      svg.addEventListener("dblclick", () => this.reset());
      svg.addEventListener("keydown", (event) => this.typed(event));
      svg.addEventListener("blur", () => this.silent());
    }
    place(event) {
      const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.svg.getScreenCTM().inverse());
      return [point.x, point.y];
    }
    silent() {
      label.hidden = true;
      this.panels.forEach((panel) => panel.cursor.replaceChildren());
    }
    tell(panel, x, y) {
      this.silent();
      this.here = [panel, x, y];
      const { at, found } = panel.read(x, y);
      const row = (name, value, colour) => {
        const line = html("div");
        const of = html("span", name, colour ? "of" : "");
        if (colour) of.style.borderColor = colour;
        line.append(of, html("b", value));
        return line;
      };
      label.replaceChildren(row(panel.x.name, panel.x.reading(at)));
      for (const one of found) label.append(row(one.series.label ?? panel.y.name, panel.y.reading(one.y), one.series.colour));
      label.hidden = false;
      const end = new DOMPoint(panel.x.shows(at), panel.top).matrixTransform(this.svg.getScreenCTM());
      const room = document.documentElement.clientWidth;
      const left = end.x + 12 + label.offsetWidth > room ? end.x - 12 - label.offsetWidth : end.x + 12;
      label.style.left = `${Math.max(4, left) + scrollX}px`;
      label.style.top = `${end.y + scrollY + 6}px`;
    }
    moved(event) {
      const [x, y] = this.place(event);
      if (this.drag) return this.stretched(x, y);
      const panel = this.panels.find((one) => one.contains(x, y));
      if (panel) this.tell(panel, x, y);
      else this.silent();
    }
    pressed(event) {
      const [x, y] = this.place(event);
      const panel = this.panels.find((one) => one.contains(x, y));
      if (!panel || event.button !== 0 || event.target.closest(".entry, .handle")) return;
      this.drag = { panel, x, y, box: make("rect", { class: "selection", "pointer-events": "none" }, panel.group), area: null };
      this.svg.setPointerCapture(event.pointerId);
    }
    // A thin selection is one along a single axis.
    stretched(x, y) {
      const { panel, box, x: fromX, y: fromY } = this.drag;
      const inside = (value, low, high) => Math.min(Math.max(value, low), high);
      let [x0, x1] = [fromX, inside(x, panel.left, panel.right)].sort((a, b) => a - b);
      let [y0, y1] = [fromY, inside(y, panel.top, panel.bottom)].sort((a, b) => a - b);
      if (x1 - x0 < 6 && y1 - y0 < 6) this.drag.area = null;
      else {
        if (y1 - y0 < 10) [y0, y1] = [panel.top, panel.bottom];
        else if (x1 - x0 < 10) [x0, x1] = [panel.left, panel.right];
        this.drag.area = [x0, x1, y0, y1];
        Object.entries({ x: x0, y: y0, width: x1 - x0, height: y1 - y0 }).forEach(([name, value]) => box.setAttribute(name, value));
      }
    }
    dropped() {
      this.drag?.box.remove();
      this.drag = null;
    }
    released() {
      const drag = this.drag;
      this.dropped();
      if (drag?.area) this.zoom(drag.panel, ...drag.area);
    }
    // Panels below each other that share an axis zoom it together.
    zoom(panel, x0, x1, y0, y1) {
      const views = [[panel.x, [x0, x1]], [panel.y, [y1, y0]]].map(([axis, ends]) => [axis, ends.map((end) => axis.hidden(end))]);
      this.silent();
      for (const [axis, view] of views) axis.view = view;
      for (const other of this.panels) if (other.x.key === panel.x.key) other.x.view = panel.x.view;
      this.draw();
    }
    reset() {
      this.silent();
      for (const { x, y } of this.panels) for (const axis of [x, y]) axis.view = [axis.start, axis.end];
      this.draw();
    }
    draw() {
      this.panels.forEach((panel) => panel.draw());
      this.svg.dispatchEvent(new CustomEvent("view"));
    }
    typed(event) {
      if (event.target.closest(".entry, .handle")) return;
      const [panel, x, y] = this.here ?? [this.panels[0], (this.panels[0].left + this.panels[0].right) / 2, this.panels[0].top];
      const step = ((panel.right - panel.left) / 100) * (event.shiftKey ? 10 : 1);
      const turn = (by) => this.panels[(this.panels.indexOf(panel) + by + this.panels.length) % this.panels.length];
      const within = (place) => Math.min(Math.max(place, panel.left), panel.right);
      const half = (panel.right - panel.left) / 4;
      const acts = {
        ArrowLeft: () => this.tell(panel, within(x - step), y),
        ArrowRight: () => this.tell(panel, within(x + step), y),
        ArrowUp: () => this.tell(turn(-1), x, turn(-1).top),
        ArrowDown: () => this.tell(turn(1), x, turn(1).top),
        "+": () => this.zoom(panel, within(x - half), within(x + half), panel.top, panel.bottom),
        Escape: () => this.reset(),
      };
      if (!acts[event.key]) return;
      event.preventDefault();
      acts[event.key]();
    }
  }

  const drawn = new WeakMap();
  const drawings = (figure) => {
    if (!drawn.has(figure)) drawn.set(figure, all(".panels > svg", figure).map((svg) => new Drawing(svg, figure)));
    return drawn.get(figure);
  };
  const enlivenFigure = (figure) => {
    // A figure takes its first pointer before it is read: pages of many figures open at once.
    const wake = () => drawings(figure);
    for (const event of ["pointerenter", "pointerdown", "focusin"]) figure.addEventListener(event, wake, { capture: true });
    for (const svg of all(".panels > svg", figure)) {
      svg.setAttribute("tabindex", "0");
      svg.setAttribute("role", "group");
    }
    // A legend switches every curve of its name in the figure.
    const entries = all(".entry", figure);
    for (const entry of entries) {
      const name = entry.dataset.series;
      entry.setAttribute("role", "button");
      entry.setAttribute("tabindex", "0");
      entry.setAttribute("aria-pressed", "true");
      const toggle = (event) => {
        event.preventDefault();
        const off = !entry.classList.contains("off");
        for (const one of entries.filter((other) => other.dataset.series === name)) {
          one.classList.toggle("off", off);
          one.setAttribute("aria-pressed", String(!off));
        }
        all(".line, .points, .band", figure)
          .filter((series) => series.dataset.series === name)
          .forEach((series) => series.classList.toggle("series-off", off));
      };
      entry.addEventListener("click", toggle);
      entry.addEventListener("keydown", (event) => { if (event.key === "Enter" || event.key === " ") toggle(event); });
    }
  };

  // Tables: the number with which a text begins, or the text.
  const valued = (cell) => {
    const text = (cell?.textContent ?? "").trim().replaceAll("−", "-");
    const found = /^([(<[]*)\s*(-?\d[\d.]*)(?:×10(-?\d+))?/.exec(text);
    if (!found) return { text, number: NaN };
    // One power behind the brackets is that of value and bounds; one within them is that of its bound alone.
    const shared = found[1].includes("(") ? /\)×10(-?\d+)$/.exec(text) : null;
    return { text, number: found[2] * 10 ** (found[3] ?? shared?.[1] ?? 0) };
  };
  const enlivenTable = (table) => {
    const body = table.tBodies[0];
    if (!body || body.rows.length < 2) return;
    for (const head of all("thead th", table)) {
      const button = html("button");
      button.type = "button";
      button.append(...head.childNodes);
      head.append(button);
      button.addEventListener("click", () => {
        const falls = head.getAttribute("aria-sort") === "ascending";
        const rows = [...body.rows].map((row) => ({ row, ...valued(row.cells[head.cellIndex]) }));
        const counts = head.classList.contains("n");
        const missing = ({ text, number }) => (counts ? Number.isNaN(number) : text === "" || text === "–");
        const order = (a, b) => (counts ? a.number - b.number : a.text.localeCompare(b.text, "en", { numeric: true }));
        rows.sort((a, b) => missing(a) - missing(b) || (missing(a) ? 0 : order(a, b) * (falls ? -1 : 1)));
        all("th", table).forEach((other) => other.removeAttribute("aria-sort"));
        head.setAttribute("aria-sort", falls ? "descending" : "ascending");
        body.append(...rows.map(({ row }) => row));
      });
    }
  };
  const enliven = (within) => {
    all("figure", within).forEach(enlivenFigure);
    all("table", within).forEach(enlivenTable);
  };
  enliven(document);
  globalThis.palpate = { enliven, drawings };

  // Everything is open on paper, whatever was folded on the screen.
  let opened = [];
  addEventListener("beforeprint", () => {
    opened = all("details:not([open])");
    opened.forEach((one) => (one.open = true));
  });
  addEventListener("afterprint", () => opened.forEach((one) => (one.open = false)));

  const first = document.querySelector(".first, .head");
  if (first && (all("figure").length || all("table").length)) {
    const bar = html("p", "", "bar");
    if (all("figure").length) bar.append(html("span", "In figures: hover or arrow keys read values, a drag zooms, a double click or Escape resets, a legend entry switches its curve."));
    const sections = all("main details");
    if (sections.length > 1) {
      const button = html("button", "Open all sections");
      button.type = "button";
      button.addEventListener("click", () => {
        const open = sections.some((one) => !one.open);
        sections.forEach((one) => (one.open = open));
        button.textContent = open ? "Close all sections" : "Open all sections";
      });
      bar.append(button);
    }
    first.append(bar);
  }
})();
