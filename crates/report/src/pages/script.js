// Values under the pointer or the arrow keys, tables to sort, curves to hide, records to zoom. Without it the page shows and prints all the same.
(() => {
"use strict";
const root = document.documentElement;
root.classList.add("js");
const all = (selector, from = document) => [...from.querySelectorAll(selector)];
const make = (name, attributes = {}, text = "") => {
  const element = document.createElement(name);
  Object.entries(attributes).forEach(([key, value]) => element.setAttribute(key, value));
  element.textContent = text;
  return element;
};
const draw = (name, attributes = {}, text = "") => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  Object.entries(attributes).forEach(([key, value]) => element.setAttribute(key, value));
  element.textContent = text;
  return element;
};
const told = x => {
  if (!Number.isFinite(x)) return "–";
  const size = Math.abs(x);
  const text = size !== 0 && (size < 1e-3 || size >= 1e5) ? x.toExponential(3) : String(Number(x.toPrecision(4)));
  return text.replace(/-/g, "−");
};

// One line beside the pointer.
const tip = make("div", { class: "tip", hidden: "", "aria-hidden": "true" });
document.body.append(tip);
const show = (text, x, y) => {
  tip.textContent = text;
  tip.hidden = false;
  const box = tip.getBoundingClientRect();
  tip.style.left = Math.max(4, Math.min(x + 14, innerWidth - box.width - 4)) + "px";
  tip.style.top = (y + 18 + box.height > innerHeight ? y - 12 - box.height : y + 18) + "px";
};
const hide = () => { tip.hidden = true; };

// Tables.
for (const table of all("table.sortable")) {
  const heads = all("thead th", table);
  if (table.tBodies[0].rows.length < 2) continue;
  heads.forEach((head, column) => {
    const button = make("button", { type: "button" }, head.textContent);
    head.replaceChildren(button);
    button.addEventListener("click", () => {
      const falling = head.getAttribute("aria-sort") === "ascending";
      heads.forEach(other => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", falling ? "descending" : "ascending");
      const key = row => {
        const cell = row.cells[column];
        if (cell.classList.contains("n")) return cell.dataset.v === undefined ? null : Number(cell.dataset.v);
        return cell.textContent;
      };
      const order = (one, other) => {
        const [a, b] = [key(one), key(other)];
        if (a === null || b === null) return (a === null) - (b === null);
        const less = typeof a === "number" ? a - b : a.localeCompare(b);
        return falling ? -less : less;
      };
      table.tBodies[0].append(...[...table.tBodies[0].rows].sort(order));
    });
  });
}

// Figures that are files: the mark nearest to the pointer tells its value.
for (const sheet of all(".sheet svg")) {
  const marks = all(".hint", sheet);
  if (!marks.length) continue;
  const output = make("output", { "aria-live": "polite" });
  sheet.parentElement.after(output);
  const text = mark => mark.querySelector("title").dataset.text;
  // The browser's own tips would come a second later, over this one.
  marks.forEach(mark => { const title = mark.querySelector("title"); title.dataset.text = title.textContent; title.textContent = ""; });
  const place = mark => { const box = mark.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; };
  let at = -1;
  sheet.addEventListener("pointermove", event => {
    let [best, least] = [null, 18];
    for (const mark of marks) {
      const [x, y] = place(mark);
      const distance = Math.hypot(x - event.clientX, y - event.clientY);
      if (distance < least) [best, least] = [mark, distance];
    }
    if (!best) return hide();
    at = marks.indexOf(best);
    show(text(best), event.clientX, event.clientY);
  });
  sheet.addEventListener("pointerleave", hide);
  sheet.setAttribute("tabindex", "0");
  sheet.addEventListener("blur", hide);
  sheet.addEventListener("keydown", event => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (event.key === "Escape") hide();
    if (!step) return;
    event.preventDefault();
    at = Math.max(0, Math.min(marks.length - 1, at + step));
    output.textContent = text(marks[at]);
    show(text(marks[at]), ...place(marks[at]));
  });
}

// Charts of the page itself.
const WHOLE = 1000;
const groups = new Map();
const scale = words => {
  const [kind, low, high] = words.split(" ");
  const [a, b] = [Number(low), Number(high)];
  const log = kind === "log";
  return {
    log, low: a, high: b,
    value: share => log ? a * Math.pow(b / a, share) : a + (b - a) * share,
    share: value => log ? Math.log(value / a) / Math.log(b / a) : (value - a) / (b - a),
  };
};
const points = path => {
  const found = [];
  for (const piece of path.getAttribute("d").split("M").slice(1)) {
    const numbers = piece.match(/-?[\d.]+/g).map(Number);
    for (let k = 0; k + 1 < numbers.length; k += 2) found.push([numbers[k], numbers[k + 1]]);
  }
  return found;
};
// Where the upright lines of a path end.
const tips = path => path.getAttribute("d").split("M").slice(1).map(piece => piece.match(/-?[\d.]+/g).map(Number).slice(-2));
class Chart {
  constructor(figure) {
    this.figure = figure;
    this.svg = figure.querySelector("svg.axes");
    this.plot = figure.querySelector("svg.plot");
    this.x = scale(this.svg.dataset.x);
    this.y = scale(this.svg.dataset.y);
    this.layers = all("g[data-layer]", this.plot);
    this.view = [0, WHOLE];
    this.at = -1;
    this.output = make("output", { "aria-live": "polite" });
    this.svg.after(this.output);
    this.cursor = draw("line", { class: "cursor", y1: 0, y2: WHOLE, visibility: "hidden" });
    this.plot.append(this.cursor);
    all(".keys button", figure).forEach(button => button.addEventListener("click", () => {
      const shown = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", shown);
      this.layers.filter(layer => layer.dataset.layer === button.dataset.layer).forEach(layer => layer.classList.toggle("off", !shown));
    }));
    this.svg.setAttribute("tabindex", "0");
    this.svg.addEventListener("pointermove", event => this.point(event));
    this.svg.addEventListener("pointerleave", () => this.leave());
    this.svg.addEventListener("blur", () => this.leave());
    this.svg.addEventListener("keydown", event => this.key(event));
    if (figure.dataset.zoom) this.zoomable(figure.dataset.zoom);
  }
  // Curves with their points, and marks with their words, of what is not hidden.
  get curves() {
    this.known ??= this.layers.map(layer => ({
      layer, name: layer.dataset.name,
      lines: [...all("path.line, path.wide, path.dash, path.dots", layer).flatMap(points), ...all("path.stems", layer).flatMap(tips)],
      marks: all("path[data-t]", layer).map(path => [...points(path)[0], path.dataset.t]),
    }));
    return this.known.filter(curve => !curve.layer.classList.contains("off"));
  }
  get rows() { return this.curves.filter(curve => curve.lines.length); }
  inside(event) {
    const box = this.plot.getScreenCTM().inverse();
    const place = new DOMPoint(event.clientX, event.clientY).matrixTransform(box);
    return [place.x, place.y];
  }
  onScreen([x, y]) {
    const place = new DOMPoint(x, y).matrixTransform(this.plot.getScreenCTM());
    return [place.x, place.y];
  }
  nearest(list, wanted) {
    const far = this.figure.dataset.near === "xy"
      ? place => { const [x, y] = this.onScreen(place); return Math.hypot(x - wanted[0], y - wanted[1]); }
      : place => Math.abs(place[0] - wanted[0]);
    let [best, least] = [-1, Infinity];
    list.forEach((place, k) => { const distance = far(place); if (distance < least) [best, least] = [k, distance]; });
    return best;
  }
  words(place, name) {
    const [x, y] = [this.x.value(place[0] / WHOLE), this.y.value(1 - place[1] / WHOLE)];
    return `${name}: ${told(x)}, ${told(y)}`;
  }
  // What stands at a place along the curves, in words.
  along(x) {
    const lines = this.rows.map(curve => {
      const place = curve.lines[this.nearest(curve.lines, [x, 0])];
      return `${curve.name}: ${told(this.y.value(1 - place[1] / WHOLE))}`;
    });
    const name = this.svg.dataset.xname;
    return [`${name}: ${told(this.x.value(x / WHOLE))}`, ...lines].join("\n");
  }
  point(event) {
    const [x, y] = this.inside(event);
    if (x < this.view[0] || x > this.view[1] || y < 0 || y > WHOLE) return this.leave();
    let [best, least] = [null, 16];
    for (const { marks } of this.curves) for (const mark of marks) {
      const [px, py] = this.onScreen(mark);
      const distance = Math.hypot(px - event.clientX, py - event.clientY);
      if (distance < least) [best, least] = [mark, distance];
    }
    let text;
    if (best) text = best[2];
    else if (!this.rows.length) return hide();
    else if (this.figure.dataset.near === "xy") {
      const near = this.rows.map(curve => { const k = this.nearest(curve.lines, [event.clientX, event.clientY]); return [curve.lines[k], curve.name]; });
      const far = place => { const [a, b] = this.onScreen(place); return Math.hypot(a - event.clientX, b - event.clientY); };
      near.sort((one, other) => far(one[0]) - far(other[0]));
      text = this.words(...near[0]);
    } else {
      this.mark(x);
      text = this.along(x);
    }
    show(text, event.clientX, event.clientY);
  }
  mark(x) {
    this.cursor.setAttribute("x1", x);
    this.cursor.setAttribute("x2", x);
    this.cursor.setAttribute("visibility", "visible");
  }
  leave() {
    hide();
    this.cursor.setAttribute("visibility", "hidden");
  }
  key(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1, PageDown: 25, PageUp: -25, Home: -Infinity, End: Infinity }[event.key];
    if (event.key === "Escape") return this.leave();
    if (step === undefined) return;
    event.preventDefault();
    const row = this.rows[0];
    const stops = (row ? row.lines : this.curves.flatMap(curve => curve.marks)).filter(([x]) => x >= this.view[0] && x <= this.view[1]);
    if (!stops.length) return;
    this.at = Math.max(0, Math.min(stops.length - 1, this.at + step));
    const stop = stops[this.at];
    const text = stop[2] ?? (this.figure.dataset.near === "xy" ? this.words(stop, row.name) : this.along(stop[0]));
    if (!stop[2]) this.mark(stop[0]);
    this.output.textContent = text.replace(/\n/g, "; ");
    show(text, ...this.onScreen(stop));
  }
  zoomable(group) {
    if (!groups.has(group)) groups.set(group, []);
    groups.get(group).push(this);
    const to = (low, high) => {
      const width = Math.min(WHOLE, Math.max(high - low, WHOLE / 500));
      const start = Math.max(0, Math.min(WHOLE - width, low));
      groups.get(group).forEach(chart => chart.look(start, start + width));
    };
    const about = factor => {
      const [low, high] = this.view;
      const [middle, half] = [(low + high) / 2, (high - low) / 2 * factor];
      to(middle - half, middle + half);
    };
    const aside = share => { const by = (this.view[1] - this.view[0]) * share; to(this.view[0] + by, this.view[1] + by); };
    const tools = make("div", { class: "tools", role: "group", "aria-label": "zoom" });
    for (const [sign, name, act] of [
      ["+", "zoom in", () => about(0.5)], ["−", "zoom out", () => about(2)], ["◀", "earlier", () => aside(-0.5)],
      ["▶", "later", () => aside(0.5)], ["whole", "the whole record", () => to(0, WHOLE)],
    ]) {
      const button = make("button", { type: "button", "aria-label": name }, sign);
      button.addEventListener("click", act);
      tools.append(button);
    }
    tools.append(make("span", { class: "note" }, "or drag across the curves"));
    this.svg.before(tools);
    let from = null;
    this.svg.addEventListener("pointerdown", event => { from = this.inside(event)[0]; });
    this.svg.addEventListener("pointerup", event => {
      const end = this.inside(event)[0];
      if (from !== null && Math.abs(end - from) > (this.view[1] - this.view[0]) / 60) to(Math.min(from, end), Math.max(from, end));
      from = null;
    });
    this.svg.addEventListener("dblclick", () => to(0, WHOLE));
  }
  look(low, high) {
    this.view = [low, high];
    this.plot.setAttribute("viewBox", `${low} 0 ${high - low} ${WHOLE}`);
    const ticks = this.svg.querySelector(".xt");
    const [left, top, width, height] = ["x", "y", "width", "height"].map(name => Number(this.plot.getAttribute(name)));
    const [a, b] = [this.x.value(low / WHOLE), this.x.value(high / WHOLE)];
    const rough = (b - a) / 6;
    const unit = Math.pow(10, Math.floor(Math.log10(rough)));
    const step = [1, 2, 5, 10].map(k => k * unit).find(s => s >= rough);
    const decimals = Math.max(0, -Math.floor(Math.log10(step)));
    ticks.replaceChildren();
    for (let k = Math.ceil(a / step); k * step <= b + 1e-9 * step; k++) {
      const x = left + width * (k * step - a) / (b - a);
      ticks.append(draw("line", { class: "rule", x1: x, x2: x, y1: top, y2: top + height }));
      ticks.append(draw("text", { class: "tick", x, y: top + height + 20, "text-anchor": "middle" }, (k * step).toFixed(decimals).replace(/-/g, "−")));
    }
  }
}
all("figure.chart").filter(figure => figure.querySelector("svg.axes")).forEach(figure => new Chart(figure));
})();
