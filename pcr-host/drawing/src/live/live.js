"use strict";
const $ = (id) => document.getElementById(id);
let layout = { name: "", lanes: [] }, state = null, paused = false, since = null;

// The colours of the page, light or dark.
const theme = {}, dark = matchMedia("(prefers-color-scheme: dark)");
function readTheme() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ["paper", "ink", "grid", "hit", "accent", "dim", "edge"]) theme[name] = style.getPropertyValue("--" + name).trim();
}
const hue = (k) => `hsl(${(k * 137.5) % 360} 70% ${dark.matches ? 65 : 38}%)`;

/** Points [x, y, length, heading] along shapes. */
function points({ start, shapes }) {
  let { x, y, heading } = start, length = 0;
  const all = [[x, y, 0, heading]];
  for (const shape of shapes) {
    if (shape.kind === "turn") {
      const steps = Math.max(1, Math.ceil(Math.abs(shape.sweep) / 0.1)), part = (shape.lever ?? 0) * Math.abs(shape.sweep) / steps;
      for (let k = 0; k < steps; k++) { heading += shape.sweep / steps; length += part; all.push([x, y, length, heading]); }
      continue;
    }
    if (shape.kind === "shift") {
      const long = Math.hypot(shape.ahead, shape.left), way = heading + Math.atan2(shape.left, shape.ahead);
      x += long * Math.cos(way); y += long * Math.sin(way); length += long;
      all.push([x, y, length, heading]);
      continue;
    }
    const long = shape.kind === "line" ? shape.length : shape.radius * Math.abs(shape.sweep);
    const steps = shape.kind === "line" ? 1 : Math.max(2, Math.ceil(Math.abs(shape.sweep) / 0.1));
    const bend = shape.kind === "line" ? 0 : shape.sweep / steps;
    for (let k = 0; k < steps; k++) {
      const part = long / steps, chord = bend ? 2 * shape.radius * Math.sin(Math.abs(bend) / 2) : part;
      x += chord * Math.cos(heading + bend / 2); y += chord * Math.sin(heading + bend / 2);
      heading += bend; length += part;
      all.push([x, y, length, heading]);
    }
  }
  return all;
}
/** The part of points between two lengths. */
function part(all, from, to) {
  const at = (length) => {
    const k = all.findIndex((point) => point[2] >= length);
    if (k <= 0) return k === 0 ? all[0] : all[all.length - 1];
    const [a, b] = [all[k - 1], all[k]], t = (length - a[2]) / (b[2] - a[2] || 1);
    return [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), length, a[3] + t * (b[3] - a[3])];
  };
  return [at(from), ...all.filter((point) => point[2] > from && point[2] < to), at(to)];
}

function surface() {
  const canvas = $("world"), ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return [context, width, height];
}

