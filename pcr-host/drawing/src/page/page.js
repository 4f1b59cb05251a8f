"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const $ = (id) => document.getElementById(id);
const agents = data.agents;
const [first, last] = data.horizon;
const state = { time: first, ego: busiest(), shown: agents.map(() => true), pinned: null };

function busiest() {
  // Of some agents there may be no map.
  const count = (k) => data.maps[k]?.regions.length ?? -1;
  let best = 0;
  data.maps.forEach((_, k) => { if (count(k) > count(best)) best = k; });
  return best;
}

// ---- Motion: the closed forms of the library ----

// Length travelled at a time, from the slow end of each phase, where nothing cancels.
function lengthAt(agent, time) {
  const t = time - agent.time[0];
  if (t <= 0 || agent.phases.length === 0) return 0;
  if (time >= agent.time[1]) return agent.length;
  const [from, duration, length, before, after, acceleration] =
    agent.phases.find(([from, duration]) => t <= from + duration) ?? agent.phases[agent.phases.length - 1];
  const slows = acceleration < 0;
  const elapsed = slows ? from + duration - t : t - from;
  const way = ((slows ? after : before) + Math.abs(acceleration) * elapsed / 2) * elapsed;
  const all = (before + after) / 2 * duration;
  return length + Math.min(Math.max(slows ? all - way : way, 0), all);
}

// Point, and heading of the body, at a length of the path: on an arc over its half chord.
function poseAt(agent, length) {
  let low = 0;
  for (let high = agent.segments.length; high - low > 1;) {
    const middle = (low + high) >> 1;
    if (agent.segments[middle][0] <= length) low = middle; else high = middle;
  }
  const [from, whole, x, y, heading, bend, lever] = agent.segments[low];
  const u = Math.min(Math.max(length - from, 0), whole);
  const facing = agent.facings?.[low] ?? 0;
  if (lever !== undefined) return [x, y, heading + u / lever + facing];
  if (bend === 0) return [x + u * Math.cos(heading), y + u * Math.sin(heading), heading + facing];
  const half = u / bend / 2;
  const chord = 2 * bend * Math.sin(half);
  const ahead = agent.steady?.[low] ? heading : heading + 2 * half;
  return [x + chord * Math.cos(heading + half), y + chord * Math.sin(heading + half), ahead + facing];
}

// Least distance of a point from the segment between two points.
function fromSegment([x, y], [ax, ay], [bx, by]) {
  const dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy;
  const share = square > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / square)) : 0;
  return Math.hypot(ax + share * dx - x, ay + share * dy - y);
}

// Least distance of two convex polygons, counter-clockwise; of one corner they are points. 0 where no side of either has the other beyond it.
function apart(a, b) {
  let least = Infinity, separated = a.length < 3 && b.length < 3;
  for (const [own, other] of [[a, b], [b, a]]) {
    own.forEach((from, k) => {
      const to = own[(k + 1) % own.length];
      for (const point of other) least = Math.min(least, fromSegment(point, from, to));
      if (own.length > 2 && other.every((point) => (to[0] - from[0]) * (point[1] - from[1]) < (to[1] - from[1]) * (point[0] - from[0]))) separated = true;
    });
  }
  return separated ? least : 0;
}

// Each convex part of an outline counts; those of a load on its lengths only.
function touch(a, [x, y, heading, along], b, [u, v, other, beside]) {
  if (Math.hypot(x - u, y - v) > a.radius + b.radius) return false;
  const placed = (agent, x, y, heading, length) => agent.parts.filter(([, , from, to]) => from - 1e-9 <= length && length <= to + 1e-9)
    .map(([corners, radius]) => [corners.map(([ahead, left]) =>
      [x + ahead * Math.cos(heading) - left * Math.sin(heading), y + ahead * Math.sin(heading) + left * Math.cos(heading)]), radius]);
  const others = placed(b, u, v, other, beside);
  return placed(a, x, y, heading, along).some(([corners, r]) => others.some(([them, s]) => apart(corners, them) <= r + s));
}

// ---- Drawing ----

function element(parent, name, attributes = {}, text) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text !== undefined) node.textContent = text;
  parent.append(node);
  return node;
}

