// The two pictures and the tables.

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
    const points = scenario.agents.flatMap((agent) => joints(agent).map(({ x, y }) => [x, y, reach(agent)]));
    const low = (axis) => Math.min(...points.map((p) => p[axis] - p[2])), high = (axis) => Math.max(...points.map((p) => p[axis] + p[2]));
    const [x0, x1, y0, y1] = points.length ? [low(0), high(0), low(1), high(1)] : [-4, 4, -3, 3];
    view = { x: (x0 + x1) / 2, y: (y0 + y1) / 2, zoom: 0.86 / Math.max((x1 - x0) / width, (y1 - y0) / height, 1e-6) };
  }
  return { at: ({ x, y }) => [width / 2 + (x - view.x) * view.zoom, height / 2 - (y - view.y) * view.zoom] };
}

// More lines than a wide screen has; steps that are lost in rounding must not go on for ever.
const TIP = 34, LINES = 400;

function handles(agent, at) {
  const poses = joints(agent), [x, y] = at(poses[0]);
  const tip = { kind: "heading", x: x + TIP * Math.cos(agent.start.heading), y: y - TIP * Math.sin(agent.start.heading) };
  const corners = polygon(agent).map((corner, k) => {
    const [px, py] = at(placed(agent.start, corner));
    return { kind: "corner", corner: k, x: px, y: py };
  });
  return [...corners, tip, ...poses.slice(1).map((pose, k) => ({ kind: "leg", leg: k, x: at(pose)[0], y: at(pose)[1] })), { kind: "start", x, y }];
}

/** A point ahead and to the left of a pose. */
const placed = ({ x, y, heading }, [ahead, left]) => ({
  x: x + ahead * Math.cos(heading) - left * Math.sin(heading), y: y + ahead * Math.sin(heading) + left * Math.cos(heading),
});

/** The outline of an agent at a pose, as a path of the pen. */
function outline(pen, agent, pose, at) {
  pen.beginPath();
  if (!agent.footprint) return pen.arc(...at(pose), Math.max(2, agent.radius * view.zoom), 0, 7);
  const growth = agent.footprint.growth ?? 0, corners = ordered(polygon(agent));
  corners.forEach((corner, k) => {
    // The corner is rounded by the growth: from the normal of the edge before it to that of the edge behind it.
    const normal = (a, b) => Math.atan2(a[0] - b[0], b[1] - a[1]);
    const before = corners[(k + corners.length - 1) % corners.length], next = corners[(k + 1) % corners.length];
    if (growth) pen.arc(...at(placed(pose, corner)), growth * view.zoom, -(pose.heading + normal(before, corner)), -(pose.heading + normal(corner, next)), true);
    else pen.lineTo(...at(placed(pose, corner)));
  });
  pen.closePath();
}

function trace(pen, agent, at) {
  // A canvas ends an arc of more than one turn where it began.
  const path = parts(agent.path), poses = joints({ start: agent.start, path });
  pen.beginPath();
  pen.moveTo(...at(poses[0]));
  path.forEach((leg, k) => {
    // An arc that does not turn has no centre to go about.
    if (leg.kind === "line" || leg.sweep === 0) return pen.lineTo(...at(poses[k + 1]));
    const side = Math.sign(leg.sweep), { x, y, heading } = poses[k], r = leg.radius;
    const centre = { x: x - side * r * Math.sin(heading), y: y + side * r * Math.cos(heading) };
    const from = -(heading - side * Math.PI / 2);
    pen.arc(...at(centre), r * view.zoom, from, from - leg.sweep, side > 0);
  });
}

