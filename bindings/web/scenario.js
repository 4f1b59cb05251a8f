// Scenarios in the format of the tool: read, written for the module, their geometry, and how a link holds them.

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

const KEYS = {
  top: ["format", "version", "name", "agents", "warnings"], agent: ["id", "label", "radius", "v_max", "a_max", "t_start", "start", "path"],
  start: ["x", "y", "heading"], line: ["kind", "length"], arc: ["kind", "radius", "sweep"],
};

/** What a file has that this page does not know is refused, never dropped, and so is what the tool would refuse. */
function read(found) {
  const refuse = (why) => { throw new Error(why); };
  const object = (value, keys, where) => {
    if (typeof value !== "object" || value === null || Array.isArray(value)) refuse(`${where}not an object`);
    const other = Object.keys(value).find((name) => !keys.includes(name));
    return other === undefined ? value : refuse(`${where}"${other}" is not known here`);
  };
  const number = (value, what) => (typeof value === "number" && isFinite(value) ? value : refuse(`${what} is not a number`));
  const text = (value, what) => (typeof value === "string" ? value : refuse(`${what} is not a text`));
  if (!Array.isArray(found?.agents)) refuse("not a scenario: no agents");
  object(found, KEYS.top, "");
  if (found.format !== undefined && found.format !== "pcr-scenario") refuse(`format ${found.format} is not pcr-scenario`);
  if (found.version !== undefined && found.version !== 1) refuse(`version ${found.version} is not 1`);
  if (found.agents.length > AGENTS) refuse(`${found.agents.length} agents: there is room for ${AGENTS}`);
  const ids = new Set();
  const agents = found.agents.map((agent, k) => {
    const name = `agent ${k + 1}`;
    object(agent, KEYS.agent, `${name}: `);
    // Beyond 2^53 two numbers of a file can be one here.
    if (!(typeof agent.id === "string" && agent.id) && !(Number.isSafeInteger(agent.id) && agent.id >= 0)) refuse(`${name}: its id is no whole number from 0 to 2^53, and no name`);
    if (typeof agent.id !== typeof found.agents[0].id) refuse(`${name}: some ids are numbers and others names`);
    if (ids.has(agent.id)) refuse(`${name}: its id ${agent.id} is given twice`);
    ids.add(agent.id);
    if (agent.label !== undefined) text(agent.label, `${name}, label`);
    if (!Array.isArray(agent.path) || agent.path.length > LEGS) refuse(`${name}: 0 to ${LEGS} legs`);
    for (const field of ["radius", "v_max", "a_max"]) number(agent[field], `${name}, ${field}`);
    object(agent.start, KEYS.start, `${name}, start: `);
    for (const field of KEYS.start) number(agent.start[field], `${name}, ${field}`);
    const path = agent.path.map((leg, at) => {
      const where = `${name}, leg ${at + 1}`;
      if (!["line", "arc"].includes(leg?.kind)) refuse(`${where}: only lines and arcs can be edited here`);
      object(leg, KEYS[leg.kind], `${where}: `);
      for (const field of KEYS[leg.kind].slice(1)) number(leg[field], `${where}, ${field}`);
      return leg.sweep === 0 ? refuse(`${where}: an arc that does not turn`) : { ...leg };
    });
    return { ...agent, t_start: number(agent.t_start ?? 0, `${name}, t_start`), start: { ...agent.start }, path };
  });
  return { format: "pcr-scenario", version: 1, name: text(found.name ?? "playground", "the name"), agents };
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