function axis([lo, hi], from, to) {
  const at = (value) => from + (value - lo) / (hi - lo) * (to - from);
  const ticks = (gap) => {
    const coarsest = (hi - lo) / Math.abs(to - from) * gap;
    const power = 10 ** Math.floor(Math.log10(coarsest));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= coarsest) ?? 10 * power;
    const decimals = Math.min(20, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
    const count = Math.floor(hi / step + 1e-6) - Math.ceil(lo / step - 1e-6);
    const start = Math.ceil(lo / step - 1e-6);
    return Array.from({ length: Math.max(0, count + 1) }, (_, k) => {
      const value = (start + k) * step;
      return [value, value.toFixed(decimals).replace(/^-(?=[0.]*$)/, "").replace("-", "\u2212")];
    });
  };
  return { at, ticks };
}

// Plots are at most this wide and high: not much more than there is room for, so that letters are not scaled down.
const side = Math.min(700, Math.max(400, 1.2 * $("workspace").parentElement.clientWidth));
const room = { left: 34, top: 14, right: 14, bottom: 58 };

function frame(svg, xs, ys, width, height, titles) {
  svg.replaceChildren();
  const bottom = room.top + height;
  const y = axis(ys, bottom, room.top);
  const left = room.left + 9 * Math.max(0, ...y.ticks(56).map(([, label]) => label.length));
  const right = left + width, x = axis(xs, left, right);
  svg.setAttribute("viewBox", `0 0 ${right + room.right} ${bottom + room.bottom}`);
  for (const [value, label] of x.ticks(90)) {
    element(svg, "path", { class: "grid", d: `M${x.at(value)} ${room.top}V${bottom}` });
    element(svg, "text", { x: x.at(value), y: bottom + 20, "text-anchor": "middle" }, label);
  }
  for (const [value, label] of y.ticks(56)) {
    element(svg, "path", { class: "grid", d: `M${left} ${y.at(value)}H${right}` });
    element(svg, "text", { x: left - 7, y: y.at(value) + 5, "text-anchor": "end" }, label);
  }
  element(svg, "text", { class: "title", x: (left + right) / 2, y: bottom + 46, "text-anchor": "middle" }, titles[0]);
  const middle = (room.top + bottom) / 2;
  element(svg, "text",
    { class: "title", x: 16, y: middle, "text-anchor": "middle", transform: `rotate(-90 16 ${middle})` }, titles[1]);
  const content = element(svg, "g");
  element(svg, "rect", { class: "frame", x: left, y: room.top, width, height, "pointer-events": "none" });
  return { content, x, y, left, top: room.top, right, bottom };
}

const discs = [], numbers = [], paths = [];
let cursor = null;

// Width of a number with a gap beside it, before it is drawn.
const wide = (number) => 9 * number.length + 3;

// The heading of a pose as the screen turns it.
const degrees = ([, , heading]) => -heading * 180 / Math.PI;

