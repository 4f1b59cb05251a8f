// The page: a scenario in the format of the tool, drawn and edited; every number of the answers comes from the module.
const $ = (id) => document.getElementById(id);
const AGENTS = 24, LEGS = 32, COLUMNS = 360;
// The palette of pictures, told apart by brightness as well.
const colour = (k) => `hsl(${(k * 137.5 + 210) % 360} 65% ${dark() ? 62 : 42}%)`;
const dark = () => matchMedia("(prefers-color-scheme: dark)").matches;
const tint = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

let pcr, scenario, chosen = 0, time = 0, playing = false, answers, view, grabbed = null, queued = false;

/** Rows of an answer; throws the reason if there is none. */
function rows(count, width) {
  const memory = pcr.memory.buffer;
  if (count < 0) throw new Error(new TextDecoder().decode(new Uint8Array(memory, pcr.pcr_message(), pcr.pcr_message_length())));
  const numbers = new Float64Array(memory, pcr.pcr_output(), count * width);
  return Array.from({ length: count }, (_, k) => Array.from(numbers.subarray(k * width, (k + 1) * width)));
}

const pair = (leg) => (leg.kind === "line" ? [leg.length, 0] : [leg.radius, leg.sweep]);

function write(agents) {
  const stride = pcr.pcr_stride(), input = new Float64Array(pcr.memory.buffer, pcr.pcr_input(), AGENTS * stride);
  agents.forEach((a, k) => input.set([a.start.x, a.start.y, a.start.heading, a.radius, a.t_start ?? 0, a.v_max, a.a_max, a.path.length,
    ...a.path.flatMap(pair)], k * stride));
}

/** What a file has that this page does not know is refused, never dropped. */
function read(found) {
  const known = { top: ["format", "version", "name", "agents", "warnings"], agent: ["id", "label", "radius", "v_max", "a_max", "t_start", "start", "path"] };
  const other = (object, names) => Object.keys(object).find((name) => !names.includes(name));
  const refuse = (why) => { throw new Error(why); };
  if (typeof found !== "object" || !Array.isArray(found?.agents)) refuse("not a scenario: no agents");
  if (found.format && found.format !== "pcr-scenario") refuse(`format ${found.format} is not pcr-scenario`);
  if (other(found, known.top)) refuse(`"${other(found, known.top)}" is not known here`);
  if (found.agents.length > AGENTS) refuse(`${found.agents.length} agents: there is room for ${AGENTS}`);
  const number = (value, what) => (typeof value === "number" && isFinite(value) ? value : refuse(`${what} is not a number`));
  const agents = found.agents.map((agent, k) => {
    const name = `agent ${k + 1}`;
    if (other(agent, known.agent)) refuse(`${name}: "${other(agent, known.agent)}" is not known here`);
    if (!Array.isArray(agent.path) || agent.path.length > LEGS) refuse(`${name}: 0 to ${LEGS} legs`);
    for (const field of ["radius", "v_max", "a_max"]) number(agent[field], `${name}, ${field}`);
    for (const field of ["x", "y", "heading"]) number(agent.start?.[field], `${name}, ${field}`);
    const path = agent.path.map((leg, at) => {
      const where = `${name}, leg ${at + 1}`;
      if (leg.kind === "line") return { kind: "line", length: number(leg.length, where) };
      if (leg.kind === "arc" && leg.sweep !== 0) return { kind: "arc", radius: number(leg.radius, where), sweep: number(leg.sweep, where) };
      return refuse(`${where}: only lines and arcs can be edited here`);
    });
    return { ...agent, t_start: number(agent.t_start ?? 0, name), path };
  });
  return { format: "pcr-scenario", version: 1, name: String(found.name ?? "playground"), agents };
}

function say(text, wrong = false) {
  $("said").textContent = text;
  $("said").classList.toggle("wrong", wrong);
}

/** Computes everything anew; what cannot be computed is said, and nothing of it is drawn. */
function update() {
  const agents = scenario.agents;
  chosen = Math.max(0, Math.min(chosen, agents.length - 1));
  answers = { conflicts: [], map: [], holds: null, first: 0, last: 1, valid: false };
  try {
    write(agents);
    rows(pcr.pcr_build(agents.length), 0);
    answers.valid = true;
    answers.first = Math.min(0, pcr.pcr_first());
    answers.last = Math.max(pcr.pcr_last(), answers.first + 1);
    answers.conflicts = rows(pcr.pcr_conflicts(), 10);
    if (agents.length) answers.map = rows(pcr.pcr_map(chosen, answers.first, step(), COLUMNS + 1), 4);
    const met = answers.conflicts.filter((row) => !row[5]).length;
    say(met ? `${met} conflict${met > 1 ? "s" : ""}` : "No conflict.");
    if (!met) hold();
  } catch (error) {
    say(error.message, true);
  }
  draw();
}

