"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const $ = (id) => document.getElementById(id);
const { robots, obstacles, frame, unit, angleUnit } = data;
let run, frames, now = 0, playing = false, before = 0;

// The colours of the page, light or dark.
const theme = {}, dark = matchMedia("(prefers-color-scheme: dark)");
function readTheme() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ["paper", "ink", "grid", "own", "hit", "accent", "stone", "edge"]) theme[name] = style.getPropertyValue("--" + name).trim();
  theme.robots = robots.map(({ colour }) => (dark.matches ? `color-mix(in oklab, ${colour} 68%, white)` : colour));
}

data.runs.forEach((run, k) => option($("run"), run.controller, k));
robots.forEach((robot, k) => option($("ego"), robot.name, k));

const bounds = (() => {
  const box = [Infinity, -Infinity, Infinity, -Infinity];
  const grow = (x, y, r) => {
    box[0] = Math.min(box[0], x - r); box[1] = Math.max(box[1], x + r);
    box[2] = Math.min(box[2], y - r); box[3] = Math.max(box[3], y + r);
  };
  obstacles.forEach(({ at: [x, y], radius }) => grow(x, y, radius));
  robots.forEach(({ ways, radius }) => ways.forEach((way) => { for (let i = 0; i < way.length; i += 2) grow(way[i] * unit, way[i + 1] * unit, radius); }));
  data.runs.forEach((run) => run.tracks.forEach((track, k) => {
    for (let i = 0; i < track.length; i += 2) grow(track[i] * unit, track[i + 1] * unit, robots[k].radius);
  }));
  if (!(box[0] <= box[1])) return [-1, 1, -1, 1];
  const pad = 0.04 * Math.max(box[1] - box[0], box[3] - box[2]);
  return [box[0] - pad, box[1] + pad, box[2] - pad, box[3] + pad];
})();

const centre = [(bounds[0] + bounds[1]) / 2, (bounds[2] + bounds[3]) / 2];

/** All ways, seen from the centre: far from the origin a browser would round them. */
const ground = new Path2D();
for (const way of robots.flatMap((robot) => robot.ways)) {
  way.forEach((_, i) => {
    if (i % 2) return;
    const point = [way[i] * unit - centre[0], way[i + 1] * unit - centre[1]];
    if (i) ground.lineTo(...point); else ground.moveTo(...point);
  });
}

function choose() {
  run = data.runs[$("run").value];
  frames = run ? Math.max(1, ...run.tracks.map((track) => track.length / 2)) - 1 : 0;
  $("time").max = frames;
  now = Math.min(now, frames);
  // The room is for the robots where there is no map.
  $("map").parentElement.hidden = !run?.plans.length;
}

/** Between two frames a robot moves uniformly. */
function position(robot, at) {
  const track = run.tracks[robot], last = track.length / 2 - 1;
  const k = Math.min(Math.floor(at), last), next = Math.min(k + 1, last), part = Math.min(at - k, 1);
  return [0, 1].map((axis) => unit * (track[2 * k + axis] * (1 - part) + track[2 * next + axis] * part));
}

/** The heading of a robot that is no disc in this run, between two frames [rad]; undefined of others. */
function heading(robot, at) {
  const track = run.headings[robot], last = track.length - 1;
  if (last < 0) return undefined;
  const k = Math.min(Math.floor(at), last), next = Math.min(k + 1, last);
  return angleUnit * (track[k] + (track[next] - track[k]) * Math.min(at - k, 1));
}

/** Begins the path of a disc around a place in pixels or, if it has a heading, of a body with rounded corners. */
function shape(c, [x, y, r], body, heading, scale) {
  c.beginPath();
  if (!body || heading === undefined) {
    c.arc(x, y, r, 0, 7);
    return;
  }
  const [cos, sin] = [Math.cos(heading), Math.sin(heading)], corners = body.corners, count = corners.length;
  const normal = ([a, b], [u, v]) => Math.atan2(a - u, v - b) + heading;
  corners.forEach(([ahead, left], k) => {
    const before = normal(corners[(k + count - 1) % count], corners[k]), after = normal(corners[k], corners[(k + 1) % count]);
    const at = [x + (ahead * cos - left * sin) * scale, y - (ahead * sin + left * cos) * scale];
    // On the screen y points down.
    c.arc(...at, body.radius * scale, -before, -after, true);
  });
  c.closePath();
}

