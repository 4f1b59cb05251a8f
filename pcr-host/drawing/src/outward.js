// The ends of an interval as texts, rounded outward: what is printed contains it.
function outward([from, to], decimals = 3) {
  const towards = (value, step) => {
    const text = value.toFixed(decimals), inside = step < 0 ? Number(text) > value : Number(text) < value;
    return inside ? (Number(text) + step * 10 ** -decimals).toFixed(decimals) : text;
  };
  return [towards(from, -1), towards(to, 1)].map((text) => text.replace(/^-(?=[0.]*$)/, ""));
}
