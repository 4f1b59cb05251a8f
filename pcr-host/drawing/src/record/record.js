"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const $ = (id) => document.getElementById(id);
const { agents, pairs, unit, timeUnit, angleUnit, between } = data;
let pair, first = 0, last = 0, now = 0, playing = false, before = 0;

// The colours of the page, light or dark.
const theme = {}, dark = matchMedia("(prefers-color-scheme: dark)");
function readTheme() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ["paper", "ink", "dim", "grid", "own", "hit", "accent", "stone", "edge"]) theme[name] = style.getPropertyValue("--" + name).trim();
  theme.agents = agents.map(({ colour }) => (dark.matches ? `color-mix(in oklab, ${colour} 68%, white)` : colour));
}

/** Seconds of a pose. */
const at = ({ t }, k) => t[k] * timeUnit;
const point = ({ points }, k) => [points[2 * k] * unit, points[2 * k + 1] * unit];
const mapOf = ({ maps }, k) => maps.findLast(([from]) => from <= k)?.[1];
for (const { track } of agents) track.cutSet = new Set(track.cuts);

/** The index of the last pose that is not after a time; -1 before the first one. */
function poseBefore({ t }, time) {
  let [low, high] = [0, t.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (t[middle] * timeUnit <= time + 1e-9) low = middle + 1; else high = middle;
  }
  return low - 1;
}

/** Where an agent would be at a time if it went straight, and how far it may be from there; undefined where nothing is known. */
function place(agent, time) {
  const { track } = agents[agent], count = track.t.length;
  if (!count) return undefined;
  let k = poseBefore(track, time);
  const stands = (k) => ({ at: point(track, k), heading: track.headings[k] * angleUnit, off: (between.deviation ?? 0) + (track.errors[k] ?? 0) * unit, map: mapOf(track, k) });
  if (k < 0) return data.stands ? stands(0) : undefined;
  if (k === count - 1) return data.stands || time <= at(track, k) + 1e-9 ? stands(k) : undefined;
  if (track.cutSet.has(k + 1)) return time <= at(track, k) + 1e-9 ? stands(k) : undefined;
  const [from, to] = [at(track, k), at(track, k + 1)], part = (time - from) / (to - from);
  const [a, b] = [point(track, k), point(track, k + 1)];
  const error = Math.max(track.errors[k] ?? 0, track.errors[k + 1] ?? 0) * unit;
  let off = between.deviation ?? 0;
  if (between.speed !== undefined) {
    const u = Math.hypot(b[0] - a[0], b[1] - a[1]) / (to - from), since = time - from, until = to - time;
    off = Math.min(Math.sqrt(Math.max(0, between.speed ** 2 - u ** 2) * since * until), (between.speed + u) * Math.min(since, until));
  }
  const turn = (track.headings[k + 1] - track.headings[k]) * angleUnit, short = turn - 2 * Math.PI * Math.round(turn / 2 / Math.PI);
  return {
    at: [0, 1].map((axis) => a[axis] + part * (b[axis] - a[axis])),
    heading: track.headings[k] * angleUnit + part * short, off: off + error, map: mapOf(track, k),
  };
}

/** The time of the pair, and what is seen of the plane: where both were around its nearest approach. */
function choose(k, approach = 0) {
  pair = pairs[k];
  $("pair").value = k;
  $("approach").replaceChildren();
  pair?.approaches.forEach(({ t, verdict }, n) => option($("approach"), `${outward(t, 1).join(" to ")} s: ${verdict === "contact" ? "contact" : "not known"}`, n));
  if (pair && !pair.approaches.length) option($("approach"), "contact excluded", 0);
  $("approach").value = approach;
  [first, last] = pair ? pair.time : [0, 0];
  $("time").max = Math.max(1, Math.round((last - first) * 100));
  show(moment(approach));
}

/** A moment before an approach: when a contact is no longer excluded, or when both are nearest. */
function moment(approach) {
  const found = pair?.approaches[approach];
  return found ? found.t[0] : pair?.closest?.t ?? first;
}

function show(time) {
  now = Math.min(last, Math.max(first, time));
  draw();
}