function colliding(id, time) {
  return run.collisions.some(([i, j, t]) => (i === id || j === id) && t[0] <= time && time <= t[1]);
}

function drawWorld() {
  const [c, width, height] = surface("world");
  const scale = Math.min(width / (bounds[1] - bounds[0]), height / (bounds[3] - bounds[2]));
  const x = (value) => width / 2 + (value - centre[0]) * scale;
  const y = (value) => height / 2 - (value - centre[1]) * scale;
  const ego = Number($("ego").value);
  c.fillStyle = theme.stone;
  obstacles.forEach(({ at: [px, py], radius, body, heading }) => { shape(c, [x(px), y(py), radius * scale], body, heading, scale); c.fill(); });
  c.save();
  c.translate(width / 2, height / 2);
  c.scale(scale, -scale);
  c.lineWidth = 1 / scale;
  c.strokeStyle = theme.stone;
  c.stroke(ground);
  c.restore();
  for (const journey of run.journeys) {
    if (journey.begin > now || (journey.end ?? Infinity) < now) continue;
    const way = robots[journey.robot].ways[journey.way];
    c.strokeStyle = theme.robots[journey.robot];
    c.lineWidth = journey.robot === ego ? 2.5 : 1.3;
    c.beginPath();
    for (let i = 0; i < way.length; i += 2) c.lineTo(x(way[i] * unit), y(way[i + 1] * unit));
    c.stroke();
    // Dashes of a small circle would be dots.
    const { radius, body } = robots[journey.robot], end = [x(way.at(-2) * unit), y(way.at(-1) * unit), radius * scale];
    c.setLineDash(radius * scale < 6 ? [2, 2] : [4, 3]);
    shape(c, end, body, heading(journey.robot, Math.min(journey.end ?? Infinity, frames)), scale);
    c.stroke();
    c.setLineDash([]);
  }
  const crowd = new Crowd(), hits = robots.map(({ id }) => colliding(id, now * frame));
  const discs = robots.map(({ radius }, k) => { const [px, py] = position(k, now); return [x(px), y(py), Math.max(3, radius * scale)]; });
  // Whom somebody looks for, and who is in trouble, above the others, and with numbers before them.
  const rank = (k) => (k === ego ? 2 : hits[k] ? 1 : 0);
  const order = robots.map((_, k) => k).sort((a, b) => rank(a) - rank(b));
  for (const k of order) {
    const [px, py, r] = discs[k];
    crowd.take([px - r, py - r, px + r, py + r], k);
    shape(c, discs[k], r > 3 && robots[k].body, heading(k, now), scale);
    c.fillStyle = c.strokeStyle = hits[k] ? theme.hit : theme.robots[k];
    // Small ones would be pale on their lines.
    c.globalAlpha = hits[k] || r < 8 ? 0.8 : 0.5;
    c.fill();
    c.globalAlpha = 1;
    c.lineWidth = k === ego ? 3 : 1.5;
    if (k === ego) c.strokeStyle = hits[k] ? theme.hit : theme.own;
    c.stroke();
  }
  for (const k of order.reverse()) write(c, crowd, robots[k].id, discs[k], k, k === ego);
  drawScale(c, width, height, scale);
}

