// The page: a scenario in the format of the tool, drawn and edited; every number of the answers comes from the module.
const $ = (id) => document.getElementById(id);
const AGENTS = 24, LEGS = 32, CORNERS = 16, COLUMNS = 360;
// The palette of pictures, told apart by brightness as well.
const colour = (k) => `hsl(${(hue(scenario.agents[k]) * 137.5 + 210) % 360} 65% ${dark() ? 62 : 42}%)`;
const dark = () => matchMedia("(prefers-color-scheme: dark)").matches;
const tint = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

let pcr, scenario, chosen = 0, time = 0, playing = false, answers, view, grabbed = null, queued = false, lesson = -1;
// The number of the colour of each agent, which it keeps while others are added and removed.
const hues = new WeakMap();
// Why what stands in a field was not taken.
let untaken = "";

/** The number of an agent's colour: the one that it has, or else the least that no agent has. */
function hue(agent) {
  if (!hues.has(agent)) {
    const taken = new Set(scenario.agents.map((other) => hues.get(other)));
    let number = 0;
    while (taken.has(number)) number++;
    hues.set(agent, number);
  }
  return hues.get(agent);
}

function say(text, wrong = false) {
  $("said").textContent = text;
  $("said").classList.toggle("wrong", wrong);
}

/** Gives the module a scenario; throws the reason if the tool or the module refuses it. */
function build(next) {
  read(next);
  write(next.agents);
  rows(pcr.pcr_build(next.agents.length), 0);
}

