// Scenarios in the format of the tool: read, written for the module, their geometry, and how a link holds them.

/** Rows of an answer; throws the reason if there is none. */
function rows(count, width) {
  const memory = pcr.memory.buffer;
  if (count < 0) throw new Error(new TextDecoder().decode(new Uint8Array(memory, pcr.pcr_message(), pcr.pcr_message_length())));
  const numbers = new Float64Array(memory, pcr.pcr_output(), count * width);
  return Array.from({ length: count }, (_, k) => Array.from(numbers.subarray(k * width, (k + 1) * width)));
}

/** Parts of at most one turn each, equally long, that the tool makes of a leg. A full turn may come in with a rounded 2π. */
const turns = (leg) => (leg.kind === "line" ? 1 : Math.max(1, Math.ceil(Math.abs(leg.sweep) / (2 * Math.PI) * (1 - 1e-12))));

/** The legs as the library takes them. With three turns or more, lengths may differ from the tool's in the last digit. */
const parts = (path) => path.flatMap((leg) => (turns(leg) === 1 ? [leg] : Array(turns(leg)).fill({ ...leg, sweep: leg.sweep / turns(leg) })));

const pair = (leg) => (leg.kind === "line" ? [leg.length, 0] : [leg.radius, leg.sweep]);

/** The corners of an agent's outline, ahead and left of its reference point; none for a disc. */
const polygon = (agent) => (agent.footprint?.polygon ?? []).map(({ ahead, left }) => [ahead, left]);

/** How far an agent reaches from its reference point. */
const reach = (agent) => (agent.footprint ? Math.max(...polygon(agent).map(([x, y]) => Math.hypot(x, y))) + (agent.footprint.growth ?? 0) : agent.radius);

/** Twice the area on the left of the way from one corner over the next to a third. */
const bend = ([ax, ay], [bx, by], [cx, cy]) => (bx - ax) * (cy - by) - (by - ay) * (cx - bx);

/** Whether all corners bend to one side, once around, by more than rounding. */
function convex(corners) {
  const at = (k) => corners[k % corners.length], size = Math.max(...corners.flat().map(Math.abs));
  const side = Math.sign(bend(at(0), at(1), at(2)));
  // Every corner is on the same side of every edge: this excludes polygons that wind around twice.
  return side !== 0 && corners.every((a, k) => corners.every((other, j) => j === k || j === (k + 1) % corners.length || side * bend(a, at(k + 1), other) > 1e-9 * size * size));
}

/** Counter-clockwise, from the hindmost corner on, as the tool has them: with another first corner the last digits may differ. */
function ordered(corners) {
  if (corners.length < 3) return corners;
  const left = bend(...corners) > 0 ? corners : [...corners].reverse();
  const first = left.reduce((best, corner, k) => (corner[0] < left[best][0] || (corner[0] === left[best][0] && corner[1] < left[best][1]) ? k : best), 0);
  return [...left.slice(first), ...left.slice(0, first)];
}

function write(agents) {
  const stride = pcr.pcr_stride(), input = new Float64Array(pcr.memory.buffer, pcr.pcr_input(), AGENTS * stride);
  agents.forEach((a, k) => {
    // The tool leaves out what has no length.
    const legs = parts(a.path).filter((leg) => whole(leg) !== 0);
    const corners = ordered(polygon(a)), radius = a.footprint ? a.footprint.growth ?? 0 : a.radius;
    input.set([a.start.x, a.start.y, a.start.heading, radius, a.t_start, a.v_max, a.a_max, legs.length, ...legs.flatMap(pair)], k * stride);
    input.set([corners.length, ...corners.flat()], k * stride + 8 + 2 * LEGS);
  });
}

const KEYS = {
  top: ["format", "version", "name", "agents", "warnings"], agent: ["id", "label", "radius", "footprint", "v_max", "a_max", "t_start", "start", "path"],
  footprint: ["polygon", "growth"], corner: ["ahead", "left"], start: ["x", "y", "heading"], line: ["kind", "length"], arc: ["kind", "radius", "sweep"],
};

