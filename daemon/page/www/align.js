// Alignment: the corners of an output, to be dragged or moved by steps.

import {command} from "./api.js";

const kCorners = ["top_left", "top_right", "bottom_left", "bottom_right"];
const kMargin = 0.18;     // around the output in the drawing, as a share of its size
const kRest_ms = 250;     // a dragged corner that rests for this time is moved on the wall
const svgName = "http://www.w3.org/2000/svg";
const byId = id => document.getElementById(id);
const readable = name => name.replace("_", " ");

function set(element, attributes) {
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
}

function make(name, attributes = {}) {
  const made = document.createElementNS(svgName, name);
  set(made, attributes);
  return made;
}

export class Alignment {
  // `run(name, argument)` sends a command, reports its failure, and returns its result or undefined.
  constructor(run) {
    this.run = run;
    this.report = null;    // what the command `align` answered last
    this.output = "";
    this.corner = kCorners[0];
    this.dragged = null;   // {corner, from, by, sent, timer}
    this.asked = 0;        // commands without an answer yet
    this.plane = byId("align-plane");
    this.makeControls();
    this.makeShapes();
  }

  makeControls() {
    for (const corner of kCorners) {
      const button = document.createElement("button");
      button.type = "button";
      button.dataset.corner = corner;
      button.title = readable(corner);
      button.textContent = {top_left: "◤", top_right: "◥", bottom_left: "◣", bottom_right: "◢"}[corner];
      button.setAttribute("aria-label", readable(corner));
      button.onclick = () => this.choose(this.cornerSeenAt(corner));
      byId("align-corners").append(button);
    }
    byId("align-output").onchange = event => {
      this.output = event.target.value;
      this.select();
      this.draw();
    };
    for (const button of byId("align-pad").querySelectorAll("button"))
      button.onclick = () => this.moveBy(button.dataset.by.split(" ").map(Number));
    byId("align-undo").onclick = () => this.ask("undo");
    byId("align-redo").onclick = () => this.ask("redo");
    byId("align-reset").onclick = () => this.ask("reset " + this.output);
    byId("testcard").onchange = async event => {
      await this.run("testcard", event.target.value);
      this.refresh();
    };
    this.plane.addEventListener("pointerdown", event => this.begin(event));
    this.plane.addEventListener("pointermove", event => this.drag(event));
    for (const end of ["pointerup", "pointercancel"]) this.plane.addEventListener(end, () => this.end());
    this.plane.addEventListener("keydown", event => this.key(event));
  }

  // Makes the shapes once; draw() only changes them, so that a corner keeps the keyboard's focus and a finger on it.
  makeShapes() {
    this.frame = make("rect", {class: "frame"});
    this.quad = make("polygon", {class: "quad"});
    this.handles = Object.fromEntries(kCorners.map(corner => [corner, {
      dot: make("circle", {class: "handle"}),
      area: make("circle", {class: "handle-area", "data-corner": corner, tabindex: 0, role: "button",
                            "aria-label": readable(corner)})}]));
    this.group = make("g");
    this.group.append(this.frame, this.quad, ...Object.values(this.handles).flatMap(h => [h.dot, h.area]));
  }

  setCards(names) {
    byId("testcard").replaceChildren(...["off", ...names].map(name => new Option(name, name)));
  }

  async ask(argument) {
    this.plane.ariaBusy = String(++this.asked > 0);
    const report = await this.run("align", argument);
    this.plane.ariaBusy = String(--this.asked > 0);
    if (report) this.take(report);
  }

  // Reads the alignment, which others may have changed; not while a corner is dragged.
  async refresh() {
    if (this.dragged) return;
    try {
      this.take(await command("align", "list"));
    } catch { /* the state says why */ }
  }

  take(report) {
    this.report = report;
    const names = report.outputs.map(o => o.name), list = byId("align-output");
    if ([...list.options].map(o => o.value).join("\n") !== names.join("\n"))
      list.replaceChildren(...names.map(name => new Option(name, name)));
    if (!names.includes(this.output)) this.output = report.selected.output || names[0] || "";
    list.value = this.output;
    byId("align-note").textContent = names.length > 0 ? "" :
        "This wall has no output that can be aligned: those of kind shared_memory hold the frame without correction.";
    if (document.activeElement !== byId("testcard")) byId("testcard").value = report.test_card || "off";
    this.draw();
  }

  current() { return this.report && this.report.outputs.find(o => o.name === this.output); }

  choose(corner) {
    this.corner = corner;
    this.select();
    this.draw();
  }

  // How the current output's signal is seen on the wall: [a, b, c, d, e, f] of an SVG matrix that
  // takes its pixels to where they are seen, and the size there. A projector may hang upside down.
  seen(output) {
    const {right, down} = output.seen, {width, height} = output;
    const from = ([x, y]) => (x < 0 ? width : 0) + (y < 0 ? height : 0);
    const size = ([x, y]) => Math.abs(x) * width + Math.abs(y) * height;
    return {matrix: [right[0], down[0], right[1], down[1], from(right), from(down)],
            width: size(right), height: size(down)};
  }