function drawMap() {
  if (!run.plans.length) return;
  const ego = Number($("ego").value), time = now * frame;
  const plan = run.plans.findLast((plan) => plan.time <= time + 1e-9), map = plan && plan.maps[ego];
  const [c, width, height] = surface("map");
  if (!map || !(map.to > map.from)) {
    const begun = run.journeys.some((journey) => journey.robot === ego && journey.begin <= now && !((journey.end ?? Infinity) <= now));
    $("caption").textContent = !plan ? "There is no plan yet." : !begun ? "This robot stands: it has no mission now."
      : `This robot has a mission, but no motion in the plan of ${plan.time.toFixed(2)} s: it stands where it is.`;
    return;
  }
  const [left, top, right, bottom] = [52, 12, width - 12, height - 40];
  const [t0, t1] = [plan.time, Math.max(plan.end, plan.time + 1)];
  const pad = 0.03 * (map.to - map.from), [l0, l1] = [map.from - pad, map.to + pad];
  const x = (t) => left + (t - t0) / (t1 - t0) * (right - left), y = (l) => bottom - (l - l0) / (l1 - l0) * (bottom - top);
  drawAxes(c, [left, top, right, bottom], [x, [t0, t1], "time [s]"], [y, [l0, l1], "length along the path [m]"]);
  c.save();
  c.beginPath();
  c.rect(left, top, right - left, bottom - top);
  c.clip();
  const labels = [];
  for (const region of map.regions) {
    const points = region.outline.flat();
    if (points.length > 0) labels.push([robots[region.other].id, ...[0, 1].map((axis) => (Math.min(...points.map((p) => p[axis])) + Math.max(...points.map((p) => p[axis]))) / 2)]);
    c.fillStyle = c.strokeStyle = theme.robots[region.other];
    c.beginPath();
    for (const contour of region.outline) { contour.forEach(([t, l], k) => (k ? c.lineTo(x(t), y(l)) : c.moveTo(x(t), y(l)))); c.closePath(); }
    c.globalAlpha = 0.3;
    c.fill("evenodd");
    for (const [a, b, lo, hi] of region.strips) c.fillRect(x(a), y(hi), x(b) - x(a), y(lo) - y(hi));
    c.globalAlpha = 1;
    c.stroke();
  }
  const crowd = new Crowd();
  for (const [label, t, l] of labels) write(c, crowd, label, [x(t), y(l), Infinity]);
  c.strokeStyle = theme.own;
  c.lineWidth = 1.5;
  c.setLineDash([6, 4]);
  c.beginPath();
  map.curve.forEach(([t, l]) => c.lineTo(x(t), y(l)));
  c.stroke();
  c.setLineDash([]);
  c.lineWidth = 2.5;
  c.beginPath();
  const travelled = run.travelled[ego], first = Math.round(plan.time / frame);
  // Lengths count from the begin of a mission. That of its first frame is still the length of the mission before it.
  const begins = new Set(run.journeys.filter((journey) => journey.robot === ego).map((journey) => journey.begin));
  for (let k = first; k <= now && k < travelled.length; k++) {
    const again = begins.has(k) && travelled[k] > 0;
    if (again && k > first) break;
    c.lineTo(x(k * frame), y(again ? 0 : travelled[k] * unit));
  }
  c.stroke();
  c.strokeStyle = theme.accent;
  c.lineWidth = 1.3;
  c.beginPath();
  c.moveTo(x(time), top);
  c.lineTo(x(time), bottom);
  c.stroke();
  c.restore();
  $("caption").textContent = `Collision map of robot ${robots[ego].name}, as planned at ${plan.time.toFixed(2)} s. Coloured: where and when it would come too near to the robot of that number; `
    + "the margins for errors are included. Dashed: its planned motion. Solid: its real motion. Vertical line: now.";
}

function draw() {
  if (!run) return;
  $("time").value = now;
  $("clock").textContent = `${(now * frame).toFixed(2)} s`;
  const done = run.journeys.filter((journey) => (journey.end ?? Infinity) <= now).length;
  const hits = run.collisions.filter(([, , t]) => t[0] <= now * frame).length;
  $("score").textContent = `${done} of ${run.journeys.length} missions done; collisions so far: ${hits}. Mean time of a mission in this run: ${run.travel.toFixed(1)} s.`
    + (run.plans.length ? "" : ` ${run.controller === "pcr" ? "No plan was found" : "This controller makes no plans"}: there is no collision map.`)
    + (robots.length > 12 ? " Numbers for which there is no room are left out." : "");
  drawWorld();
  drawMap();
}

function tick(stamp) {
  if (playing && before) {
    now += (stamp - before) / 1000 / frame * Number($("pace").value);
    if (now >= frames) { now = frames; play(false); }
    draw();
  }
  before = stamp;
  requestAnimationFrame(tick);
}

function play(on) {
  playing = on;
  if (on && now >= frames) now = 0;
  $("play").textContent = on ? "Pause" : "Play";
}

$("play").onclick = () => play(!playing);
$("time").oninput = () => { now = Number($("time").value); draw(); };
$("run").onchange = () => { choose(); draw(); };
$("ego").onchange = draw;
window.onresize = draw;
dark.addEventListener("change", () => { readTheme(); draw(); });
readTheme();
choose();
$("summary").textContent = `${robots.length} robots, ${(frames * frame).toFixed(0)} s`;
// A link may say where to begin, #40 is 40 s; nothing moves by itself for those who asked their system for that.
if (location.hash) now = Math.min(frames, Number(location.hash.slice(1)) / frame || 0);
play(!location.hash && !matchMedia("(prefers-reduced-motion: reduce)").matches);
draw();
requestAnimationFrame(tick);