function draw() {
  const [c, width, height] = surface(), robots = state ? state.robots : [];
  const lanes = layout.lanes.map(({ start, path }) => points({ start, shapes: path })), paths = robots.map(points), areas = (state?.closures ?? []).flatMap(({ start, path, radius, speed, more = [] }) => [{ start, path }, ...more].map((it) => ({ all: points({ start: it.start, shapes: it.path }), radius, speed }))), closed = areas.map(({ all }) => all);
  const box = [Infinity, -Infinity, Infinity, -Infinity];
  for (const [x, y] of [...lanes, ...closed, ...paths].flat()) {
    box[0] = Math.min(box[0], x); box[1] = Math.max(box[1], x); box[2] = Math.min(box[2], y); box[3] = Math.max(box[3], y);
  }
  if (!(box[0] <= box[1])) return;
  const pad = 0.05 * Math.max(box[1] - box[0], box[3] - box[2]) + 1;
  const scale = Math.min(width / (box[1] - box[0] + 2 * pad), height / (box[3] - box[2] + 2 * pad));
  const x = (value) => width / 2 + (value - (box[0] + box[1]) / 2) * scale, y = (value) => height / 2 - (value - (box[2] + box[3]) / 2) * scale;
  const line = (all) => { c.beginPath(); all.forEach((point, k) => (k ? c.lineTo(x(point[0]), y(point[1])) : c.moveTo(x(point[0]), y(point[1])))); c.stroke(); };
  c.lineCap = "round";
  c.strokeStyle = theme.grid;
  c.lineWidth = 3;
  lanes.forEach(line);
  c.strokeStyle = theme.hit;
  areas.forEach(({ all, radius, speed }) => { c.globalAlpha = speed ? 0.1 : 0.25; c.lineWidth = Math.max(3, 2 * radius * scale); line(all.length > 1 ? all : [all[0], all[0]]); });
  c.globalAlpha = 1;
  const ego = $("ego").value, place = new Map();
  robots.forEach((robot, k) => {
    const colour = robot.alarm ? theme.hit : hue(k), all = paths[k];
    c.strokeStyle = c.fillStyle = colour;
    c.globalAlpha = ego && ego !== robot.robot ? 0.35 : 1;
    c.lineWidth = 1;
    line(part(all, robot.at[0], robot.length));
    c.setLineDash([4, 4]);
    c.lineWidth = 2;
    line(part(all, robot.hold, Math.max(robot.hold, robot.wanted)));
    c.setLineDash([]);
    c.lineWidth = 4;
    line(part(all, robot.at[0], robot.hold));
    const lost = robot.alarm && "x" in robot.alarm;
    const [px, py, , heading] = lost ? [robot.alarm.x, robot.alarm.y] : part(all, robot.at[0], robot.at[1]).at(-1);
    place.set(robot.robot, [px, py]);
    c.globalAlpha *= 0.8;
    c.beginPath();
    if (robot.footprint && !robot.any_heading && !lost && robot.radius * scale > 3) {
      const [cos, sin] = [Math.cos(heading), Math.sin(heading)], { polygon, growth } = robot.footprint;
      polygon.forEach(({ ahead, left }) => c.lineTo(x(px + ahead * cos - left * sin), y(py + ahead * sin + left * cos)));
      c.closePath();
      if (growth) { c.lineJoin = "round"; c.lineWidth = 2 * growth * scale; c.stroke(); }
    } else {
      c.arc(x(px), y(py), Math.max(3, robot.radius * scale), 0, 7);
    }
    c.fill();
    c.globalAlpha = 1;
  });
  c.strokeStyle = theme.dim;
  c.lineWidth = 1;
  for (const robot of robots) {
    const [from, to] = [place.get(robot.robot), place.get(robot.stopped_for ?? robot.waits_for)];
    if (!from || !to) continue;
    const [ax, ay, bx, by] = [x(from[0]), y(from[1]), x(to[0]), y(to[1])], angle = Math.atan2(by - ay, bx - ax);
    c.beginPath(); c.moveTo(ax, ay); c.lineTo(bx, by);
    for (const side of [2.7, -2.7]) { c.moveTo(bx, by); c.lineTo(bx + 9 * Math.cos(angle + side), by + 9 * Math.sin(angle + side)); }
    c.stroke();
  }
  drawScale(c, width, height, scale);
  names(c, robots.map((robot) => [robot.robot, ...place.get(robot.robot).map((value, axis) => [x, y][axis](value)), Math.max(3, robot.radius * scale) + 2]), width);
}

/** Names beside their robots, below one another where they would be on one another. */
function names(c, all, width) {
  const high = 13, taken = [];
  c.font = "12px system-ui";
  c.textAlign = "left";
  c.lineWidth = 3;
  c.lineJoin = "round";
  [c.fillStyle, c.strokeStyle] = [theme.ink, theme.paper];
  for (const [text, px, py, beside] of all) {
    const wide = c.measureText(text).width, left = px + beside + wide < width ? px + beside : px - beside - wide;
    const free = (top) => taken.every(([l, t, w]) => left > l + w || l > left + wide || Math.abs(top - t) >= high);
    const top = [0, 1, -1, 2, -2, 3, -3].map((k) => py - 2 + k * high).find(free) ?? py - 2;
    taken.push([left, top, wide]);
    c.strokeText(text, left, top);
    c.fillText(text, left, top);
  }
}