const step = () => (answers.last - answers.first) / COLUMNS;

function hold() {
  try {
    answers.holds = rows(pcr.pcr_holds(time), 1).map(([length]) => length);
  } catch {
    // Who meets nobody but touches has no order: no hold is shown.
    answers.holds = null;
  }
}

/** The poses at the ends of all legs of an agent, its start first. */
function joints({ start, path }) {
  const poses = [{ ...start }];
  for (const leg of path) {
    const { x, y, heading: h } = poses.at(-1);
    if (leg.kind === "line") poses.push({ x: x + leg.length * Math.cos(h), y: y + leg.length * Math.sin(h), heading: h });
    else {
      const side = Math.sign(leg.sweep), r = leg.radius * side, to = h + leg.sweep;
      poses.push({ x: x + r * (Math.sin(to) - Math.sin(h)), y: y - r * (Math.cos(to) - Math.cos(h)), heading: to });
    }
  }
  return poses;
}

/** Where a length of a path is, for markers. */
function along(agent, length) {
  let rest = length, poses = joints(agent);
  for (let k = 0; k < agent.path.length; k++) {
    const leg = agent.path[k], whole = leg.kind === "line" ? leg.length : leg.radius * Math.abs(leg.sweep);
    if (rest <= whole) {
      const part = leg.kind === "line" ? { ...leg, length: rest } : { ...leg, sweep: leg.sweep * rest / whole };
      return joints({ start: poses[k], path: [part] })[1];
    }
    rest -= whole;
  }
  return poses.at(-1);
}

function fit(canvas) {
  const scale = devicePixelRatio || 1, { clientWidth: width, clientHeight: height } = canvas;
  if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
  }
  const pen = canvas.getContext("2d");
  pen.setTransform(scale, 0, 0, scale, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.font = "12px system-ui, sans-serif";
  return { pen, width, height };
}

/** The part of the plane that is shown: kept while something is dragged. */
function frame(width, height) {
  if (!grabbed || !view) {
    const points = scenario.agents.flatMap((agent) => joints(agent).map(({ x, y }) => [x, y, agent.radius]));
    const low = (axis) => Math.min(...points.map((p) => p[axis] - p[2])), high = (axis) => Math.max(...points.map((p) => p[axis] + p[2]));
    const [x0, x1, y0, y1] = points.length ? [low(0), high(0), low(1), high(1)] : [-4, 4, -3, 3];
    view = { x: (x0 + x1) / 2, y: (y0 + y1) / 2, zoom: 0.86 / Math.max((x1 - x0) / width, (y1 - y0) / height, 1e-6) };
  }
  return { at: ({ x, y }) => [width / 2 + (x - view.x) * view.zoom, height / 2 - (y - view.y) * view.zoom] };
}

const TIP = 34;

function handles(agent, at) {
  const poses = joints(agent), [x, y] = at(poses[0]);
  const tip = { kind: "heading", x: x + TIP * Math.cos(agent.start.heading), y: y - TIP * Math.sin(agent.start.heading) };
  return [tip, ...poses.slice(1).map((pose, k) => ({ kind: "leg", leg: k, x: at(pose)[0], y: at(pose)[1] })), { kind: "start", x, y }];
}

function trace(pen, agent, at) {
  const poses = joints(agent);
  pen.beginPath();
  pen.moveTo(...at(poses[0]));
  agent.path.forEach((leg, k) => {
    if (leg.kind === "line") return pen.lineTo(...at(poses[k + 1]));
    const side = Math.sign(leg.sweep), { x, y, heading } = poses[k], r = leg.radius;
    const centre = { x: x - side * r * Math.sin(heading), y: y + side * r * Math.cos(heading) };
    const from = -(heading - side * Math.PI / 2);
    pen.arc(...at(centre), r * view.zoom, from, from - leg.sweep, side > 0);
  });
}

