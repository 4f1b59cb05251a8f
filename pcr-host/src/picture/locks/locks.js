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

// What every edge blocks: the other edge, the own lengths, the other's lengths.
const blocks = data.edges.map(() => []);
for (const [a, b, own, other] of data.locks) {
  blocks[a].push([b, own, other]);
  blocks[b].push([a, other, own]);
}

// Edges that lie on the same line, in either direction: the pointer reaches the last of them only.
const lines_of = new Map();
const line_of = data.edges.map((edge, k) => {
  const key = edge.level + [edge.path, edge.back].sort().join();
  if (!lines_of.has(key)) lines_of.set(key, []);
  lines_of.get(key).push(k);
  return lines_of.get(key);
});

svg.setAttribute("viewBox", data.bounds.join(" "));
// Metres to steps of a millimetre; y points up.
const STEPS = 1000;
const world = make(svg, "g", { transform: "scale(1 -1)" });
const corridors = make(world, "g", { class: "corridors" });
const lines = make(world, "g", {});
const overlay = make(world, "g", { "pointer-events": "none" });
const targets = make(world, "g", {});
let pinned = null;

function range([from, to]) {
  return from.toFixed(3) + " – " + to.toFixed(3);
}

function show(k) {
  overlay.replaceChildren();
  about.replaceChildren();
  choice.value = k === null ? "" : String(k);
  if (k === null) {
    text(about, "p", "Point at an edge to see its corridor (blue) and what it blocks (red); click to keep it, again for the next edge on the same line.");
    return;
  }
  const edge = data.edges[k];
  const corridor = make(overlay, "g", { class: "corridor" });
  for (const [d, width] of edge.corridor) make(corridor, "path", { d, "stroke-width": width });
  for (const [other, , lengths] of blocks[k]) {
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
    same.forEach((other) => {
      const button = text(list, "button", data.edges[other].id);
      button.addEventListener("click", () => { pinned = other; show(other); });
    });
  }
  text(about, "p", "From node " + edge.ends[0] + " to node " + edge.ends[1] + ", " + edge.length.toFixed(3) + " m. Blocks " +
    new Set(blocks[k].map(([other]) => other)).size + " edges:");
  const table = text(about, "table", "");
  const head = text(text(table, "thead", ""), "tr", "");
  for (const title of ["edge", "on it [m]", "on this one [m]"]) text(head, "th", title);
  const body = text(table, "tbody", "");
  for (const [other, own, lengths] of blocks[k]) {
    const row = text(body, "tr", "");
    text(row, "td", data.edges[other].id);
    text(row, "td", range(lengths));
    text(row, "td", range(own));
    row.addEventListener("click", () => { pinned = other; show(other); });
  }
}

function draw() {
  const at = Number(level.value);
  corridors.replaceChildren();
  lines.replaceChildren();
  targets.replaceChildren();
  choice.replaceChildren();
  text(choice, "option", "none").value = "";
  data.edges.forEach((edge, k) => {
    if (edge.level !== at) return;
    text(choice, "option", edge.id).value = String(k);
    if (edge.path === "") return;
    for (const [d, width] of edge.corridor) make(corridors, "path", { d, "stroke-width": width });
    make(lines, "path", { d: edge.path, class: "edge" });
    const target = make(targets, "path", { d: edge.path, class: "target" });
    target.addEventListener("pointerenter", () => { if (pinned === null) show(k); });
    target.addEventListener("pointerleave", () => { if (pinned === null) show(null); });
    target.addEventListener("click", (event) => {
      event.stopPropagation();
      const same = line_of[k];
      pinned = same.includes(pinned) ? same[(same.indexOf(pinned) + 1) % same.length] : k;
      show(pinned);
    });
  });
  for (const node of data.nodes) {
    if (node.level === at) make(lines, "circle", { cx: node.x, cy: node.y, r: 0.2 * STEPS * data.radius, class: "node" });
  }
  pinned = null;
  show(null);
}

data.levels.forEach((name, k) => { text(level, "option", name === "" ? "1" : name).value = String(k); });
document.getElementById("level-label").hidden = data.levels.length < 2;
document.getElementById("summary").textContent =
  data.edges.length + " edges, " + data.nodes.length + " nodes, " + data.locks.length + " locks for " +
  (data.footprint.length > 0 ? "a footprint of " + data.footprint.length + " corners" : "a disc of " + data.radius + " m");
level.addEventListener("change", draw);
choice.addEventListener("change", () => { pinned = choice.value === "" ? null : Number(choice.value); show(pinned); });
svg.addEventListener("click", () => { pinned = null; show(null); });
draw();