function drawPlane() {
  const { pen, width, height } = fit($("plane"));
  if (!answers.valid) return;
  const { at } = frame(width, height);
  const spacing = 10 ** Math.ceil(Math.log10(24 / view.zoom));
  pen.strokeStyle = tint("--grid");
  for (const [axis, size] of [["x", width], ["y", height]]) {
    const half = size / 2 / view.zoom, first = Math.ceil((view[axis] - half) / spacing);
    for (let line = 0; line < LINES && (first + line) * spacing < view[axis] + half; line++) {
      const k = first + line, [x, y] = at({ x: k * spacing, y: k * spacing });
      pen.beginPath();
      if (axis === "x") { pen.moveTo(x, 0); pen.lineTo(x, height); } else { pen.moveTo(0, y); pen.lineTo(width, y); }
      pen.stroke();
    }
  }
  pen.fillStyle = tint("--dim");
  pen.fillText(`grid ${spacing} m`, 8, height - 8);
  const places = rows(pcr.pcr_places(time), 6);
  const hit = new Set(answers.conflicts.filter((row) => row[2] <= time && time <= row[3]).flatMap((row) => [row[0], row[1]]));
  scenario.agents.forEach((agent, k) => {
    pen.strokeStyle = colour(k);
    pen.lineWidth = k === chosen ? 3 : 1.5;
    trace(pen, agent, at);
    pen.stroke();
  });
  // What the map forbids at this time, on the path itself.
  pen.globalAlpha = 0.45;
  pen.lineWidth = 9;
  for (const [, other, lo, hi] of scenario.agents.length ? rows(pcr.pcr_map(chosen, time, 0, 1), 4) : []) {
    pen.strokeStyle = colour(other);
    trace(pen, cut(scenario.agents[chosen], lo, hi), at);
    pen.stroke();
  }
  pen.globalAlpha = 1;
  places.forEach(([x, y, heading], k) => {
    const [px, py] = at({ x, y });
    outline(pen, scenario.agents[k], { x, y, heading }, at);
    pen.globalAlpha = 0.28;
    pen.fillStyle = hit.has(k) ? tint("--hit") : colour(k);
    pen.fill();
    pen.globalAlpha = 1;
    pen.lineWidth = hit.has(k) ? 3 : 1.2;
    pen.strokeStyle = hit.has(k) ? tint("--hit") : colour(k);
    pen.stroke();
    pen.fillStyle = tint("--ink");
    // Beside the handle of the agent that is chosen, which would cover it.
    pen.fillText(String(scenario.agents[k].id), k === chosen ? px + 12 : px - 4, k === chosen ? py - 8 : py + 4);
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
  const tip = all.find((handle) => handle.kind === "heading");
  pen.moveTo(x, y);
  pen.lineTo(tip.x, tip.y);
  pen.stroke();
  if (agent.footprint) {
    outline(pen, agent, agent.start, at);
    pen.setLineDash([3, 3]);
    pen.stroke();
    pen.setLineDash([]);
  }
  for (const handle of all) {
    pen.beginPath();
    if (handle.kind === "corner") pen.arc(handle.x, handle.y, 4, 0, 7);
    else if (handle.kind === "leg") pen.rect(handle.x - 6, handle.y - 6, 12, 12);
    else pen.arc(handle.x, handle.y, handle.kind === "start" ? 8 : 5, 0, 7);
    pen.fillStyle = tint("--paper");
    pen.fill();
    pen.stroke();
  }
}

/** Where the map has a time and a length: within the frame of its canvas. */
function axes(width, height) {
  const left = 50, top = 22, wide = width - left - 12, high = height - top - 28;
  const length = answers.lengths[chosen];
  return { left, top, wide, high, px: (t) => left + wide * (t - answers.first) / (answers.last - answers.first), py: (l) => top + high * (1 - (length > 0 ? l / length : 0)) };
}

/** Times and travelled lengths of the chosen agent. */
function track() {
  return rows(pcr.pcr_track(chosen, answers.first, step(), COLUMNS + 1), 1).map(([length], k) => [answers.first + k * step(), length]);
}

/**
 * The regions of each other agent, up to the present time and after it, one path each, so that no seams show. A region is between its
 * intervals at two times that follow one another, and ends in a tip half a step beyond the last one.
 */
function shapes(px, py) {
  const paths = new Map(), at = new Map(), x = (place) => px(answers.first + place * step());
  const map = answers.map.map(([place, other, lo, hi]) => {
    // At least a pixel high.
    const middle = (py(lo) + py(hi)) / 2, half = Math.max(0.5, (py(lo) - py(hi)) / 2);
    return { place, other, lo, hi, below: middle + half, middle, above: middle - half };
  });
  for (const slice of map) {
    const key = `${slice.place} ${slice.other}`;
    at.set(key, [...(at.get(key) ?? []), slice]);
  }
  const meeting = (place, { other, lo, hi }) => (at.get(`${place} ${other}`) ?? []).filter((slice) => slice.lo <= hi && lo <= slice.hi);
  for (const slice of map) {
    const { place, other, below, middle, above } = slice;
    if (!paths.has(other)) paths.set(other, [new Path2D(), new Path2D()]);
    const path = paths.get(other)[answers.first + place * step() > time ? 1 : 0];
    const piece = (...corners) => {
      corners.forEach(([where, y], k) => (k ? path.lineTo(x(where), y) : path.moveTo(x(where), y)));
      path.closePath();
    };
    const before = meeting(place - 1, slice);
    for (const last of before) piece([place - 1, last.below], [place, below], [place, above], [place - 1, last.above]);
    if (!before.length) piece([Math.max(place - 0.5, 0), middle], [place, below], [place, above]);
    if (!meeting(place + 1, slice).length) piece([place, below], [Math.min(place + 0.5, COLUMNS), middle], [place, above]);
  }
  return paths;
}

function drawMap() {
  const { pen, width, height } = fit($("map")), agent = scenario.agents[chosen];
  if (!agent || !answers.valid) return;
  const { left, top, wide, high, px, py } = axes(width, height), length = answers.lengths[chosen];
  // While time goes on, what is still to come is faint: the map is drawn as the agents drive.
  for (const [other, [now, later]] of shapes(px, py)) {
    pen.fillStyle = colour(other);
    pen.globalAlpha = 0.55;
    pen.fill(now);
    pen.globalAlpha = playing ? 0.12 : 0.55;
    pen.fill(later);
  }
  pen.strokeStyle = tint("--own");
  pen.lineWidth = 2;
  for (const [from, to, faint] of [[-Infinity, time, 1], [time - step(), Infinity, playing ? 0.2 : 1]]) {
    pen.globalAlpha = faint;
    pen.beginPath();
    track().filter(([t]) => from <= t && t <= to).forEach(([t, l], k) => (k ? pen.lineTo(px(t), py(l)) : pen.moveTo(px(t), py(l))));
    pen.stroke();
  }
  pen.globalAlpha = 1;
  const hold = answers.holds?.[chosen];
  if (hold !== undefined && isFinite(hold)) {
    pen.setLineDash([5, 4]);
    pen.beginPath();
    pen.moveTo(left, py(hold));
    pen.lineTo(left + wide, py(hold));
    pen.stroke();
    pen.setLineDash([]);
  }
  pen.strokeStyle = pen.fillStyle = tint("--accent");
  pen.beginPath();
  pen.moveTo(px(time), top);
  pen.lineTo(px(time), top + high);
  pen.stroke();
  pen.beginPath();
  pen.arc(px(time), py(rows(pcr.pcr_places(time), 6)[chosen][3]), 5, 0, 7);
  pen.fill();
  pen.strokeStyle = tint("--edge");
  pen.lineWidth = 1;
  pen.strokeRect(left, top, wide, high);
  pen.fillStyle = tint("--dim");
  pen.fillText("travelled length [m]", 4, 14);
  pen.textAlign = "right";
  pen.fillText(length.toFixed(1), left - 6, top + 10);
  pen.fillText("0", left - 6, top + high);
  pen.fillText(answers.last.toFixed(1), left + wide, height - 10);
  pen.textAlign = "center";
  pen.fillText("time [s]", left + wide / 2, height - 10);
  pen.textAlign = "left";
  pen.fillText(answers.first.toFixed(0), left, height - 10);
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