function says(robot) {
  const all = [];
  if (robot.alarm) all.push({ off: "off its path", back: "gone back" }[robot.alarm.why] ?? "beyond its hold");
  if (robot.stopped_for) all.push(`stopped for ${robot.stopped_for}`);
  if (robot.closure) all.push(`waits before ${robot.closure}`);
  if (robot.away) all.push("away, keeps its place");
  if (robot.silent) all.push("silent");
  if (robot.waits_for) all.push(`waits for ${robot.waits_for}`);
  if (robot.waiting) all.push(`${robot.waiting} waits`);
  return all.join(", ") || (robot.at[0] >= robot.length - 0.2 ? "there" : "goes");
}

function cells(row, texts) {
  while (row.cells.length < texts.length) row.insertCell();
  texts.forEach((text, k) => { if (row.cells[k].textContent !== text) row.cells[k].textContent = text; });
}

function show() {
  const body = $("robots").tBodies[0], ego = $("ego").value;
  // By name, 2 before 10.
  const sorted = [...state.robots].sort((a, b) => a.robot.localeCompare(b.robot, "en", { numeric: true }));
  sorted.forEach((robot, k) => {
    const row = body.rows[k] ?? body.insertRow(), at = robot.at;
    cells(row, [robot.robot, says(robot), outward(at, 1).join(" – "), outward([robot.hold, robot.hold], 1)[0], robot.length.toFixed(1), robot.mission ?? ""]);
    row.className = (robot.alarm || robot.stopped_for || robot.silent ? "bad " : "") + (robot.robot === ego ? "chosen" : "");
  });
  while (body.rows.length > state.robots.length) body.deleteRow(-1);
  const known = sorted.map((robot) => robot.robot), options = [...$("ego").options].slice(1).map((option) => option.value);
  if (known.join("\n") !== options.join("\n")) {
    $("ego").replaceChildren($("ego").options[0], ...known.map((name) => new Option(name, name)));
    $("ego").value = known.includes(ego) ? ego : "";
  }
  const events = $("events"), texts = state.events.slice(-30).reverse().map(({ time, text }) => `${time.toFixed(1)} s: ${text}`);
  if (events.firstChild?.textContent !== texts[0]) events.replaceChildren(...texts.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
  const away = state.away.filter((name) => !known.includes(name)), waits = [...(state.paused ? [state.paused] : []), ...state.unplaced, ...state.closures.map(({ closure }) => `${closure} is closed`), ...away.map((name) => `${name} is away`)];
  if ($("waits").textContent !== waits.join("; ")) $("waits").textContent = waits.join("; ");
  $("waits").className = state.paused || state.unplaced.length ? "bad" : "";
  since ??= { now: state.now, admitted: state.counts.admitted };
  const hours = (state.now - since.now) / 3600, rate = hours > 0.002 ? `, ${((state.counts.admitted - since.admitted) / hours).toFixed(0)} missions an hour` : "";
  $("summary").textContent = `${layout.name ? layout.name + ": " : ""}${known.length} robots, ${state.counts.admitted} missions admitted${rate}, ${state.counts.alarms} ${state.counts.alarms === 1 ? "alarm" : "alarms"}`;
  $("clock").textContent = `${state.now.toFixed(1)} s`;
  draw();
}

async function get(path) {
  const answer = await fetch(path, { cache: "no-store" });
  if (!answer.ok) throw new Error(await answer.text());
  return answer.json();
}
async function poll() {
  try {
    if (!paused) { state = await get("/state"); show(); }
  } catch (error) {
    $("summary").textContent = "The supervisor does not answer.";
  }
  setTimeout(poll, 500);
}
async function ground() {
  try { layout = await get("/layout"); } catch { /* poll says so */ }
  setTimeout(ground, 10000);
}
function picture() {
  const ego = $("ego").value;
  $("picture").hidden = !ego;
  if (ego && !paused) {
    $("map").src = `/map?robot=${encodeURIComponent(ego)}&${Date.now()}`;
    $("map").alt = `Collision map of ${ego}`;
  }
}
$("pause").onclick = () => { paused = !paused; $("pause").textContent = paused ? "Unfreeze page" : "Freeze page"; };
$("ego").onchange = () => { picture(); if (state) show(); };
dark.onchange = () => { readTheme(); draw(); };
window.onresize = draw;
setInterval(picture, 2000);
readTheme();
ground();
poll();