function drawWorkspace() {
  const [x0, x1, y0, y1] = data.bounds;
  // Below this extent ticks could not be told apart.
  const extent = Math.max(x1 - x0, y1 - y0, 1e-6, 1e-9 * Math.max(...data.bounds.map(Math.abs)));
  // As high as the map beside it, or nearly: letters are then as large in both.
  const least = Math.min(480, side), margin = 0.03 * extent;
  const metre = side / (extent + 2 * margin);
  const fit = (lo, hi) => {
    const pixels = Math.max((hi - lo + 2 * margin) * metre, least);
    return [pixels, [(lo + hi - pixels / metre) / 2, (lo + hi + pixels / metre) / 2]];
  };
  const [width, xs] = fit(x0, x1), [height, ys] = fit(y0, y1);
  const view = frame($("workspace"), xs, ys, width, height, ["x [m]", "y [m]"]);
  const screen = ([x, y]) => [view.x.at(x), view.y.at(y)];
  const radius = (agent) => Math.max(agent.radius * metre, 3);
  if (data.ground) {
    // In steps of a metre, y up; edges keep their width on the screen.
    const step = metre / data.ground.steps;
    const at = `translate(${view.x.at(0)} ${view.y.at(0)}) scale(${step} ${-step})`;
    const ground = element(view.content, "g", { class: "ground", transform: at });
    const corridors = element(ground, "g", { class: "corridors" });
    for (const [d, width, filled] of data.ground.corridors) element(corridors, "path", { d, "stroke-width": width, class: filled ? "filled" : "" });
    for (const d of data.ground.edges) element(ground, "path", { class: "edge", d });
  }
  // The outline around the point that travels; y points down.
  const outline = (parent, agent, attributes) => agent.outline.length > 0
    ? element(parent, "polygon", { ...attributes, points: agent.outline.map(([ahead, left]) => [ahead * metre, -left * metre]).join(" ") })
    : element(parent, "circle", { ...attributes, r: radius(agent) });
  agents.forEach((agent, k) => {
    const group = element(view.content, "g", { class: "agent", style: `--colour:${agent.colour}` });
    let d = "M" + screen(poseAt(agent, 0)).join(" ");
    for (const [from, length, , , , bend] of agent.segments) {
      // Below half a turn two points and a radius leave no doubt which arc is meant.
      const parts = bend === 0 ? 1 : Math.max(1, Math.ceil(length / Math.abs(bend) / (0.75 * Math.PI)));
      for (let part = 1; part <= parts; part += 1) {
        const end = screen(poseAt(agent, from + length * part / parts)).join(" ");
        const size = Math.abs(bend) * metre;
        d += bend === 0 ? `L${end}` : `A${size} ${size} 0 0 ${bend < 0 ? 1 : 0} ${end}`;
      }
    }
    element(group, "path", { class: "path", d });
    const end = poseAt(agent, agent.length);
    outline(group, agent, { class: "end", transform: `translate(${screen(end).join(" ")}) rotate(${degrees(end)})` });
    paths.push(group);
  });
  agents.forEach((agent, k) => {
    const disc = element(view.content, "g", {
      class: "agent disc", style: `--colour:${agent.colour}`, tabindex: 0, role: "button", "aria-label": `Map of agent ${agent.name}`,
    });
    outline(disc, agent, { class: "outline" });
    element(disc, "title", {}, `Agent ${agent.name}`);
    disc.addEventListener("click", () => selectEgo(k));
    disc.addEventListener("keydown", (event) => { if (onKey(event)) selectEgo(k); });
    discs.push(disc);
  });
  // Above all discs, in which or beside which they stand.
  const above = element(view.content, "g", { class: "disc" });
  agents.forEach((agent) => numbers.push(element(above, "text", {}, agent.id)));
  drawWorkspace.radius = radius;
  drawWorkspace.screen = screen;
  drawWorkspace.height = height;
}

function onKey(event) {
  if (event.key !== "Enter" && event.key !== " ") return false;
  event.preventDefault();
  return true;
}