/** The part of the plane that is seen: the pair, with room around it [m]. */
function view() {
  const seen = pair.agents.map((agent) => place(agent, now)).filter(Boolean);
  if (!seen.length) return undefined;
  const radius = Math.max(...pair.agents.map((agent) => agents[agent].radius));
  const middle = [0, 1].map((axis) => seen.reduce((sum, { at }) => sum + at[axis], 0) / seen.length);
  const far = Math.max(...seen.map(({ at }) => Math.hypot(at[0] - middle[0], at[1] - middle[1])));
  // In steps, so that the picture does not breathe.
  const half = 2 ** (Math.ceil(2 * Math.log2(1.3 * far + 4 * radius)) / 2);
  return { middle, half, map: seen[0].map };
}

/** The outline of a body, wider by some pixels all around. */
function shape(c, agent, [x, y], heading, scale, more = 0) {
  const { body, radius } = agents[agent];
  c.beginPath();
  if (!body) { c.arc(x, y, radius * scale + more, 0, 7); return; }
  const [cos, sin] = [Math.cos(heading), Math.sin(heading)];
  body.forEach(([ahead, left]) => c.lineTo(x + (ahead * cos - left * sin) * scale, y - (ahead * sin + left * cos) * scale));
  c.closePath();
}

/** Poses and the ways between them, some time before and after now. */
function drawTrack(c, agent, x, y, map) {
  const { track } = agents[agent], from = Math.max(0, poseBefore(track, now - 20)), to = Math.min(track.t.length - 1, poseBefore(track, now + 20) + 1);
  c.strokeStyle = c.fillStyle = theme.agents[agent];
  c.lineWidth = 1;
  c.beginPath();
  for (let k = from; k <= to; k++) {
    const [px, py] = point(track, k);
    if (k === from || track.cutSet.has(k) || mapOf(track, k) !== map) c.moveTo(x(px), y(py)); else c.lineTo(x(px), y(py));
  }
  c.stroke();
  for (let k = from; k <= to && to - from < 300; k++) {
    if (mapOf(track, k) !== map) continue;
    const [px, py] = point(track, k);
    c.beginPath();
    c.arc(x(px), y(py), 2, 0, 7);
    c.fill();
  }
}

function drawWorld() {
  const [c, width, height] = surface("world"), seen = pair && view();
  if (!seen) return;
  const scale = Math.min(width, height) / 2 / seen.half, { middle, map } = seen;
  const x = (value) => width / 2 + (value - middle[0]) * scale, y = (value) => height / 2 - (value - middle[1]) * scale;
  const inPair = (agent) => pair.agents.includes(agent), crowd = new Crowd(), drawn = [];
  const order = agents.map((_, k) => k).sort((a, b) => inPair(a) - inPair(b));
  for (const agent of order) {
    const found = place(agent, now);
    if (!found || found.map !== map) continue;
    const centre = [x(found.at[0]), y(found.at[1])], r = agents[agent].radius * scale;
    if (centre[0] < -r || centre[0] > width + r || centre[1] < -r || centre[1] > height + r) continue;
    if (inPair(agent)) drawTrack(c, agent, x, y, map);
    shape(c, agent, centre, found.heading, scale);
    c.fillStyle = c.strokeStyle = theme.agents[agent];
    c.globalAlpha = inPair(agent) ? 0.55 : 0.25;
    c.fill();
    c.globalAlpha = 1;
    c.lineWidth = inPair(agent) ? 2.5 : 1;
    c.stroke();
    if (inPair(agent) && found.off > 0) {
      // Where its reference point may be.
      c.setLineDash([4, 3]);
      c.lineWidth = 1.3;
      c.beginPath();
      c.arc(...centre, found.off * scale, 0, 7);
      c.stroke();
      c.setLineDash([]);
    }
    crowd.take([centre[0] - r, centre[1] - r, centre[0] + r, centre[1] + r], agent);
    drawn.push([agent, [...centre, r]]);
  }
  for (const [agent, disc] of drawn.reverse()) write(c, crowd, agents[agent].name, disc, agent, inPair(agent));
  drawScale(c, width, height, scale);
}

function draw() {
  $("time").value = Math.round((now - first) * 100);
  $("clock").textContent = pair ? `${now.toFixed(2)} s` : "";
  drawWorld();
  drawNearness();
}

function tick(stamp) {
  if (playing && before && pair) {
    const next = now + (stamp - before) / 1000 * Number($("pace").value);
    if (next >= last) play(false);
    show(next);
  }
  before = stamp;
  requestAnimationFrame(tick);
}

function play(on) {
  playing = on;
  if (on && now >= last) now = first;
  $("play").textContent = on ? "Pause" : "Play";
}
