"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const svg = document.getElementById("layout");
const about = document.getElementById("about");
const choice = document.getElementById("edge");
const level = document.getElementById("level");

function make(parent, name, attributes) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  parent.appendChild(element);
  return element;
}

function text(parent, name, content) {
  const element = document.createElement(name);
  element.textContent = content;
  parent.appendChild(element);
  return element;
}

// Where the locks of every edge are among all of them, twice their places, and 1 more where it is the second one: an edge is made
// out when it is shown, as a roadmap has a million locks.
const packed = data.locks, begins = new Uint32Array(data.edges.length + 1), members = new Uint32Array(packed.length / 3);
for (let k = 0; k < packed.length; k += 6) for (const side of [0, 1]) begins[packed[k + side] + 1]++;
for (let k = 1; k < begins.length; k++) begins[k] += begins[k - 1];
const next = begins.slice();
for (let k = 0; k < packed.length; k += 6) for (const side of [0, 1]) members[next[packed[k + side]]++] = k / 3 + side;

/** What an edge blocks: the other edge, the own lengths, the other's lengths [m]. */
function blocks_of(k) {
  return [...members.subarray(begins[k], begins[k + 1])].map((member) => {
    const side = member % 2, lock = 3 * (member - side), lengths = [2, 4].map((at) => [packed[lock + at] / STEPS, packed[lock + at + 1] / STEPS]);
    return [packed[lock + 1 - side], lengths[side], lengths[1 - side]];
  });
}

// Edges that lie on the same line, in either direction: the pointer reaches the last of them only.
const lines_of = new Map();
const line_of = data.edges.map((edge, k) => {
  const key = edge.level + [edge.path, edge.back].sort().join();
  if (!lines_of.has(key)) lines_of.set(key, []);
  lines_of.get(key).push(k);
  return lines_of.get(key);
});

// Metres to steps of a millimetre; y points up.
const STEPS = 1000;
const world = make(svg, "g", { transform: "scale(1 -1)" });
const corridors = make(world, "g", { class: "corridors" });
const lines = make(world, "g", {});
const overlay = make(world, "g", { "pointer-events": "none" });
const targets = make(world, "g", {});
const targets_of = new Map(), nodes = new Map();
let pinned = null, shown = null;
const ROWS = 24;

/** A button that shows another edge. */
function link(parent, other) {
  const button = text(parent, "button", data.edges[other].id);
  button.type = "button";
  button.addEventListener("click", () => pin(other));
}

/** Shows an edge until another one is chosen. */
function pin(k) {
  pinned = k;
  show(k);
  choice.value = k === null ? "" : String(k);
}

/** Makes the list of edges anew: these, and the one that is shown. */
function list(edges) {
  choice.replaceChildren();
  text(choice, "option", "none").value = "";
  for (const k of edges.length > 0 || shown === null ? edges : [shown]) text(choice, "option", data.edges[k].id).value = String(k);
  choice.value = shown === null ? "" : String(shown);
}

// All edges are in it only while it is used: browsers lay thousands of them out anew whenever another one is chosen.
function list_all() {
  const at = Number(level.value);
  if (choice.length <= 2) list([...data.edges.keys()].filter((k) => data.edges[k].level === at));
}
for (const use of ["pointerdown", "focus", "keydown"]) choice.addEventListener(use, list_all);
choice.addEventListener("blur", () => list([]));

function range([from, to]) {
  return from.toFixed(3) + " – " + to.toFixed(3);
}