function drawMap() {
  const map = data.maps[state.ego], ego = agents[state.ego];
  const width = side, height = Math.max(drawWorkspace.height, Math.min(480, side));
  const view = frame($("map"), map?.time ?? [0, 1], map?.length ?? [0, 1], width, height, ["time t [s]", "travelled length l [m]"]);
  cursor = null;
  if (!map) return;
  const { x, y, content } = view;
  const grid = `translate(${view.left} ${view.top}) scale(${width / data.grid} ${height / data.grid})`;
  const order = map.regions.map((_, k) => k).sort((a, b) => size(map.regions[b]) - size(map.regions[a]));
  const crowd = new Crowd();
  for (const k of order) {
    const region = map.regions[k], other = agents[region.other];
    if (!state.shown[region.other]) continue;
    const node = element(content, "g", {
      class: `agent region${region.thin ? " thin" : ""}${state.pinned === k ? " pinned" : ""}`,
      style: `--colour:${other.colour}`, tabindex: 0, role: "button", "aria-label": summary(region),
    });
    const strip = (from, to) => ([lo, hi]) => element(node, "rect",
      { x: from, width: Math.max(0, to - from), y: y.at(hi), height: Math.max(y.at(lo) - y.at(hi), 2) });
    region.before.forEach(strip(view.left, x.at(other.time[0])));
    region.after.forEach(strip(x.at(other.time[1]), view.right));
    element(node, "path", { d: region.outline, transform: grid });
    // Their places are those of a large picture: in a small one there may be less room.
    const label = region.label && crowd.place([x.at(region.label[0]), y.at(region.label[1]), Infinity], k, wide(other.id), 14);
    if (label) element(node, "text", { x: label[0], y: label[1] }, other.id);
    node.addEventListener("pointerenter", () => describe(region));
    node.addEventListener("focus", () => describe(region));
    node.addEventListener("pointerleave", () => describe(map.regions[state.pinned]));
    const pin = () => {
      state.pinned = state.pinned === k ? null : k;
      content.querySelectorAll(".pinned").forEach((pinned) => pinned.classList.remove("pinned"));
      if (state.pinned === k) node.classList.add("pinned");
      describe(region);
    };
    node.addEventListener("click", pin);
    node.addEventListener("keydown", (event) => { if (onKey(event)) pin(); });
  }
  const at = (time, length) => `${x.at(time)} ${y.at(length)}`;
  let d = "M" + at(ego.time[0], 0);
  for (const [from, duration, length, before, after] of ego.phases) {
    // Constant acceleration is a parabola; its tangents meet at half time.
    const start = ego.time[0] + from;
    d += `Q${at(start + duration / 2, length + before * duration / 2)} `
      + at(start + duration, length + (before + after) / 2 * duration);
  }
  element(content, "path", { class: "own", d, "pointer-events": "none" });
  element(content, "path", { class: "own stands", "pointer-events": "none",
    d: `M${view.left} ${y.at(0)}H${x.at(ego.time[0])}M${at(ego.time[1], ego.length)}H${view.right}` });
  cursor = {
    x, y,
    line: element(content, "path", { class: "cursor", "pointer-events": "none" }),
    dot: element(content, "circle", { class: "dot", r: 6, "pointer-events": "none" }),
    span: `${view.top}V${view.bottom}`,
  };
  const count = map.regions.length;
  $("caption").textContent = `Extended collision map of agent ${ego.name}: ${count} region${count === 1 ? "" : "s"}${data.hulls ? " of the convex hulls of all outlines" : ""}, labelled by the`
    + " other agent; dashed strips are agents that stand at their start or end. Point at a region, or press Tab, to read about it.";
}

const size = (region) => (region.time[1] - region.time[0]) * (region.length[1] - region.length[0]);

function summary(region) {
  return `Region of agents ${agents[state.ego].name} and ${agents[region.other].name}, ${extent(region.time)} seconds, `
    + `${extent(region.length)} metres`;
}

// As the tables of the tool: three decimals, and below a thousandth three digits.
const number = (value) => (value !== 0 && Math.abs(value) < 1e-3 ? String(Number(value.toPrecision(3))) : value.toFixed(3)).replace("-", "\u2212");

// As those tables: outward.
const extent = (interval) => outward(interval).map((text) => text.replace("-", "\u2212")).join(" to ");

function describe(region) {
  const about = $("about");
  about.replaceChildren();
  const add = (parent, name, text) => {
    const node = document.createElement(name);
    if (text !== undefined) node.textContent = text;
    parent.append(node);
    return node;
  };
  if (!region) {
    add(about, "p", "Point at a region of the map to read its times and lengths; click to keep it.");
    return;
  }
  const other = agents[region.other].name;
  const open = [region.before.length > 0 && `before agent ${other} sets off`, region.after.length > 0 && `after agent ${other} has arrived`];
  const line = add(about, "p");
  add(line, "strong", `Agent ${agents[state.ego].name} against agent ${other}`);
  line.append(`, type ${region.types.join(", ")} (${region.pieces} piece${region.pieces === 1 ? "" : "s"})`);
  const ends = add(about, "p", `time ${extent(region.time)} s, length ${extent(region.length)} m`);
  const always = open.filter(Boolean).join(" and ");
  if (always) ends.append(`; also blocked ${always}`);
  if (region.crossings.length === 0) {
    add(about, "p", "The paths come near each other here without a crossing: the paper has no descriptor for it.");
    return;
  }
  const table = add(about, "table");
  const head = add(table, "tr");
  for (const title of ["crossing", "T [s]", "L [m]", "r\u0302 [m]", "v [m/s]", "\u03b8 [rad]", "\u03c2 own [m]", "\u03c2 other [m]"]) {
    add(head, "th", title).scope = "col";
  }
  const bend = (radius) => radius === null ? "\u2013" : `${number(Math.abs(radius))} ${radius > 0 ? "left" : "right"}`;
  for (const crossing of region.crossings) {
    const row = add(table, "tr");
    add(row, "td", crossing.type);
    for (const value of [crossing.T, crossing.L, crossing.r, crossing.v, crossing.theta]) add(row, "td", number(value));
    add(row, "td", bend(crossing.own));
    add(row, "td", bend(crossing.other));
  }
}