function drawPlane() {
  const { pen, width, height } = fit($("plane")), { at } = frame(width, height);
  const spacing = 10 ** Math.ceil(Math.log10(40 / view.zoom));
  pen.strokeStyle = tint("--grid");
  for (const [axis, size] of [["x", width], ["y", height]]) {
    const half = size / 2 / view.zoom;
    for (let k = Math.ceil((view[axis] - half) / spacing); k * spacing < view[axis] + half; k++) {
      const [x, y] = at({ x: k * spacing, y: k * spacing });
      pen.beginPath();
      if (axis === "x") { pen.moveTo(x, 0); pen.lineTo(x, height); } else { pen.moveTo(0, y); pen.lineTo(width, y); }
      pen.stroke();
    }
  }
  pen.fillStyle = tint("--dim");
  pen.fillText(`grid ${spacing} m`, 8, height - 8);
  const places = answers.valid ? rows(pcr.pcr_places(time), 6) : [];
  const hit = new Set(answers.conflicts.filter((row) => row[2] <= time && time <= row[3]).flatMap((row) => [row[0], row[1]]));
  scenario.agents.forEach((agent, k) => {
    pen.strokeStyle = colour(k);
    pen.lineWidth = k === chosen ? 3 : 1.5;
    trace(pen, agent, at);
    pen.stroke();
  });
  places.forEach(([x, y], k) => {
    const [px, py] = at({ x, y });
    pen.beginPath();
    pen.arc(px, py, Math.max(2, scenario.agents[k].radius * view.zoom), 0, 7);
    pen.globalAlpha = 0.28;
    pen.fillStyle = hit.has(k) ? tint("--hit") : colour(k);
    pen.fill();
    pen.globalAlpha = 1;
    pen.lineWidth = hit.has(k) ? 3 : 1.2;
    pen.strokeStyle = hit.has(k) ? tint("--hit") : colour(k);
    pen.stroke();
    pen.fillStyle = tint("--ink");
    pen.fillText(String(scenario.agents[k].id ?? k + 1), px - 4, py + 4);
    const hold = answers.holds?.[k];
    if (hold !== undefined && isFinite(hold)) {
      const pose = along(scenario.agents[k], hold), [hx, hy] = at(pose), nx = Math.sin(pose.heading), ny = Math.cos(pose.heading);
      pen.beginPath();
      pen.moveTo(hx - 9 * nx, hy - 9 * ny);
      pen.lineTo(hx + 9 * nx, hy + 9 * ny);
      pen.lineWidth = 4;
      pen.strokeStyle = colour(k);
      pen.stroke();
    }
  });
  const agent = scenario.agents[chosen];
  if (!agent) return;
  pen.strokeStyle = tint("--ink");
  pen.lineWidth = 1.5;
  const all = handles(agent, at), [x, y] = at(agent.start);
  pen.beginPath();
  pen.moveTo(x, y);
  pen.lineTo(all[0].x, all[0].y);
  pen.stroke();
  for (const handle of all) {
    pen.beginPath();
    if (handle.kind === "leg") pen.rect(handle.x - 6, handle.y - 6, 12, 12);
    else pen.arc(handle.x, handle.y, handle.kind === "start" ? 8 : 5, 0, 7);
    pen.fillStyle = tint("--paper");
    pen.fill();
    pen.stroke();
  }
}

function drawMap() {
  const { pen, width, height } = fit($("map")), agent = scenario.agents[chosen];
  const left = 44, bottom = 26, wide = width - left - 10, high = height - bottom - 10;
  if (!agent || !answers.valid) return;
  const [, , , , end] = rows(pcr.pcr_places(time), 6)[chosen];
  const px = (t) => left + wide * (t - answers.first) / (answers.last - answers.first), py = (l) => 10 + high * (1 - (end > 0 ? l / end : 0));
  // Whole pixels, so that neighbours neither overlap nor leave a gap.
  const border = (place) => Math.round(left + wide * Math.min(Math.max(place - 0.5, 0) / COLUMNS, 1));
  for (const [place, other, lo, hi] of answers.map) {
    pen.fillStyle = colour(other);
    pen.globalAlpha = 0.55;
    pen.fillRect(border(place), py(hi), border(place + 1) - border(place), Math.max(1, py(lo) - py(hi)));
  }
  pen.globalAlpha = 1;
  pen.strokeStyle = tint("--own");
  pen.lineWidth = 2;
  pen.beginPath();
  for (let k = 0; k <= COLUMNS; k++) {
    const t = answers.first + k * step(), length = rows(pcr.pcr_places(t), 6)[chosen][3];
    if (k) pen.lineTo(px(t), py(length)); else pen.moveTo(px(t), py(length));
  }
  pen.stroke();
  const hold = answers.holds?.[chosen];
  if (hold !== undefined && isFinite(hold)) {
    pen.setLineDash([5, 4]);
    pen.beginPath();
    pen.moveTo(left, py(hold));
    pen.lineTo(left + wide, py(hold));
    pen.stroke();
    pen.setLineDash([]);
  }
  pen.strokeStyle = tint("--accent");
  pen.beginPath();
  pen.moveTo(px(time), 10);
  pen.lineTo(px(time), 10 + high);
  pen.stroke();
  pen.strokeStyle = tint("--edge");
  pen.lineWidth = 1;
  pen.strokeRect(left, 10, wide, high);
  pen.fillStyle = tint("--dim");
  pen.fillText(`${answers.first.toFixed(0)}`, left, height - 8);
  pen.fillText(`${answers.last.toFixed(1)} s`, left + wide - 40, height - 8);
  pen.fillText(`${end.toFixed(1)} m`, 4, 20);
  pen.fillText("0", 30, 10 + high);
}

