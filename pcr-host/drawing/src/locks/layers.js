
// ---- Layers of an audit: groups as written, pairs that can touch, pairs that are excluded in vain ----

/** Lists the pairs that can touch, those without a common node first; nothing on a page without an audit. */
function list_gaps() {
  if (!data.audit) return;
  const most = 200;
  const gaps = [...data.audit.gaps].sort((a, b) => (b.relation === "apart") - (a.relation === "apart") || b.depth - a.depth);
  text(about, "h2", gaps.length === 1 ? "1 pair that can touch" : gaps.length + " pairs that can touch");
  if (gaps.length === 0) return;
  text(about, "p", "Two vehicles at these places can touch although they obey the file. Red circles show where, large ones where the two places share no node.");
  const table = text(about, "table", "");
  table.className = "pairs";
  const head = text(text(table, "thead", ""), "tr", "");
  for (const title of ["one", "other", "depth [m]"]) text(head, "th", title);
  const body = text(table, "tbody", "");
  for (const gap of gaps.slice(0, most)) {
    const row = text(body, "tr", ""), button = text(text(row, "td", ""), "button", gap.a);
    button.type = "button";
    button.addEventListener("click", () => show_gap(gap));
    text(row, "td", gap.b);
    text(row, "td", gap.depth.toFixed(3));
  }
  if (gaps.length > most) text(about, "p", `and ${gaps.length - most} more`);
}

/** Shows the place of a pair, with an edge of it. */
function show_gap(gap) {
  const at = data.levels.indexOf(gap.level);
  if (at >= 0 && Number(level.value) !== at) { level.value = String(at); draw(); }
  pin(gap.edges[0] ?? gap.edges[1]);
  const size = 20 * STEPS * data.radius;
  look([gap.x - size / 2, -gap.y - size / 2, size, size]);
}

/** Draws the layers of the level that is shown, those that are chosen; nothing on a page without an audit. */
function draw_layers() {
  if (!data.audit) return;
  const COLOURS = ["#2f8f4e", "#8a5bb5", "#c08a1e", "#2aa1a6", "#b5527f", "#6c7a1f"];
  const { groups, gaps, needless } = data.audit;
  const kinds = [["corridors", "corridors of vehicles"], ["groups", groups.length + " groups, one vehicle each"],
    ["gaps", gaps.length + " pairs that can touch"], ["needless", needless.length + " pairs excluded needlessly"]];
  let controls = document.getElementById("layers");
  if (!controls) {
    controls = text(document.getElementById("controls"), "span", "");
    controls.id = "layers";
    controls.setAttribute("role", "group");
    controls.setAttribute("aria-label", "Layers");
    for (const [kind, name] of kinds) {
      const label = text(controls, "label", "");
      const box = text(label, "input", "");
      box.type = "checkbox";
      box.checked = true;
      box.id = "layer-" + kind;
      text(label, "span", "").className = "swatch " + kind;
      label.append(name);
      box.addEventListener("change", draw_layers);
    }
  }
  document.getElementById("audit-layers")?.remove();
  const layers = make(world, "g", { id: "audit-layers" });
  world.insertBefore(layers, targets);
  const on = (kind) => document.getElementById("layer-" + kind).checked;
  corridors.style.display = on("corridors") ? "" : "none";
  const at = Number(level.value), here = (k) => data.edges[k].level === at;
  if (on("groups")) {
    const layer = make(layers, "g", { class: "groups", "pointer-events": "none" });
    groups.forEach(([, edges, names, outline, on], k) => {
      if (outline.length > 0) {
        const colour = COLOURS[k % COLOURS.length];
        if (on === at) make(layer, "polygon", { class: "zone", points: outline.join(" "), style: `stroke: ${colour}; fill: ${colour}` });
        return;
      }
      const group = make(layer, "g", { style: "stroke: " + COLOURS[k % COLOURS.length] });
      for (const edge of edges.filter(here)) {
        if (data.edges[edge].path !== "") make(group, "path", { d: data.edges[edge].path, "stroke-width": 0.4 * STEPS * data.radius });
      }
      for (const name of names) {
        const node = nodes.get(name);
        if (node) make(group, "circle", { cx: node.getAttribute("cx"), cy: node.getAttribute("cy"), r: 0.35 * STEPS * data.radius });
      }
    });
  }
  if (on("needless")) {
    const layer = make(layers, "g", { class: "needless", "pointer-events": "none" });
    for (const [edge, , [[x1, y1], [x2, y2]]] of needless) if (here(edge)) make(layer, "line", { x1, y1, x2, y2 });
  }
  if (on("gaps")) {
    const layer = make(layers, "g", { class: "gaps" });
    for (const gap of gaps) {
      if (gap.level !== (data.levels[at] ?? "")) continue;
      const r = (gap.relation === "apart" ? 1 : 0.4) * STEPS * data.radius;
      const mark = make(layer, "circle", { cx: gap.x, cy: gap.y, r });
      make(mark, "title", {}).textContent = `${gap.a} and ${gap.b} (${gap.relation}): ${gap.depth.toFixed(3)} m deep`;
      mark.addEventListener("click", (event) => { event.stopPropagation(); pin(gap.edges[0] ?? gap.edges[1]); });
    }
  }
}