// ---- Time ----

function showTime() {
  const poses = agents.map((agent) => {
    const length = lengthAt(agent, state.time);
    return [...poseAt(agent, length), length];
  });
  const hit = agents.map(() => false);
  for (let i = 0; i < agents.length; i += 1) {
    if (!state.shown[i]) continue;
    for (let j = 0; j < i; j += 1) {
      if (state.shown[j] && touch(agents[i], poses[i], agents[j], poses[j])) hit[i] = hit[j] = true;
    }
  }
  discs.forEach((disc, k) => {
    const [x, y] = drawWorkspace.screen(poses[k]);
    disc.setAttribute("transform", `translate(${x} ${y})`);
    disc.firstElementChild.setAttribute("transform", `rotate(${degrees(poses[k])})`);
    disc.classList.toggle("hit", hit[k]);
  });
  if (cursor) {
    const x = cursor.x.at(state.time);
    cursor.line.setAttribute("d", `M${x} ${cursor.span}`);
    cursor.dot.setAttribute("cx", x);
    cursor.dot.setAttribute("cy", cursor.y.at(lengthAt(agents[state.ego], state.time)));
    cursor.dot.classList.toggle("hit", hit[state.ego]);
  }
  showNumbers(poses, hit);
  const count = hit.filter(Boolean).length;
  $("clock").textContent = `${state.time.toFixed(2)} s` + (count ? `, ${count} in contact` : "");
  $("time").value = state.time;
}

// In the disc or beside it, where there is room: first come the chosen agent's number and those of agents in contact.
function showNumbers(poses, hit) {
  const crowd = new Crowd();
  const rank = (k) => (k === state.ego ? 0 : hit[k] ? 1 : 2);
  const order = agents.map((_, k) => k).filter((k) => state.shown[k]).sort((a, b) => rank(a) - rank(b));
  const places = agents.map((agent, k) => [...drawWorkspace.screen(poses[k]), drawWorkspace.radius(agent)]);
  for (const k of order) {
    const [x, y, r] = places[k];
    crowd.take([x - r, y - r, x + r, y + r], k);
  }
  numbers.forEach((number, k) => number.classList.toggle("hidden", !state.shown[k]));
  for (const k of order) {
    const at = crowd.place(places[k], k, wide(agents[k].id), 14, k === state.ego);
    numbers[k].classList.toggle("hidden", !at);
    if (!at) continue;
    numbers[k].setAttribute("x", at[0]);
    numbers[k].setAttribute("y", at[1]);
  }
}

let frameBefore = null;

function play(on) {
  if (on && state.time >= last) state.time = first;
  frameBefore = null;
  $("play").setAttribute("aria-pressed", on);
  $("play-text").textContent = on ? "Pause" : "Play";
  $("play").firstElementChild.textContent = on ? "\u23f8" : "\u25b6";
  if (on) requestAnimationFrame(step);
}

function step(now) {
  if ($("play").getAttribute("aria-pressed") !== "true") return;
  const pace = Number($("pace").value);
  const speed = pace > 0 ? (last - first) / pace : 1;
  if (frameBefore !== null) state.time = Math.min(last, state.time + (now - frameBefore) / 1000 * speed);
  frameBefore = now;
  showTime();
  if (state.time < last) requestAnimationFrame(step); else play(false);
}