function table(target, head, body) {
  const row = (cells, kind) => {
    const line = document.createElement("tr");
    for (const cell of cells) {
      const field = line.appendChild(document.createElement(kind));
      if (cell instanceof Node) field.append(cell); else field.textContent = cell;
    }
    return line;
  };
  target.replaceChildren(row(head, "th"), ...body.map((cells) => row(cells, "td")));
}

const name = (k) => scenario.agents[k].label ?? String(scenario.agents[k].id ?? k + 1);

function draw() {
  $("time").min = answers.first;
  $("time").max = answers.last;
  $("time").value = time;
  $("clock").textContent = `${time.toFixed(2)} s`;
  drawPlane();
  drawMap();
  const agent = scenario.agents[chosen], hold = answers.holds?.[chosen];
  $("caption").textContent = agent ? `Collision map of agent ${name(chosen)}: where it must not be, by time and travelled length, in the colour of the other agent; the line is its motion.${
    hold === undefined ? "" : isFinite(hold) ? ` Now it may go to ${hold.toFixed(3)} m (dashed).` : " Now nobody is in its way."}` : "";
  const ends = (from, to) => [from.toFixed(3), to.toFixed(3)];
  table($("conflicts"), ["i", "j", "from [s]", "to [s]", "depth [m]"],
    answers.conflicts.map(([i, j, from, to, depth, touch]) => [name(i), name(j), ...ends(from, to), touch ? "touching" : depth < 1e-3 ? depth.toExponential(2) : depth.toFixed(3)]));
}

function later(act = update) {
  if (queued) return;
  queued = true;
  requestAnimationFrame(() => { queued = false; act(); });
}

const SLIDERS = [["radius", "Radius [m]", 0.02, 1], ["v_max", "Speed [m/s]", 0.05, 3], ["a_max", "Acceleration [m/s²]", 0.05, 3], ["t_start", "Start [s]", 0, 60]];

/** The controls of the chosen agent. */
function edit() {
  const agents = scenario.agents, agent = agents[chosen];
  $("agent").replaceChildren(...agents.map((_, k) => new Option(name(k), k, false, k === chosen)));
  $("which").textContent = agent ? name(chosen) : "";
  $("remove").disabled = !agent;
  $("add").disabled = agents.length >= AGENTS;
  $("line").disabled = $("arc").disabled = !agent || agent.path.length >= LEGS;
  const number = (object, field, what, scale = 1) => {
    const input = Object.assign(document.createElement("input"), { type: "number", step: "any", value: +(object[field] * scale).toPrecision(12) });
    input.setAttribute("aria-label", what);
    input.addEventListener("input", () => { if (isFinite(input.valueAsNumber)) { object[field] = input.valueAsNumber / scale; later(); } });
    return input;
  };
  $("sliders").replaceChildren(...(agent ? SLIDERS : []).map(([field, text, min, max]) => {
    const label = document.createElement("label"), slider = document.createElement("input");
    Object.assign(slider, { type: "range", min, max, step: "any", value: agent[field] });
    const exact = number(agent, field, text);
    slider.setAttribute("aria-label", `${text}, slider`);
    slider.addEventListener("input", () => { agent[field] = +Number(slider.value).toFixed(3); exact.value = agent[field]; later(); });
    exact.addEventListener("input", () => { slider.value = agent[field]; });
    label.append(text, slider, exact);
    return label;
  }), ...(agent ? [["x", "Start x [m]", 1], ["y", "Start y [m]", 1], ["heading", "Heading [°]", 180 / Math.PI]] : []).map(([field, text, scale]) => {
    const label = document.createElement("label");
    label.append(text, document.createElement("span"), number(agent.start, field, text, scale));
    return label;
  }));
  table($("legs"), ["", "length or radius [m]", "turn [°]", ""], (agent?.path ?? []).map((leg, k) => {
    const gone = Object.assign(document.createElement("button"), { textContent: "×" });
    gone.setAttribute("aria-label", `Remove leg ${k + 1}`);
    gone.addEventListener("click", () => { agent.path.splice(k, 1); edit(); update(); });
    const what = `leg ${k + 1}`;
    return leg.kind === "line" ? ["line", number(leg, "length", `Length of ${what}`), "", gone]
      : ["arc", number(leg, "radius", `Radius of ${what}`), number(leg, "sweep", `Turn of ${what}`, 180 / Math.PI), gone];
  }));
}

