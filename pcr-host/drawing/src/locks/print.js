
// ---- At scale: on paper, and as SVG ----

/** What is seen, 1 : n with a round n so that it fits on a sheet of A4 across, and its size there [mm]. A step is a millimetre. */
function sheet() {
  const [width, height] = [seen[2], seen[3]], least = Math.max(width / 277, height / 180), power = 10 ** Math.floor(Math.log10(least));
  const n = [1, 2, 2.5, 5, 10].map((m) => m * power).find((n) => n >= least);
  return { n, width: width / n, height: height / n };
}

/** A bar of a round length on the sheet: a tenth to a quarter of its width, in steps. */
function bar_length() {
  const most = seen[2] / 4, power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].map((m) => m * power).find((length) => length <= most);
}

/** The picture as it is seen, with a bar that is so long: an SVG of its size on paper. */
function picture_at_scale() {
  const { n, width, height } = sheet(), [x, y, across, down] = seen, length = bar_length(), copy = svg.cloneNode(true);
  for (const [name, value] of Object.entries({ xmlns: "http://www.w3.org/2000/svg", viewBox: seen.join(" "), width: width + "mm", height: height + "mm" })) copy.setAttribute(name, value);
  copy.removeAttribute("style");
  copy.querySelectorAll(".target").forEach((target) => target.remove());
  // Colours of the light page.
  const style = make(copy, "style", {});
  style.textContent = ":root { --paper: #ffffff; --ink: #1d2125; --dim: #565d66; --accent: #0b57d0; --hit: #d40000; --edge: #7a828c; }" +
    [...document.styleSheets].flatMap((sheet) => [...sheet.cssRules]).filter((rule) => rule.style && /^(svg (path|\.)|\.)/.test(rule.selectorText)).map((rule) => rule.cssText).join("");
  copy.prepend(style);
  const bar = make(copy, "g", { id: "bar", transform: `translate(${x + 0.03 * across} ${y + 0.97 * down})` });
  make(bar, "path", { d: `M0 ${-0.01 * across}V0H${length}V${-0.01 * across}`, style: `stroke: #1d2125; stroke-width: ${0.5 * n}` });
  const words = make(bar, "text", { y: -0.015 * across, "font-size": 4 * n, "font-family": "sans-serif", fill: "#1d2125" });
  words.textContent = `${length / STEPS} m, 1 : ${n}`;
  return copy;
}

document.getElementById("save").addEventListener("click", () => {
  const blob = new Blob([new XMLSerializer().serializeToString(picture_at_scale())], { type: "image/svg+xml" });
  const anchor = document.createElement("a");
  anchor.download = "locks.svg";
  anchor.setAttribute("href", URL.createObjectURL(blob));
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(anchor.getAttribute("href")), 1000);
});

// The sheet has the picture alone, at its scale.
let paper = null;
addEventListener("beforeprint", () => {
  paper?.remove();
  paper = picture_at_scale();
  paper.id = "paper";
  for (const side of ["width", "height"]) paper.style[side] = paper.getAttribute(side);
  document.body.append(paper);
});
addEventListener("afterprint", () => { paper?.remove(); paper = null; });
document.getElementById("print").addEventListener("click", () => print());
