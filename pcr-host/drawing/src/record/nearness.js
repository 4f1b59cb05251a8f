
/** What is known of the pair at a time. */
function known(time) {
  const approach = pair.approaches.find(({ t }) => t[0] <= time && time <= t[1]);
  if (approach) return approach.contacts.some(([a, b]) => a <= time && time <= b) ? "contact" : "unknown";
  return pair.agents.every((agent) => place(agent, time)) ? "excluded" : "none";
}

const SAID = {
  contact: "There is a contact, whatever both did between their poses.",
  unknown: "Whether there is a contact cannot be known from these poses.",
  excluded: "A contact is excluded.",
  none: "They are not on record together at this time.",
};

/** Bounds of the clearance over time, and bars below: when a contact is proved, and when it cannot be known. */
function drawNearness() {
  const [c, width, height] = surface("nearness");
  if (!pair) return;
  const [left, top, right, bottom] = [52, 12, width - 12, height - 58];
  const [t0, t1] = [first, Math.max(last, first + 1e-3)];
  const most = Math.max(0.5, ...pair.parts.map(([, , lower]) => lower)) * 1.05, least = Math.min(0, ...pair.parts.map(([, , lower]) => lower)) * 1.05 - 0.05;
  const x = (t) => left + (t - t0) / (t1 - t0) * (right - left), y = (d) => bottom - (d - least) / (most - least) * (bottom - top);
  // Room for the bars.
  drawAxes(c, [left, top, right, bottom], [x, [t0, t1], "time [s]"], [y, [least, most], "clearance [m]"], 18);
  c.save();
  c.beginPath();
  c.rect(left, top, right - left, bottom - top + 18);
  c.clip();
  c.fillStyle = theme.accent;
  c.globalAlpha = 0.35;
  // Not thinner than a line, where both bounds are the same.
  for (const [from, to, lower, upper] of pair.parts) c.fillRect(x(from), y(upper) - 0.7, Math.max(1, x(to) - x(from)), Math.max(1.4, y(lower) - y(upper)));
  c.globalAlpha = 1;
  c.strokeStyle = theme.edge;
  c.beginPath();
  c.moveTo(left, y(0));
  c.lineTo(right, y(0));
  c.stroke();
  const bar = ([from, to], colour) => { c.fillStyle = colour; c.fillRect(x(from), bottom + 4, Math.max(2, x(to) - x(from)), 10); };
  for (const { t, contacts } of pair.approaches) { bar(t, theme.stone); contacts.forEach((contact) => bar(contact, theme.hit)); }
  c.strokeStyle = theme.own;
  c.lineWidth = 1.3;
  c.beginPath();
  c.moveTo(x(now), top);
  c.lineTo(x(now), bottom + 18);
  c.stroke();
  c.restore();
  const part = pair.parts.find(([from, to]) => from <= now && now <= to), [a, b] = pair.agents.map((agent) => agents[agent].name);
  const apart = part ? ` Around this time the clearance is at least ${outward([part[2], part[3]], 3)[0]} m.` : "";
  $("verdict").textContent = `${a} and ${b} at ${now.toFixed(2)} s: ${SAID[known(now)]}${apart} Blue: bounds of the clearance. Below: red where a contact is proved, grey where it cannot be known.`;
  const map = data.maps[place(pair.agents[0], now)?.map] || "";
  $("place").textContent = `${map ? `Map ${map}. ` : ""}Dots: poses of the record, 20 s before and after. Dashed: where the reference point of a vehicle may be.`
    + (data.isWhole ? "" : " Of this long record, only the times around nearest approaches are shown.");
}

$("play").onclick = () => play(!playing);
$("time").oninput = () => show(first + Number($("time").value) / 100);
$("pair").onchange = () => choose(Number($("pair").value));
$("approach").onchange = () => show(moment(Number($("approach").value)));
$("nearness").onclick = (event) => {
  const { left, width } = $("nearness").getBoundingClientRect();
  show(first + (event.clientX - left - 52) / (width - 64) * (last - first));
};
window.onresize = draw;
dark.addEventListener("change", () => { readTheme(); draw(); });
readTheme();
pairs.forEach(({ agents: [a, b], approaches }, k) => {
  const worst = approaches.some(({ verdict }) => verdict === "contact") ? ": contact" : approaches.length ? ": not known" : "";
  option($("pair"), `${agents[a].name} and ${agents[b].name}${worst}`, k);
});
$("summary").textContent = `${agents.length} vehicles; contacts proved: ${data.contacts}, times in which it cannot be known: ${data.unknown}`
  + (data.count > pairs.length ? `; of ${data.count} pairs the ${pairs.length} nearest are shown` : "") + (data.origin ? `; times count from ${data.origin}` : "");
if (pairs.length) choose(0); else $("verdict").textContent = "No two vehicles were on one map at one time.";
// A link may say where to begin: #40 is 40 s.
if (location.hash && pair) show(Number(location.hash.slice(1)) || first);
draw();
requestAnimationFrame(tick);