function show(k) {
  overlay.replaceChildren();
  about.replaceChildren();
  shown = k;
  if (document.activeElement !== choice) list([]);
  if (k === null) {
    text(about, "p", "Point at an edge to see its corridor (blue) and what it blocks (red); click to keep it, again for the next edge on the same line.");
    list_gaps();
    return;
  }
  const edge = data.edges[k], blocks = blocks_of(k);
  const corridor = make(overlay, "g", { class: "corridor" });
  for (const [d, width] of edge.corridor) make(corridor, "path", { d, "stroke-width": width });
  for (const [other, , lengths] of blocks) {
    const blocked = data.edges[other];
    if (blocked.path === "") continue;
    // The part between two lengths, as a dash of the whole path.
    const mark = { d: blocked.path, class: "blocked", "stroke-width": 0.5 * STEPS * data.radius };
    if (blocked.length > 0) {
      const [from, to] = lengths;
      mark.pathLength = blocked.length;
      mark["stroke-dasharray"] = "0 " + from + " " + (to - from) + " " + (blocked.length + 1);
      mark.style = "stroke-linecap: butt";
    }
    make(overlay, "path", mark);
  }
  const chosen = make(overlay, "path", { d: edge.path, class: "chosen" });
  const end = chosen.getTotalLength();
  if (end > 0) {
    // The direction of travel at its end, and the vehicle there and at its start.
    const place = (at, from, to) => {
      const turn = Math.atan2(to.y - from.y, to.x - from.x) * 180 / Math.PI;
      return `translate(${at.x} ${at.y}) rotate(${turn})`;
    };
    const [start, first, last, tip] = [0, 0.01, 0.99, 1].map((share) => chosen.getPointAtLength(end * share));
    for (const transform of [place(start, start, first), place(tip, last, tip)]) {
      if (data.footprint.length > 0) make(overlay, "polygon", { points: data.footprint.join(" "), class: "vehicle", transform });
      else make(overlay, "circle", { r: STEPS * data.radius, class: "vehicle", transform });
    }
    const size = 0.6 * STEPS * data.radius;
    make(overlay, "path", { d: "M0 0l-1 .6v-1.2z", class: "arrow", transform: `${place(tip, last, tip)} scale(${size})` });
  }
  text(about, "h2", "Edge " + edge.id);
  const same = line_of[k].filter((other) => other !== k);
  if (same.length > 0) {
    const list = text(about, "p", "On the same line: ");
    same.forEach((other) => link(list, other));
  }
  text(about, "p", "From node " + edge.ends[0] + " to node " + edge.ends[1] + ", " + edge.length.toFixed(3) + " m. Blocks " +
    new Set(blocks.map(([other]) => other)).size + " edges:");
  const table = text(about, "table", "");
  const head = text(text(table, "thead", ""), "tr", "");
  for (const title of ["edge", "on it [m]", "on this one [m]"]) text(head, "th", title);
  const body = text(table, "tbody", "");
  // An edge that is only pointed at shows as many as are seen: in roadmaps it has hundreds, which take a while.
  const rows = pinned === null ? blocks.slice(0, ROWS) : blocks;
  for (const [other, own, lengths] of rows) {
    const row = text(body, "tr", "");
    link(text(row, "td", ""), other);
    text(row, "td", range(lengths));
    text(row, "td", range(own));
  }
  if (rows.length < blocks.length) text(about, "p", "and " + (blocks.length - rows.length) + " more: click the edge to see all");
}

function draw() {
  const at = Number(level.value);
  corridors.replaceChildren();
  lines.replaceChildren();
  targets.replaceChildren();
  targets_of.clear();
  nodes.clear();
  // What is only seen is one path for all edges, and one for corridors of a kind.
  const of_width = new Map(), drawn = new Set();
  data.edges.forEach((edge, k) => {
    if (edge.level !== at) return;
    if (edge.path === "" || line_of[k].some((other) => drawn.has(other))) return;
    drawn.add(k);
    for (const [d, width, filled] of edge.corridor) {
      const kind = `${width} ${filled ? "filled" : ""}`;
      if (!of_width.has(kind)) of_width.set(kind, { width, filled, paths: [] });
      of_width.get(kind).paths.push(d);
    }
    targets_of.set(make(targets, "path", { d: edge.path, class: "target" }), line_of[k].at(-1));
  });
  for (const { width, filled, paths } of of_width.values())
    make(corridors, "path", { d: paths.join(""), "stroke-width": width, class: filled ? "filled" : "" });
  make(lines, "path", { d: [...drawn].map((k) => data.edges[k].path).join(""), class: "edge" });
  for (const node of data.nodes) {
    if (node.level !== at) continue;
    nodes.set(node.id, make(lines, "circle", { cx: node.x, cy: node.y, r: 0.2 * STEPS * data.radius, class: "node" }));
  }
  draw_layers();
  pin(null);
}

targets.addEventListener("pointerover", (event) => { if (pinned === null) show(targets_of.get(event.target) ?? null); });
targets.addEventListener("pointerout", () => { if (pinned === null) show(null); });

// A click chooses an edge, another one the next edge on the same line; beside all edges it chooses none.
svg.addEventListener("click", (event) => {
  if (moved) return;
  const k = targets_of.get(event.target);
  if (k === undefined) return pin(null);
  const same = line_of[k];
  pin(same.includes(pinned) ? same[(same.indexOf(pinned) + 1) % same.length] : k);
});

// ---- What part of the layout is seen: [x, y, width, height] in steps, y down ----

const whole = data.bounds;
let seen = whole;

function look(part) {
  seen = part;
  svg.setAttribute("viewBox", seen.join(" "));
  // The largest round length that is no longer than a sixth of the picture, and longer than its label.
  const pixel = 1 / Math.min(svg.clientWidth / seen[2], svg.clientHeight / seen[3]) / STEPS;
  const most = pixel * Math.max(svg.clientWidth / 6, 125), power = 10 ** Math.floor(Math.log10(most));
  const length = [5, 2, 1].map((m) => m * power).find((length) => length <= most) ?? power;
  const bar = document.getElementById("scale");
  bar.textContent = length >= 1000 ? length / 1000 + " km" : length >= 1 ? length + " m" : Number((length * 1000).toPrecision(3)) + " mm";
  bar.style.width = length / pixel + "px";
}

