function option(select, text, value) {
  const option = document.createElement("option");
  option.textContent = text;
  option.value = value;
  select.append(option);
}

/** A canvas in CSS pixels, sharp on any screen. */
function surface(id) {
  const canvas = $(id), ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) { canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio); }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return [context, width, height];
}

/** A name in its disc or beside it, above lines of whatever colour; nothing if there is no room. */
function write(c, crowd, text, disc, owner, over) {
  c.font = "bold 13px sans-serif";
  c.textAlign = "center";
  c.textBaseline = "middle";
  c.lineJoin = "round";
  const at = crowd.place(disc, owner, c.measureText(text).width + 3, 13, over);
  if (!at) return;
  c.strokeStyle = theme.paper;
  c.lineWidth = 3;
  c.strokeText(text, ...at);
  c.fillStyle = theme.ink;
  c.fillText(text, ...at);
}

/** Lines at round values. */
function ticks(lo, hi) {
  const raw = (hi - lo) / 6, power = 10 ** Math.floor(Math.log10(raw)), step = power * [1, 2, 5, 10].find((m) => m * power >= raw);
  const values = [];
  for (let k = Math.ceil(lo / step); k * step <= hi; k++) values.push(k * step);
  return values;
}

/** Lines at round values in a frame (left, top, right, bottom) [px], with their numbers and titles. Of each axis: from values to pixels, range, title. Numbers are this far below the frame. */
function drawAxes(c, [left, top, right, bottom], [x, across, titleAcross], [y, up, titleUp], below = 0) {
  c.font = "13px sans-serif";
  c.textBaseline = "alphabetic";
  c.fillStyle = theme.ink;
  c.strokeStyle = theme.grid;
  c.lineWidth = 1;
  c.textAlign = "center";
  for (const value of ticks(...across)) { c.beginPath(); c.moveTo(x(value), top); c.lineTo(x(value), bottom); c.stroke(); c.fillText(+value.toFixed(3), x(value), bottom + below + 16); }
  c.textAlign = "right";
  for (const value of ticks(...up)) { c.beginPath(); c.moveTo(left, y(value)); c.lineTo(right, y(value)); c.stroke(); c.fillText(+value.toFixed(3), left - 6, y(value) + 4); }
  c.textAlign = "center";
  c.fillText(titleAcross, (left + right) / 2, bottom + below + 33);
  c.save();
  c.translate(12, (top + bottom) / 2);
  c.rotate(-Math.PI / 2);
  c.fillText(titleUp, 0, 0);
  c.restore();
}
