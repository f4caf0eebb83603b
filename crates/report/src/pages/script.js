// Values under the pointer or the arrow keys, series to hide, axes to stretch, tables to sort. Without it the page shows and prints all the same.
(() => {
"use strict";
const all = (selector, from = document) => [...from.querySelectorAll(selector)];
const make = (name, attributes = {}, text = "", space = "http://www.w3.org/1999/xhtml") => {
  const element = document.createElementNS(space, name);
  change(element, attributes);
  element.textContent = text;
  return element;
};
const SVG = "http://www.w3.org/2000/svg";
const minus = text => text.replace(/-/g, "−");
const number = x => minus(x !== 0 && (Math.abs(x) < 1e-3 || Math.abs(x) >= 1e5) ? x.toExponential(3) : String(Number(x.toPrecision(4))));
const change = (element, attributes) => Object.entries(attributes).forEach(([name, value]) => element.setAttribute(name, value));

// One note beside the pointer.
const tip = make("div", { class: "tip", hidden: "", "aria-hidden": "true" });
document.body.append(tip);
const show = (text, [x, y]) => {
  Object.assign(tip, { textContent: text, hidden: false });
  const box = tip.getBoundingClientRect();
  tip.style.left = Math.max(4, Math.min(x + 14, innerWidth - box.width - 4)) + "px";
  tip.style.top = (y + 18 + box.height > innerHeight ? y - 12 - box.height : y + 18) + "px";
};

for (const table of all("table.sortable")) {
  const heads = table.tBodies[0].rows.length > 1 ? all("thead th", table) : [];
  heads.forEach((head, column) => {
    const button = make("button", { type: "button" }, head.textContent);
    head.replaceChildren(button);
    button.addEventListener("click", () => {
      const falls = head.getAttribute("aria-sort") === "ascending";
      heads.forEach(other => other.removeAttribute("aria-sort"));
      change(head, { "aria-sort": falls ? "descending" : "ascending" });
      const key = ({ cells: { [column]: cell } }) => cell.classList.contains("n") ? Number(cell.dataset.v ?? NaN) : cell.textContent;
      const order = (one, other) => {
        const [a, b] = [key(one), key(other)];
        // Cells without a number come last in both orders.
        if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
        return (typeof a === "number" ? a - b : a.localeCompare(b)) * (falls ? -1 : 1);
      };
      table.tBodies[0].append(...[...table.tBodies[0].rows].sort(order));
    });
  });
}

// A place along an axis, from 0 to 1, as a value.
const axis = words => {
  const [low, high] = words.split(" ").slice(1).map(Number);
  return share => words.startsWith("linear") ? low + (high - low) * share : low * Math.pow(high / low, share);
};
const pairs = text => text.trim().split(/\s+/).map(pair => pair.split(",").map(Number));

// A level from end to end is none.
const isCurve = points => points.length > 2 || points[0][1] !== points[1][1];

// A frame of a figure: its curves in the units of the drawing, and the part of its horizontal axis that is shown.
class Frame {
  constructor(svg, rect, figure) {
    [this.left, this.top, this.width, this.height] = ["x", "y", "width", "height"].map(name => Number(rect.getAttribute(name)));
    ({ name: this.name, frame: this.number } = rect.dataset);
    [this.x, this.y, this.zooms] = [axis(rect.dataset.x), axis(rect.dataset.y), "zooms" in rect.dataset];
    this.view = [0, 1];
    const groups = all(`[data-in="${this.number}"]`, svg);
    this.curves = groups.filter(group => !svg.querySelector(`.hint[data-of="${CSS.escape(group.dataset.series)}"]`)).map(group => ({
      key: group.dataset.series, points: all("polyline", group).map(line => pairs(line.getAttribute("points"))).filter(isCurve).flat(),
    })).filter(curve => curve.points.length);
    // Curves over one axis are read together, loops where they are nearest.
    this.isOver = this.curves.every(({ points }) => points.every(([x], k) => !k || x >= points[k - 1][0]));
    if (!this.zooms) return;
    this.shapes = groups.flatMap(group => all("polyline, polygon", group)).map(shape => [shape, pairs(shape.getAttribute("points"))]);
    this.ticks = svg.querySelector(`[data-ticks="${this.number}"]`);
    const clip = make("clipPath", { id: `${figure}-${this.number}` }, "", SVG);
    clip.append(make("rect", { x: this.left, y: this.top, width: this.width, height: this.height }, "", SVG));
    svg.append(clip);
    groups.forEach(group => group.setAttribute("clip-path", `url(#${clip.id})`));
  }
  // From the drawing as it was to the drawing as it is shown, and back.
  at(x) { return this.left + ((x - this.left) - this.width * this.view[0]) / (this.view[1] - this.view[0]); }
  from([x, y]) { return [this.left + this.width * this.view[0] + (x - this.left) * (this.view[1] - this.view[0]), y]; }
  holds([x, y]) { return x >= this.left && x <= this.left + this.width && y >= this.top && y <= this.top + this.height; }
  values([x, y]) { return [this.x((x - this.left) / this.width), this.y(1 - (y - this.top) / this.height)]; }
  look(view) {
    this.view = view;
    for (const [shape, points] of this.shapes) change(shape, { points: points.map(([x, y]) => `${this.at(x).toFixed(1)},${y}`).join(" ") });
    const [a, b] = view.map(this.x);
    const [line, text] = ["polyline", "text"].map(name => this.ticks.querySelector(name));
    const rough = (b - a) / 8;
    const step = [1, 2, 5, 10].map(k => k * Math.pow(10, Math.floor(Math.log10(rough)))).find(step => step >= rough);
    this.ticks.replaceChildren();
    for (let k = Math.ceil(a / step); k * step <= b + 1e-9 * step; k++) {
      const x = this.left + this.width * (k * step - a) / (b - a);
      const [rule, label] = [line.cloneNode(), text.cloneNode()];
      change(rule, { points: `${x},${this.top} ${x},${this.top + this.height}` });
      change(label, { x });
      label.textContent = minus((k * step).toFixed(Math.max(0, -Math.floor(Math.log10(step)))));
      this.ticks.append(rule, label);
    }
  }
}

all(".sheet svg").forEach((svg, figure) => {
  const frames = all("[data-frame]", svg).map(rect => new Frame(svg, rect, `figure-${figure}`));
  const hints = all(".hint", svg).map(hint => ({ key: hint.dataset.of, text: [hint.dataset.of ?? [], hint.textContent].flat().join("\n"), hint }));
  // The browser's own note would come a second later, over this one.
  hints.forEach(({ hint }) => hint.replaceChildren());
  if (!hints.length && !frames.length) return;
  const hidden = new Set();
  const shown = list => list.filter(({ key }) => !hidden.has(key));
  const toScreen = ([x, y]) => { const at = new DOMPoint(x, y).matrixTransform(svg.getScreenCTM()); return [at.x, at.y]; };
  const toDrawing = event => { const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse()); return [at.x, at.y]; };
  const middle = ({ hint }) => toScreen(["cx", "cy"].map(name => Number(hint.getAttribute(name))));
  const closer = (best, one) => one[1] < best[1] ? one : best;
  const nearest = (list, far) => list.map(one => [one, far(one)]).reduce(closer, [null, Infinity]);
  const output = make("output", { "aria-live": "polite" });
  svg.parentElement.after(output);
  const cursor = make("line", { class: "cursor", visibility: "hidden" }, "", SVG);
  svg.append(cursor);
  // The text for a place of a frame, in the drawing as it was, and a line there.
  const read = (frame, [x, y]) => {
    const curves = shown(frame.curves);
    if (!curves.length) return "";
    if (frame.isOver) {
      change(cursor, { x1: frame.at(x), x2: frame.at(x), y1: frame.top, y2: frame.top + frame.height, visibility: "visible" });
      const values = curves.map(({ key, points }) => `${key}: ${number(frame.values(nearest(points, place => Math.abs(place[0] - x))[0])[1])}`);
      return [`${frame.name}: ${number(frame.values([x, y])[0])}`, ...values].join("\n");
    }
    const near = curves.map(({ key, points }) => [key, ...nearest(points, place => Math.hypot(place[0] - x, place[1] - y))]);
    const [[key, place]] = nearest(near, ([,, distance]) => distance);
    return `${key}: ${frame.values(place).map(number).join(", ")}`;
  };
  const leave = () => { tip.hidden = true; cursor.setAttribute("visibility", "hidden"); };
  svg.addEventListener("pointermove", event => {
    const [pointer, place] = [[event.clientX, event.clientY], toDrawing(event)];
    leave();
    const [hint, distance] = nearest(shown(hints), hint => { const [x, y] = middle(hint); return Math.hypot(x - pointer[0], y - pointer[1]); });
    const frame = frames.find(frame => frame.holds(place));
    const text = (distance > 18 && frame && read(frame, frame.from(place))) || (distance < (frame ? 60 : 18) && hint.text);
    if (text) show(text, pointer);
  });
  ["pointerleave", "blur"].forEach(name => svg.addEventListener(name, leave));
  let at = -1;
  svg.addEventListener("keydown", event => {
    if (event.key === "Escape") leave();
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1, PageDown: 25, PageUp: -25, Home: -Infinity, End: Infinity }[event.key];
    if (step === undefined || event.target !== svg) return;
    event.preventDefault();
    const first = frame => shown(frame.curves)[0]?.points.filter(([x]) => frame.holds([frame.at(x), frame.top])) ?? [];
    const stops = [...shown(hints), ...frames.flatMap(frame => first(frame).map(place => ({ frame, place })))];
    if (!stops.length) return;
    at = Math.max(0, Math.min(stops.length - 1, at + step));
    const { frame, place, text, hint } = stops[at];
    leave();
    const words = text ?? read(frame, place);
    output.textContent = words.replace(/\n/g, "; ");
    show(words, hint ? middle({ hint }) : toScreen([frame.at(place[0]), place[1]]));
  });
  // Parts of an image have no role of their own.
  change(svg, { role: "group", tabindex: "0" });
  for (const entry of all("[data-hides]", svg)) {
    const key = entry.dataset.hides;
    change(entry, { role: "button", tabindex: "0", "aria-pressed": "true" });
    const turn = () => {
      if (!hidden.delete(key)) hidden.add(key);
      entry.setAttribute("aria-pressed", !hidden.has(key));
      all("[data-series]", svg).filter(group => group.dataset.series === key).forEach(group => group.classList.toggle("off", hidden.has(key)));
      leave();
    };
    entry.addEventListener("click", turn);
    entry.addEventListener("keydown", event => { if ([" ", "Enter"].includes(event.key)) { event.preventDefault(); turn(); } });
  }
  const zooming = frames.filter(frame => frame.zooms);
  if (!zooming.length) return;
  const to = (low, high) => {
    const width = Math.min(1, Math.max(high - low, 0.002));
    const start = Math.max(0, Math.min(1 - width, low));
    zooming.forEach(frame => frame.look([start, start + width]));
    leave();
  };
  // Parts of the view as it is.
  const part = (from, end) => { const [low, high] = zooming[0].view; to(low + from * (high - low), low + end * (high - low)); };
  const tools = make("div", { class: "tools", role: "group", "aria-label": "zoom" });
  for (const [sign, name, from, end] of [["+", "zoom in", 0.25, 0.75], ["−", "zoom out", -0.5, 1.5], ["◀", "earlier", -0.5, 0.5], ["▶", "later", 0.5, 1.5]]) {
    tools.append(make("button", { type: "button", "aria-label": name }, sign));
    tools.lastChild.addEventListener("click", () => part(from, end));
  }
  tools.append(make("button", { type: "button", "aria-label": "the whole record" }, "whole"));
  [[tools.lastChild, "click"], [svg, "dblclick"]].forEach(([element, name]) => element.addEventListener(name, () => to(0, 1)));
  tools.append(make("span", { class: "note" }, "or drag across the curves"));
  svg.parentElement.before(tools);
  const share = event => zooming.filter(frame => frame.holds(toDrawing(event))).map(frame => (toDrawing(event)[0] - frame.left) / frame.width)[0];
  let from;
  svg.addEventListener("pointerdown", event => { from = share(event); });
  svg.addEventListener("pointerup", event => {
    const ends = [from, share(event)].sort((one, other) => one - other);
    if (ends[1] - ends[0] > 1 / 60) part(...ends);
    from = undefined;
  });
});
})();
