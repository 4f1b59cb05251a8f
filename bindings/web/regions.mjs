// Two robots that cross: their regions, from JavaScript. node bindings/web/regions.mjs pcr_web.wasm
import { readFileSync } from "node:fs";

const module = await WebAssembly.instantiate(readFileSync(process.argv[2]));
const pcr = module.instance.exports;

// x, y, heading, radius, start, v_max, a_max, then the legs: [length, 0] a line, [radius, sweep] an arc, left positive.
const agents = [
  { disc: [-4, 0, 0, 0.4, 0, 1, 0.5], legs: [[8, 0]] },
  { disc: [0, -4, Math.PI / 2, 0.4, 0, 1, 0.5], legs: [[3, 0], [2, -1.5]] },
];
const input = new Float64Array(pcr.memory.buffer, pcr.pcr_input(), agents.length * pcr.pcr_stride());
agents.forEach(({ disc, legs }, k) => input.set([...disc, legs.length, ...legs.flat()], k * pcr.pcr_stride()));

// Rows of an answer, each of so many numbers. Less than none means no answer, with the reason.
function rows(count, width) {
  if (count < 0) throw new Error(new TextDecoder().decode(new Uint8Array(pcr.memory.buffer, pcr.pcr_message(), pcr.pcr_message_length())));
  const numbers = new Float64Array(pcr.memory.buffer, pcr.pcr_output(), count * width);
  return Array.from({ length: count }, (_, k) => [...numbers.slice(k * width, (k + 1) * width)]);
}

rows(pcr.pcr_build(agents.length), 0);
// The last two numbers: whether the other stands there before, and after.
for (const [ego, other, from, to, near, far, , , before, after] of rows(pcr.pcr_regions(), 10))
  console.log(`agent ${ego + 1} keeps out of ${near.toFixed(3)}..${far.toFixed(3)} m from ${(before ? -Infinity : from).toFixed(3)} to ${(after ? Infinity : to).toFixed(3)} s because of agent ${other + 1}`);
for (const [i, j, from, to, depth] of rows(pcr.pcr_conflicts(), 10))
  console.log(`conflict of ${i + 1} and ${j + 1} from ${from.toFixed(3)} to ${to.toFixed(3)} s, ${depth.toFixed(3)} m deep`);
console.log("delays", rows(pcr.pcr_plan(), 1).map(([delay]) => delay.toFixed(3)).join(", "));