// ---- Choices ----

function selectEgo(k) {
  if (!data.maps[k]) return;
  state.ego = k;
  state.pinned = null;
  state.shown[k] = true;
  $("ego").value = k;
  show();
  describe();
}

function show() {
  drawMap();
  agents.forEach((_, k) => {
    for (const node of [paths[k], discs[k]]) node.classList.toggle("hidden", !state.shown[k]);
    paths[k].firstElementChild.classList.toggle("ego", k === state.ego);
    discs[k].classList.toggle("ego", k === state.ego);
    $("chips").children[k].setAttribute("aria-pressed", state.shown[k]);
  });
  showTime();
}

/** The agents whose numbers or labels hold what is sought; only they are listed. One that is called so comes first. */
function find() {
  const text = $("find").value.trim().toLowerCase();
  const found = agents.map((_, k) => k).filter((k) => agents[k].name.toLowerCase().includes(text));
  agents.forEach((_, k) => { $("chips").children[k].hidden = true; });
  found.forEach((k) => { $("chips").children[k].hidden = false; });
  $("found").textContent = text === "" ? "" : found.length > 0 ? `${found.length} of ${agents.length}` : `no agent "${$("find").value.trim()}"`;
  const called = (k) => [agents[k].id, agents[k].name.slice(agents[k].id.length + 1).toLowerCase()].includes(text);
  return text === "" ? [] : found.sort((a, b) => called(b) - called(a));
}

function start() {
  const maps = data.maps.filter((map) => map);
  const regions = maps.reduce((sum, map) => sum + map.regions.length, 0);
  const of = maps.length < agents.length ? `maps of ${maps.length} with ${regions} collision regions, `
    : `${regions} collision regions (both sides of each pair), `;
  $("summary").textContent = `${agents.length} agents, ${of}`
    + `${number(first)} to ${number(last)} s`;
  agents.forEach((agent, k) => {
    if (data.maps[k]) {
      const option = document.createElement("option");
      option.value = k;
      option.textContent = `${agent.name} (${data.maps[k].regions.length})`;
      $("ego").append(option);
    }
    const chip = document.createElement("button");
    chip.type = "button";
    chip.className = "agent chip";
    chip.style.setProperty("--colour", agent.colour);
    chip.textContent = agent.name;
    chip.title = `Show or hide agent ${agent.name}`;
    chip.addEventListener("click", () => { state.shown[k] = !state.shown[k]; show(); });
    $("chips").append(chip);
  });
  const slider = $("time");
  slider.min = first;
  slider.max = last;
  slider.step = Math.max((last - first) / 2000, Number.MIN_VALUE);
  slider.addEventListener("input", () => { state.time = Number(slider.value); showTime(); });
  $("play").addEventListener("click", () => play($("play").getAttribute("aria-pressed") !== "true"));
  $("ego").addEventListener("change", () => selectEgo(Number($("ego").value)));
  $("all").addEventListener("click", () => { state.shown.fill(true); show(); });
  $("partners").addEventListener("click", () => {
    const partners = new Set(data.maps[state.ego]?.regions.map((region) => region.other));
    agents.forEach((_, k) => { state.shown[k] = k === state.ego || partners.has(k); });
    show();
  });
  // More colours than a dozen cannot be told apart: agents are found by their names then.
  if (agents.length > 12) {
    $("ground").append(" Numbers for which there is no room are left out.");
    $("agents").classList.add("many");
    $("search").hidden = false;
    $("find").addEventListener("input", find);
    $("search").addEventListener("submit", (event) => {
      event.preventDefault();
      const first = find()[0];
      if (first !== undefined) selectEgo(first);
    });
  }
  if (data.hulls) {
    $("ground").firstChild.data = "Workspace. Agents that touch are red. An agent with loads is drawn as the convex hull of all its outlines; contacts are told by the outline "
      + "that it has at its place. A dashed outline is an agent's end. Select an agent to see its map.";
  }
  drawWorkspace();
  if (agents.length > 0) selectEgo(state.ego); else { drawMap(); describe(); }
}

start();