/** A point of the window in steps. */
function point(event) {
  return new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
}

function zoom(factor, about = { x: seen[0] + seen[2] / 2, y: seen[1] + seen[3] / 2 }) {
  // Between four times the layout and a thousandth of it.
  const by = Math.min(4 * whole[2] / seen[2], Math.max(whole[2] / 1000 / seen[2], factor));
  const [x, y, width, height] = seen;
  look([about.x - (about.x - x) * by, about.y - (about.y - y) * by, width * by, height * by]);
}

const move = (x, y) => look([seen[0] + x, seen[1] + y, seen[2], seen[3]]);

svg.addEventListener("wheel", (event) => { event.preventDefault(); zoom(1.0015 ** event.deltaY, point(event)); }, { passive: false });

// One finger or the mouse moves, two fingers zoom, too.
const fingers = new Map();
let moved = false;
svg.addEventListener("pointerdown", (event) => {
  if (fingers.size === 0) moved = false;
  fingers.set(event.pointerId, event);
});
svg.addEventListener("pointermove", (event) => {
  const before = fingers.get(event.pointerId);
  if (!before) return;
  if (!moved && Math.hypot(event.clientX - before.clientX, event.clientY - before.clientY) < 4) return;
  moved = true;
  svg.setPointerCapture(event.pointerId);
  svg.classList.add("dragged");
  const [from, to] = [point(before), point(event)];
  const other = [...fingers.values()].find((finger) => finger.pointerId !== event.pointerId);
  if (other) {
    const fixed = point(other);
    const apart = (finger) => Math.hypot(finger.x - fixed.x, finger.y - fixed.y);
    if (apart(to) > 0) zoom(apart(from) / apart(to), fixed);
  } else {
    move(from.x - to.x, from.y - to.y);
  }
  fingers.set(event.pointerId, event);
});
for (const end of ["pointerup", "pointercancel"]) {
  svg.addEventListener(end, (event) => { fingers.delete(event.pointerId); svg.classList.remove("dragged"); });
}
svg.addEventListener("keydown", (event) => {
  const step = seen[2] / 8;
  const does = {
    "+": () => zoom(0.8), "-": () => zoom(1.25), 0: () => look(whole), Escape: () => pin(null),
    ArrowLeft: () => move(-step, 0), ArrowRight: () => move(step, 0), ArrowUp: () => move(0, -step), ArrowDown: () => move(0, step),
  }[event.key];
  if (!does || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  does();
});
document.getElementById("in").addEventListener("click", () => zoom(0.6));
document.getElementById("out").addEventListener("click", () => zoom(1 / 0.6));
document.getElementById("fit").addEventListener("click", () => look(whole));
window.addEventListener("resize", () => look(seen));

// ---- Search: the id of an edge, else of a node, on any level ----

document.getElementById("search").addEventListener("submit", (event) => {
  event.preventDefault();
  const id = document.getElementById("find").value.trim(), answer = document.getElementById("answer");
  const edge = data.edges.findIndex((edge) => edge.id === id), node = data.nodes.find((node) => node.id === id);
  const found = data.edges[edge] ?? node;
  answer.textContent = found ? "" : `no edge or node "${id}"`;
  if (!found) return;
  if (Number(level.value) !== found.level) { level.value = found.level; draw(); }
  document.querySelectorAll(".found").forEach((found) => found.classList.remove("found"));
  let box;
  if (edge >= 0) {
    pin(edge);
    box = overlay.querySelector(".chosen").getBBox();
  } else {
    nodes.get(id).classList.add("found");
    box = { x: node.x, y: node.y, width: 0, height: 0 };
  }
  const size = Math.max(box.width, box.height, 10 * STEPS * data.radius) * 2;
  look([box.x + box.width / 2 - size / 2, -(box.y + box.height / 2) - size / 2, size, size]);
});

data.levels.forEach((name, k) => { text(level, "option", name === "" ? "1" : name).value = String(k); });
document.getElementById("level-label").hidden = data.levels.length < 2;
document.getElementById("summary").textContent =
  data.edges.length + " edges, " + data.nodes.length + " nodes, " + packed.length / 6 + " locks for " +
  (data.footprint.length > 0 ? "a footprint of " + data.footprint.length + " corners" : "a disc of " + data.radius + " m");
level.addEventListener("change", draw);
choice.addEventListener("change", () => pin(choice.value === "" ? null : Number(choice.value)));
draw();
look(whole);
