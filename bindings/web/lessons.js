// Lessons of a minute: a scenario of two agents, what it shows, what to drag and to look at. `reached` asks the module whether that is so;
// lessons.py drags as they say, and proves every figure.
const disc = (id, x, y, degrees, v_max, ...path) => ({ id, radius: 0.3, v_max, a_max: 0.5, t_start: 0, start: { x, y, heading: degrees * DEGREE }, path });
const ahead = (length) => ({ kind: "line", length });
const bent = (radius, degrees) => ({ kind: "arc", radius, sweep: degrees * DEGREE });

const LESSONS = [
  {
    name: "diagonal", title: "Why a diagonal?",
    agents: [disc(1, -4, 0, 0, 1, ahead(6)), disc(2, 0, 0, 0, 0.5, ahead(5))],
    why: ["Agent 2 drives ahead of agent 1 on the same line, at 0.5 m/s.",
      "Agent 1 must not be where agent 2 is, and that place moves: in the collision map it is a diagonal that rises by 0.5 m each second."],
    drag: "Drag the start of agent 1, the large circle, to the right by about 2 m.",
    look: "Look at the map: the diagonal comes down, until the line of agent 1 runs into it.",
    reached: () => answers.conflicts.length > 0,
    then: "Agent 1 catches up: where its line is inside the diagonal, the two collide.",
  },
  {
    name: "delay", title: "What does a delay do?",
    agents: [disc(1, -3, 0, 0, 1, ahead(6)), disc(2, 0, -3, 90, 1, ahead(10))],
    why: ["Two agents cross, and both are at the crossing at the same time."],
    drag: "In the map, drag the line of agent 1 to the right by about 2 s: it starts later.",
    look: "Look at the region: it stays, because it depends on the path of agent 1 and on how agent 2 drives, not on when agent 1 does.",
    reached: () => answers.conflicts.length === 0,
    then: "No conflict: agent 1 passes after agent 2. Plan delays finds such delays for all agents.",
  },
  {
    name: "opposite", title: "Opposite directions",
    agents: [disc(1, -3, 0, 0, 1, ahead(5)), disc(2, 3, 0, 180, 1, ahead(5))],
    why: ["Two agents drive towards each other on one line, so the region falls: agent 2 comes from the end of the path of agent 1.",
      "No delay helps: press Plan delays, and read why."],
    drag: "Drag the start of agent 1 up by about 1 m.",
    look: "Look at the map: the region shrinks, and is gone once the paths are 0.6 m apart, the sum of both radii.",
    reached: () => answers.map.length === 0,
    then: "No region: on paths that are far enough apart, both drive when they like.",
  },
  {
    name: "tangent", title: "A tangent",
    agents: [disc(1, -3, 0, 0, 1, ahead(6)), disc(2, -1.5, 1.95, -90, 0.8, bent(1.5, 180))],
    why: ["The curve of agent 2 comes near the path of agent 1 and never crosses it.",
      "There is a region all the same: the paths are 0.45 m apart at the nearest point, and the radii add up to 0.6 m."],
    drag: "Drag the start of agent 1 down by about 0.2 m.",
    look: "Look at the map: the region shrinks to a point, and is gone beyond 0.6 m, where one disc only touches the lane of the other, as a tangent does.",
    reached: () => answers.map.length === 0,
    then: "No region: the two cannot meet, whenever they start.",
  },
  {
    name: "rectangle", title: "A rectangle",
    agents: [{ id: 1, v_max: 1, a_max: 0.5, t_start: 0, start: { x: -2, y: 0, heading: 0 }, path: [ahead(2), ahead(3)],
      footprint: { polygon: [[0.8, 0.3], [-0.8, 0.3], [-0.8, -0.3], [0.8, -0.3]].map(([x, y]) => ({ ahead: x, left: y })) } },
      { ...disc(2, 0, -0.55, 0, 1), radius: 0.2 }],
    why: ["Agent 1, a rectangle of 1.6 m by 0.6 m, passes agent 2, which stands 5 cm beside its way."],
    drag: "Drag the last square up by about 1.5 m: now the path turns left beside agent 2.",
    look: "Look at the map: there is a region, as a corner at the rear swings out in the turn; it is as wide as the map, because agent 2 stands there all the time.",
    reached: () => answers.conflicts.length > 0,
    then: "A rectangle needs more room in a turn than on a line. Outline: disc shows that a disc around it needs still more.",
  },
];

/** Opens a lesson; without one, what is shown stays. */
function startLesson(k) {
  const found = LESSONS[k];
  if (found) return open(structuredClone({ name: `lesson-${found.name}`, agents: found.agents }), k);
  lesson = -1;
  update();
}

/** The text of the lesson, and whether what it says has happened. */
function teach() {
  const found = LESSONS[lesson], emphasized = document.createElement("strong");
  $("lesson").value = lesson;
  $("taught").hidden = !found;
  if (!found) return;
  emphasized.textContent = found.drag;
  $("why").replaceChildren(`${found.why.join(" ")} `, emphasized, ` ${found.look}`);
  // Its room is kept free, so that nothing moves below a drag that reaches it.
  $("reached").textContent = `✓ ${found.then}`;
  $("reached").style.visibility = answers.valid && found.reached() ? "visible" : "hidden";
}
