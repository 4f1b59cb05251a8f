/** A bar of a round length in the lower left corner of a canvas: the largest that is no longer than a sixth of its width. */
function drawScale(context, width, height, metre) {
  const most = width / 6 / metre, power = 10 ** Math.floor(Math.log10(most));
  const length = [5, 2, 1].map((m) => m * power).find((length) => length <= most) ?? power;
  const [left, right, bottom] = [10, 10 + length * metre, height - 10];
  context.save();
  context.strokeStyle = context.fillStyle = theme.ink;
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(left, bottom - 6); context.lineTo(left, bottom); context.lineTo(right, bottom); context.lineTo(right, bottom - 6);
  context.stroke();
  context.font = "12px sans-serif";
  context.textAlign = "center";
  context.textBaseline = "alphabetic";
  const text = length >= 1000 ? `${length / 1000} km` : length >= 1 ? `${length} m` : `${Number((length * 1000).toPrecision(3))} mm`;
  context.lineWidth = 3;
  context.strokeStyle = theme.paper;
  context.strokeText(text, (left + right) / 2, bottom - 6);
  context.fillText(text, (left + right) / 2, bottom - 6);
  context.restore();
}