const DEGREE = Math.PI / 180;
const snapped = (angle) => { const near = Math.round(angle / (45 * DEGREE)) * 45 * DEGREE; return Math.abs(near - angle) < 3 * DEGREE ? near : angle; };

/** The line or arc from a pose, along its tangent, to a point. */
function legTo({ x, y, heading }, point) {
  const dx = point.x - x, dy = point.y - y, chord = Math.hypot(dx, dy);
  const ahead = dx * Math.cos(heading) + dy * Math.sin(heading), aside = dy * Math.cos(heading) - dx * Math.sin(heading);
  const sweep = snapped(heading + 2 * Math.atan2(aside, ahead)) - heading;
  if (Math.abs(sweep) < 3 * DEGREE) return { kind: "line", length: Math.max(chord, 0.05) };
  return { kind: "arc", radius: Math.max(chord, 0.05) / (2 * Math.abs(Math.sin(sweep / 2))), sweep };
}

function pointer(event) {
  const box = $("plane").getBoundingClientRect(), px = event.clientX - box.left, py = event.clientY - box.top;
  return { px, py, x: view.x + (px - box.width / 2) / view.zoom, y: view.y - (py - box.height / 2) / view.zoom };
}

function listen() {
  const plane = $("plane");
  plane.addEventListener("pointerdown", (event) => {
    const point = pointer(event), { at } = frame(plane.clientWidth, plane.clientHeight), reach = event.pointerType === "touch" ? 24 : 12;
    const near = (handle) => Math.hypot(handle.x - point.px, handle.y - point.py) < reach;
    let handle = scenario.agents[chosen] && handles(scenario.agents[chosen], at).find(near);
    if (!handle) {
      const other = scenario.agents.findIndex((agent) => joints(agent).some((pose) => Math.hypot(at(pose)[0] - point.px, at(pose)[1] - point.py) < reach));
      if (other < 0) return;
      chosen = other;
      handle = handles(scenario.agents[chosen], at).find(near) ?? null;
      edit();
    }
    grabbed = handle;
    plane.setPointerCapture(event.pointerId);
    later();
  });
  // A finger that has hold of nothing scrolls the page.
  plane.addEventListener("touchstart", (event) => { if (grabbed) event.preventDefault(); }, { passive: false });
  plane.addEventListener("pointermove", (event) => {
    const agent = scenario.agents[chosen];
    if (!grabbed || !agent) return;
    const point = pointer(event);
    if (grabbed.kind === "start") Object.assign(agent.start, { x: point.x, y: point.y });
    else if (grabbed.kind === "heading") agent.start.heading = snapped(Math.atan2(point.y - agent.start.y, point.x - agent.start.x));
    else agent.path[grabbed.leg] = legTo(joints(agent)[grabbed.leg], point);
    later();
  });
  const drop = () => { if (grabbed) { grabbed = null; edit(); later(); } };
  plane.addEventListener("pointerup", drop);
  plane.addEventListener("pointercancel", drop);
  plane.addEventListener("keydown", (event) => {
    const agent = scenario.agents[chosen], way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!agent || !way) return;
    event.preventDefault();
    if (event.shiftKey) agent.start.heading += (way[1] - way[0]) * 5 * DEGREE;
    else { agent.start.x += way[0] * 0.05; agent.start.y += way[1] * 0.05; }
    edit();
    later();
  });
  $("agent").addEventListener("change", () => { chosen = Number($("agent").value); edit(); update(); });
  $("add").addEventListener("click", () => {
    const ids = scenario.agents.map((agent) => Number(agent.id) || 0), low = view ?? { x: 0, y: 0 };
    scenario.agents.push({ id: Math.max(0, ...ids) + 1, radius: 0.3, v_max: 1, a_max: 0.5, t_start: 0, start: { x: low.x - 2, y: low.y, heading: 0 },
      path: [{ kind: "line", length: 2 }, { kind: "arc", radius: 1, sweep: Math.PI / 2 }] });
    chosen = scenario.agents.length - 1;
    edit();
    update();
  });
  $("remove").addEventListener("click", () => { scenario.agents.splice(chosen, 1); edit(); update(); });
  $("line").addEventListener("click", () => { scenario.agents[chosen].path.push({ kind: "line", length: 1 }); edit(); update(); });
  $("arc").addEventListener("click", () => { scenario.agents[chosen].path.push({ kind: "arc", radius: 1, sweep: Math.PI / 2 }); edit(); update(); });
  $("plan").addEventListener("click", () => {
    try {
      if (!answers.valid) throw new Error($("said").textContent);
      const delays = rows(pcr.pcr_plan(), 1).map(([delay]) => delay);
      scenario.agents.forEach((agent, k) => { agent.t_start = (agent.t_start ?? 0) + delays[k]; });
      edit();
      update();
      say(`Planned: delays ${delays.map((delay, k) => `${name(k)}: ${delay.toFixed(2)} s`).join(", ")}`);
    } catch (error) {
      say(error.message, true);
    }
  });
  $("now").addEventListener("click", () => { for (const agent of scenario.agents) agent.t_start = 0; edit(); update(); });
  $("time").addEventListener("input", () => { time = Number($("time").value); if (answers.holds) hold(); later(draw); });
  $("play").addEventListener("click", () => {
    playing = !playing;
    $("play").textContent = playing ? "Pause" : "Play";
    $("play").setAttribute("aria-pressed", playing);
    let before = performance.now();
    const tick = (now) => {
      if (!playing) return;
      time += (now - before) / 1000 * 2;
      before = now;
      if (time > answers.last) time = answers.first;
      if (answers.holds) hold();
      draw();
      requestAnimationFrame(tick);
    };
    if (playing) requestAnimationFrame(tick);
  });
  $("save").addEventListener("click", () => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([JSON.stringify(scenario, null, 1)], { type: "application/json" }));
    link.download = `${scenario.name}.json`;
    link.click();
    // Not at once: some browsers have not begun to read it.
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
  // The same file again is a change, too.
  $("load").addEventListener("click", () => { $("load").value = ""; });
  $("load").addEventListener("change", async () => {
    try {
      open(JSON.parse(await $("load").files[0].text()));
    } catch (error) {
      say(`Not loaded: ${error.message}`, true);
    }
  });
  $("share").addEventListener("click", async () => {
    history.replaceState(null, "", `#${toLink(scenario)}`);
    try {
      await navigator.clipboard.writeText(location.href);
      say("The link is in the clipboard and in the address.");
    } catch {
      say("The link is in the address.");
    }
  });
  // A link that is pasted where the page is open already.
  addEventListener("hashchange", () => {
    const wrong = address();
    if (wrong) say(wrong, true);
  });
  addEventListener("resize", () => later(draw));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => later(draw));
}

const toLink = (found) => btoa(String.fromCharCode(...new TextEncoder().encode(JSON.stringify(found)))).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
const fromLink = (text) => JSON.parse(new TextDecoder().decode(Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (sign) => sign.charCodeAt(0))));

function open(found) {
  scenario = read(found);
  chosen = 0;
  time = 0;
  view = null;
  edit();
  update();
}

/** Opens what the address holds; says why it cannot be opened. */
function address() {
  if (location.hash.length < 2) return "";
  try {
    open(fromLink(location.hash.slice(1)));
    return "";
  } catch (error) {
    return `The link is not a scenario: ${error.message}`;
  }
}

async function begin() {
  const packed = Uint8Array.from(atob(PACKED), (sign) => sign.charCodeAt(0));
  const module = await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  pcr = (await WebAssembly.instantiate(module)).instance.exports;
  listen();
  open(START);
  const wrong = address();
  if (wrong) say(wrong, true);
  document.body.dataset.ready = "yes";
}

begin();