  // The signal's corner that is seen in a corner of the wall.
  cornerSeenAt(corner) {
    const output = this.current();
    if (!output) return corner;
    const {right, down} = output.seen, i = kCorners.indexOf(corner);
    const x = 2 * (i % 2) - 1, y = 2 * (i >> 1) - 1;
    return kCorners[(right[0] * x + down[0] * y > 0 ? 1 : 0) + (right[1] * x + down[1] * y > 0 ? 2 : 0)];
  }

  // The name of the corner of the wall where this corner of the signal is seen.
  readableSeen(corner) { return readable(kCorners.find(c => this.cornerSeenAt(c) === corner)); }

  // Selects the corner: the test card marks it, and bound inputs move it.
  select() { if (this.current()) this.ask(`select ${this.corner} ${this.output}`); }

  // Moves a corner by steps to the right and down, as seen on the wall.
  moveBy([x, y], corner = this.corner) {
    const output = this.current(), step = Number(byId("align-step").value);
    if (!output) return undefined;
    const {right, down} = output.seen;
    const by = [0, 1].map(i => (right[i] * x + down[i] * y) * step);
    return this.ask(`move ${corner} ${by[0]} ${by[1]} ${this.output}`);
  }

  // Where a corner is, in pixels of the output.
  place(output, corner) {
    const i = kCorners.indexOf(corner), {configured, moved} = output.corners[corner];
    const by = this.dragged && this.dragged.corner === corner ? this.dragged.by : [0, 0];
    return [(i % 2) * output.width + configured[0] + moved[0] + by[0],
            (i >> 1) * output.height + configured[1] + moved[1] + by[1]];
  }

  draw() {
    const output = this.current();
    for (const button of byId("align-corners").children)
      button.setAttribute("aria-pressed", String(this.cornerSeenAt(button.dataset.corner) === this.corner));
    if (!output) {
      this.plane.replaceChildren();
      byId("align-state").textContent = "";
      return;
    }
    const {width, height} = output, seen = this.seen(output), margin = Math.max(width, height) * kMargin;
    this.plane.setAttribute("viewBox",
        `${-margin} ${-margin} ${seen.width + 2 * margin} ${seen.height + 2 * margin}`);
    this.group.setAttribute("transform", `matrix(${seen.matrix.join(" ")})`);
    const unit = (seen.width + 2 * margin) / (this.plane.clientWidth || 400);  // size of one pixel on the screen
    const at = Object.fromEntries(kCorners.map(c => [c, this.place(output, c)]));
    const points = ["top_left", "top_right", "bottom_right", "bottom_left"].map(c => at[c].join(",")).join(" ");
    set(this.frame, {width, height, "stroke-width": unit});
    set(this.quad, {points, "stroke-width": 1.5 * unit});
    for (const [corner, {dot, area}] of Object.entries(this.handles)) {
      const [cx, cy] = at[corner], chosen = corner === this.corner ? " chosen" : "";
      set(dot, {class: "handle" + chosen, cx, cy, r: 7 * unit, "stroke-width": 2 * unit});
      set(area, {cx, cy, r: 22 * unit});
    }
    if (!this.plane.hasChildNodes()) this.plane.append(this.group);
    const now = this.dragged ? this.dragged.by : [0, 0];
    const moved = output.corners[this.corner].moved.map((v, i) => v + now[i]);
    const {right, down} = output.seen, along = ([x, y]) => (x * moved[0] + y * moved[1]).toFixed(2);
    byId("align-state").textContent = `${this.readableSeen(this.corner)} moved by ${along(right)}, ` +
        `${along(down)} px${output.pending ? ", not yet shown" : ""} · ` +
        `${this.report.undo} to undo, ${this.report.redo} to redo`;
  }

  toOutput(event) {
    const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.group.getScreenCTM().inverse());
    return [point.x, point.y];
  }

  begin(event) {
    const corner = event.target.dataset && event.target.dataset.corner;
    if (!corner || this.plane.classList.contains("locked")) return;
    event.preventDefault();
    this.plane.setPointerCapture(event.pointerId);
    if (corner !== this.corner) this.choose(corner);
    this.dragged = {corner, from: this.toOutput(event), by: [0, 0], timer: 0};
  }

  drag(event) {
    const dragged = this.dragged;
    if (!dragged) return;
    const now = this.toOutput(event);
    dragged.by = [now[0] - dragged.from[0], now[1] - dragged.from[1]];
    clearTimeout(dragged.timer);
    dragged.timer = setTimeout(() => this.send(), kRest_ms);
    this.draw();
  }

  // Sends what was dragged as one step, so that one undo takes it back.
  async send() {
    const {corner, by} = this.dragged;
    const sent = by.map(v => Number(v.toFixed(2)));
    if (!sent[0] && !sent[1]) return;
    this.dragged.from = this.dragged.from.map((v, i) => v + sent[i]);
    this.dragged.by = by.map((v, i) => v - sent[i]);
    await this.ask(`move ${corner} ${sent[0]} ${sent[1]} ${this.output}`);
  }

  async end() {
    if (!this.dragged) return;
    clearTimeout(this.dragged.timer);
    const sent = this.send();
    this.dragged = null;
    await sent;
    this.draw();
  }

  key(event) {
    const by = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    const corner = event.target.dataset && event.target.dataset.corner;
    if (!by || !corner || this.plane.classList.contains("locked")) return;
    event.preventDefault();
    this.corner = corner;
    this.moveBy(by);
  }
}