/** Computes everything anew; what cannot be computed is said, and nothing of it is drawn. */
function update() {
  const agents = scenario.agents;
  answers = { conflicts: [], map: [], holds: null, first: 0, last: 1, valid: false };
  try {
    build(scenario);
    answers.valid = true;
    answers.first = Math.min(0, pcr.pcr_first());
    answers.last = Math.max(pcr.pcr_last(), answers.first + 1);
    answers.lengths = rows(pcr.pcr_places(0), 6).map((place) => place[4]);
    answers.conflicts = rows(pcr.pcr_conflicts(), 10);
    if (agents.length) answers.map = rows(pcr.pcr_map(chosen, answers.first, step(), COLUMNS + 1), 4);
    const met = answers.conflicts.filter((row) => !row[5]).length;
    say(met ? `${met} conflict${met > 1 ? "s" : ""}` : agents.length ? "No conflict." : "No agents.");
    if (!met) hold();
  } catch (error) {
    say(error.message, true);
  }
  if (untaken) say(untaken, true);
  teach();
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

const name = (k) => scenario.agents[k].label || String(scenario.agents[k].id);

function draw() {
  $("time").min = answers.first;
  $("time").max = answers.last;
  $("time").value = time;
  $("clock").textContent = `${time.toFixed(2)} s`;
  drawPlane();
  drawMap();
  const agent = scenario.agents[chosen], hold = answers.holds?.[chosen];
  $("caption").textContent = agent && answers.valid ? `Collision map of agent ${name(chosen)}: where it must not be, by time and travelled length, in the colour of the other agent; the line is its motion, and is dragged to another start. What it must not have now is thick on its path.${
    hold === undefined ? "" : isFinite(hold) ? ` Now it may go to ${outward([hold, hold])[0]} m (dashed).` : " Now nobody is in its way."}` : "";
  const ends = (from, to) => outward([from, to]);
  table($("conflicts"), ["i", "j", "from [s]", "to [s]", "depth [m]"],
    answers.conflicts.map(([i, j, from, to, depth, touch]) => [name(i), name(j), ...ends(from, to), touch ? "touching" : depth < 1e-3 ? depth.toExponential(2) : depth.toFixed(3)]));
}

function later(act = update) {
  if (queued) return;
  queued = true;
  requestAnimationFrame(() => { queued = false; act(); });
}

const SLIDERS = [["radius", "Radius [m]", 0.02, 1], ["v_max", "Speed [m/s]", 0.05, 3], ["a_max", "Acceleration [m/s²]", 0.05, 3], ["t_start", "Start [s]", 0, 20]];

/** The controls of the chosen agent; of the last one, if the chosen one was behind it and is removed. */
function edit() {
  const agents = scenario.agents;
  chosen = Math.max(0, Math.min(chosen, agents.length - 1));
  agents.forEach(hue);
  const agent = agents[chosen];
  untaken = "";
  $("agent").replaceChildren(...agents.map((_, k) => new Option(name(k), k, false, k === chosen)));
  $("which").textContent = agent ? name(chosen) : "";
  $("remove").disabled = !agent;
  $("add").disabled = agents.length >= AGENTS;
  $("line").disabled = $("arc").disabled = !agent || agent.path.length >= LEGS;
  const number = (object, field, what, scale = 1) => {
    const input = Object.assign(document.createElement("input"), { type: "number", step: "any", value: +(object[field] * scale).toPrecision(12) });
    input.setAttribute("aria-label", what);
    input.addEventListener("input", () => {
      const before = object[field];
      object[field] = input.valueAsNumber / scale;
      untaken = "";
      try {
        read(scenario);
      } catch (error) {
        object[field] = before;
        untaken = `Not taken: ${error.message}`;
      }
      input.setAttribute("aria-invalid", Boolean(untaken));
      later();
    });
    return input;
  };
  $("shape").disabled = !agent;
  $("shape").value = agent?.footprint ? "polygon" : "disc";
  $("corner").disabled = !agent?.footprint || agent.footprint.polygon.length >= CORNERS;
  const sliders = SLIDERS.filter(([field]) => !(field === "radius" && agent?.footprint));
  $("sliders").replaceChildren(...(agent ? sliders : []).map(([field, text, min, max]) => {
    const label = document.createElement("label"), slider = document.createElement("input");
    Object.assign(slider, { type: "range", min, max, step: "any", value: agent[field] });
    const exact = number(agent, field, text);
    slider.setAttribute("aria-label", `${text}, slider`);
    slider.addEventListener("input", () => { agent[field] = +Number(slider.value).toFixed(3); exact.value = agent[field]; exact.removeAttribute("aria-invalid"); untaken = ""; later(); });
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

/** Where a pointer is: in the plane as it lay when the drag began, as what is said above it may become longer meanwhile. */
function pointer(event) {
  const box = grabbed?.box ?? $("plane").getBoundingClientRect(), px = event.clientX - box.left, py = event.clientY - box.top;
  return { px, py, x: view.x + (px - box.width / 2) / view.zoom, y: view.y - (py - box.height / 2) / view.zoom };
}

/** Moves a corner of an outline to a point of the plane, where the outline stays convex. */
function move(agent, index, { x, y }) {
  const { x: x0, y: y0, heading } = agent.start, dx = x - x0, dy = y - y0;
  const corner = { ahead: dx * Math.cos(heading) + dy * Math.sin(heading), left: dy * Math.cos(heading) - dx * Math.sin(heading) };
  const before = agent.footprint.polygon[index];
  agent.footprint.polygon[index] = corner;
  if (!convex(polygon(agent))) agent.footprint.polygon[index] = before;
}

/** Puts a corner beside the middle of the longest edge. */
function bulge(agent) {
  const corners = ordered(polygon(agent)), ends = corners.map((corner, k) => [corner, corners[(k + 1) % corners.length]]);
  const long = ([a, b]) => Math.hypot(b[0] - a[0], b[1] - a[1]);
  const at = ends.reduce((best, edge, k) => (long(edge) > long(ends[best]) ? k : best), 0), [a, b] = ends[at];
  // Outward by less and less, until it is on the inner side of the edges beside it.
  for (let part = 0.1; part > 1e-6; part /= 2) {
    const corner = [(a[0] + b[0]) / 2 + part * (b[1] - a[1]), (a[1] + b[1]) / 2 - part * (b[0] - a[0])];
    const all = [...corners.slice(0, at + 1), corner, ...corners.slice(at + 1)];
    if (!convex(all)) continue;
    agent.footprint.polygon = all.map(([ahead, left]) => ({ ahead, left }));
    return;
  }
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
    grabbed = handle && { ...handle, box: plane.getBoundingClientRect() };
    plane.setPointerCapture(event.pointerId);
    later();
  });
  plane.addEventListener("pointermove", (event) => {
    const agent = scenario.agents[chosen];
    if (!grabbed || grabbed.kind === "delay" || !agent) return;
    const point = pointer(event);
    if (grabbed.kind === "start") Object.assign(agent.start, { x: point.x, y: point.y });
    else if (grabbed.kind === "heading") agent.start.heading = snapped(Math.atan2(point.y - agent.start.y, point.x - agent.start.x));
    else if (grabbed.kind === "corner") move(agent, grabbed.corner, point);
    else agent.path[grabbed.leg] = legTo(joints(agent)[grabbed.leg], point);
    later();
  });
  const map = $("map");
  map.addEventListener("pointerdown", (event) => {
    const agent = scenario.agents[chosen];
    if (!agent || !answers.valid) return;
    const box = map.getBoundingClientRect(), { px, py } = axes(box.width, box.height), reach = event.pointerType === "touch" ? 24 : 12;
    const near = track().some(([t, l]) => Math.hypot(px(t) - (event.clientX - box.left), py(l) - (event.clientY - box.top)) < reach);
    if (!near) return;
    grabbed = { kind: "delay", from: event.clientX, start: agent.t_start, second: px(1) - px(0) };
    map.setPointerCapture(event.pointerId);
  });
  map.addEventListener("pointermove", (event) => {
    if (grabbed?.kind !== "delay") return;
    scenario.agents[chosen].t_start = Math.max(0, +(grabbed.start + (event.clientX - grabbed.from) / grabbed.second).toFixed(3));
    later();
  });
  const drop = () => { if (grabbed) { grabbed = null; edit(); later(); } };
  for (const canvas of [plane, map]) {
    // A finger that has hold of nothing scrolls the page.
    canvas.addEventListener("touchstart", (event) => { if (grabbed) event.preventDefault(); }, { passive: false });
    canvas.addEventListener("pointerup", drop);
    canvas.addEventListener("pointercancel", drop);
  }
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
    const ids = scenario.agents.map((agent) => agent.id), named = ids.some((id) => typeof id === "string"), low = view ?? { x: 0, y: 0 };
    // The least number that nobody has; in a name where the others have names, as digits alone would be taken for a number.
    const made = (number) => (named ? `agent-${number}` : number);
    let number = 1;
    while (ids.includes(made(number))) number++;
    scenario.agents.push({ id: made(number), radius: 0.3, v_max: 1, a_max: 0.5, t_start: 0, start: { x: low.x - 2, y: low.y, heading: 0 },
      path: [{ kind: "line", length: 2 }, { kind: "arc", radius: 1, sweep: Math.PI / 2 }] });
    chosen = scenario.agents.length - 1;
    edit();
    update();
  });
  $("remove").addEventListener("click", () => { scenario.agents.splice(chosen, 1); edit(); update(); });
  $("shape").addEventListener("change", () => {
    const agent = scenario.agents[chosen];
    if ($("shape").value === "disc") {
      agent.radius = +reach(agent).toPrecision(12);
      delete agent.footprint;
    } else if (!agent.footprint) {
      // Twice as long as wide, with the reference point in its middle.
      const ahead = agent.radius, left = agent.radius / 2;
      agent.footprint = { polygon: [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([x, y]) => ({ ahead: x * ahead, left: y * left })) };
      delete agent.radius;
    }
    edit();
    update();
  });
  $("corner").addEventListener("click", () => { bulge(scenario.agents[chosen]); edit(); update(); });
  $("line").addEventListener("click", () => { scenario.agents[chosen].path.push({ kind: "line", length: 1 }); edit(); update(); });
  $("arc").addEventListener("click", () => { scenario.agents[chosen].path.push({ kind: "arc", radius: 1, sweep: Math.PI / 2 }); edit(); update(); });
  $("plan").addEventListener("click", () => {
    try {
      if (!answers.valid) throw new Error($("said").textContent);
      const delays = rows(pcr.pcr_plan(), 1).map(([delay]) => delay);
      scenario.agents.forEach((agent, k) => { agent.t_start = agent.t_start + delays[k]; });
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
    if (playing) requestAnimationFrame(tick); else draw();
  });
  $("undo").addEventListener("click", () => travel(-1));
  $("redo").addEventListener("click", () => travel(1));
  document.addEventListener("keydown", (event) => {
    const key = event.key.toLowerCase();
    if (!(event.ctrlKey || event.metaKey) || event.altKey || (key !== "z" && key !== "y")) return;
    event.preventDefault();
    travel(key === "y" || event.shiftKey ? 1 : -1);
  });
  // Whatever changed the scenario ends with one of these, after its own listener: a drag, a slider, a field, a button or a key that is held.
  for (const end of ["pointerup", "pointercancel", "change", "click", "keyup"]) document.addEventListener(end, remember);
  $("lesson").append(...LESSONS.map(({ title }, k) => new Option(title, k)));
  $("lesson").addEventListener("change", () => startLesson(Number($("lesson").value)));
  $("next").addEventListener("click", () => startLesson((lesson + 1) % LESSONS.length));
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

function open(found, of = -1) {
  const next = read(found);
  try {
    build(next);
  } catch (error) {
    // The module has to know again what is shown.
    if (scenario) update();
    throw error;
  }
  scenario = next;
  chosen = 0;
  time = 0;
  view = null;
  lesson = of;
  edit();
  update();
  remember();
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
  const wrong = address();
  if (!scenario) open(START);
  if (wrong) say(wrong, true);
  document.body.dataset.ready = "yes";
}

begin();