// As the tool: the largest magnitude of a number, the longest label, and what would end a line or turn around what is beside it.
const LIMIT = 1e10, LABEL = 200, CONTROL = /[\0-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ufeff]/;
const RANGES = { any: [-LIMIT, "-1e10 to 1e10"], "from 0": [0, "0 to 1e10"], "above 0": [Number.MIN_VALUE, "above 0, up to 1e10"] };
const RANGE_OF = { radius: "above 0", v_max: "above 0", a_max: "above 0", length: "from 0" };

/** What a file has that this page does not know is refused, never dropped, and so is what the tool would refuse. */
function read(found) {
  const refuse = (why) => { throw new Error(why); };
  const object = (value, keys, where) => {
    if (typeof value !== "object" || value === null || Array.isArray(value)) refuse(`${where}not an object`);
    const other = Object.keys(value).find((name) => !keys.includes(name));
    return other === undefined ? value : refuse(`${where}"${other}" is not known here`);
  };
  const number = (value, what, range = "any") => {
    if (typeof value !== "number" || !isFinite(value)) refuse(`${what} is not a number`);
    const [least, allowed] = RANGES[range];
    return least <= value && value <= LIMIT ? value : refuse(`${what}: ${value} is out of range; allowed is ${allowed}`);
  };
  const text = (value, what) => (typeof value === "string" ? value : refuse(`${what} is not a text`));
  const printable = (value, what) => {
    const control = CONTROL.exec(value), length = [...value].length;
    if (control) refuse(`${what} has the control character U+${control[0].charCodeAt(0).toString(16).toUpperCase().padStart(4, "0")}`);
    if (length > LABEL) refuse(`${what} has ${length} characters; allowed are up to ${LABEL}`);
  };
  if (!Array.isArray(found?.agents)) refuse("not a scenario: no agents");
  object(found, KEYS.top, "");
  if (found.format !== undefined && found.format !== "pcr-scenario") refuse(`format ${found.format} is not pcr-scenario`);
  if (found.version !== undefined && found.version !== 1) refuse(`version ${found.version} is not 1`);
  if (found.warnings !== undefined && !(Array.isArray(found.warnings) && found.warnings.every((warning) => typeof warning === "string"))) refuse("the warnings are not a list of texts");
  if (found.agents.length > AGENTS) refuse(`${found.agents.length} agents: there is room for ${AGENTS}`);
  const ids = new Set();
  const agents = found.agents.map((agent, k) => {
    const name = `agent ${k + 1}`;
    object(agent, KEYS.agent, `${name}: `);
    // Beyond 2^53 two numbers of a file can be one here.
    if (!(typeof agent.id === "string" && agent.id) && !(Number.isSafeInteger(agent.id) && agent.id >= 0)) refuse(`${name}: its id is no whole number from 0 to 2^53, and no name`);
    if (typeof agent.id === "string") {
      printable(agent.id, `${name}: its id`);
      if (/^\+?\d+$/.test(agent.id) && BigInt(agent.id.replace("+", "")) < 2n ** 64n) refuse(`${name}: its id "${agent.id}" could be taken for the number; write it without quotation marks, or give a name`);
      if (agent.label !== undefined) refuse(`${name}: it has a label, and its id is a text`);
    }
    if (typeof agent.id !== typeof found.agents[0].id) refuse(`${name}: some ids are numbers and others names`);
    if (ids.has(agent.id)) refuse(`${name}: its id ${agent.id} is given twice`);
    ids.add(agent.id);
    if (agent.label !== undefined) printable(text(agent.label, `${name}, label`), `${name}, label`);
    if (!Array.isArray(agent.path) || agent.path.length > LEGS) refuse(`${name}: 0 to ${LEGS} legs`);
    for (const field of ["v_max", "a_max"]) number(agent[field], `${name}, ${field}`, RANGE_OF[field]);
    if (agent.footprint === undefined) number(agent.radius, `${name}, radius`, RANGE_OF.radius);
    else {
      if (agent.radius !== undefined) refuse(`${name}: there is a radius or a footprint, not both`);
      const { polygon: corners, growth } = object(agent.footprint, KEYS.footprint, `${name}, footprint: `);
      if (growth !== undefined) number(growth, `${name}, growth`, "from 0");
      if (!Array.isArray(corners) || corners.length < 3 || corners.length > CORNERS) refuse(`${name}: 3 to ${CORNERS} corners can be edited here`);
      for (const corner of corners) for (const field of KEYS.corner) number(object(corner, KEYS.corner, `${name}, corner: `)[field], `${name}, ${field}`);
      if (!convex(polygon(agent))) refuse(`${name}: only convex outlines, without straight corners, can be edited here`);
    }
    object(agent.start, KEYS.start, `${name}, start: `);
    for (const field of KEYS.start) number(agent.start[field], `${name}, ${field}`);
    const path = agent.path.map((leg, at) => {
      const where = `${name}, leg ${at + 1}`;
      if (!["line", "arc"].includes(leg?.kind)) refuse(`${where}: only lines and arcs can be edited here`);
      object(leg, KEYS[leg.kind], `${where}: `);
      for (const field of KEYS[leg.kind].slice(1)) number(leg[field], `${where}, ${field}`, RANGE_OF[field]);
      return { ...leg };
    });
    const t_start = agent.t_start === undefined ? 0 : number(agent.t_start, `${name}, t_start`);
    if (path.reduce((sum, leg) => sum + turns(leg), 0) > LEGS) refuse(`${name}: 0 to ${LEGS} legs, each turn of an arc counted`);
    const length = path.reduce((sum, leg) => sum + whole(leg), 0), peak = Math.min(agent.v_max, Math.sqrt(length * agent.a_max));
    const duration = length && length / peak + peak / agent.a_max;
    if (length > LIMIT) refuse(`${name}, path: ${length} m long; allowed is up to 1e10`);
    if (!(duration <= LIMIT && Math.abs(t_start + duration) <= LIMIT)) refuse(`${name}: the motion takes ${duration} s from ${t_start} s; allowed is up to 1e10 s`);
    const copy = { ...agent, t_start, start: { ...agent.start }, path };
    if (agent.footprint) copy.footprint = { ...agent.footprint, polygon: agent.footprint.polygon.map((corner) => ({ ...corner })) };
    return copy;
  });
  return { format: "pcr-scenario", version: 1, name: found.name === undefined ? "playground" : text(found.name, "the name"), agents };
}

/** The length of a leg. */
const whole = (leg) => (leg.kind === "line" ? leg.length : leg.radius * Math.abs(leg.sweep));

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
    const leg = agent.path[k];
    if (whole(leg) > 0 && rest <= whole(leg)) {
      const part = leg.kind === "line" ? { ...leg, length: rest } : { ...leg, sweep: leg.sweep * rest / whole(leg) };
      return joints({ start: poses[k], path: [part] })[1];
    }
    rest -= whole(leg);
  }
  return poses.at(-1);
}

/** The part of an agent's path from one length to another, as an agent. */
function cut(agent, from, to) {
  let before = 0;
  const path = agent.path.flatMap((leg) => {
    const all = whole(leg), part = Math.min(to - before, all) - Math.max(from - before, 0);
    before += all;
    if (!(part > 0)) return [];
    return [leg.kind === "line" ? { ...leg, length: part } : { ...leg, sweep: leg.sweep * part / all }];
  });
  return { start: along(agent, from), path };
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

const toLink = (found) => btoa(String.fromCharCode(...new TextEncoder().encode(JSON.stringify(found)))).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
const fromLink = (text) => JSON.parse(new TextDecoder().decode(Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (sign) => sign.charCodeAt(0))));
