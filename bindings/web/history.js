// Undo and redo: the scenario after every change, with what else would be lost.
const STEPS = 200;
const steps = [];
let current = -1;

/** Remembers the scenario, if it is another one than before. A drag is one change. */
function remember() {
  if (!scenario || grabbed) return;
  const step = { text: JSON.stringify(scenario), hues: scenario.agents.map(hue), chosen, lesson };
  const isChange = current < 0 || steps[current].text !== step.text || steps[current].lesson !== lesson;
  if (isChange) {
    steps.splice(current + 1, Infinity, step);
    if (steps.length > STEPS) steps.shift();
    current = steps.length - 1;
  } else steps[current] = step;
  offer();
}

function offer() {
  $("undo").disabled = current < 1;
  $("redo").disabled = current + 1 >= steps.length;
}

/** One change back, or forward again. */
function travel(by) {
  remember();
  const step = steps[current + by];
  if (grabbed || !step) return;
  current += by;
  scenario = JSON.parse(step.text);
  scenario.agents.forEach((agent, k) => hues.set(agent, step.hues[k]));
  ({ chosen, lesson } = step);
  // The fields are made anew; whoever is in one stays in it.
  const field = document.activeElement?.getAttribute("aria-label");
  edit();
  if (field) document.querySelector(`[aria-label="${field}"]`)?.focus();
  update();
  offer();
}
