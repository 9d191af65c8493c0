// How much of the fibres and walls the grains touch: unrolled pictures, and the numbers of summary.json.

// Every part of summary.touch that has a touched share, by its path: "fibres", "fibres, upper half", "channel".
const touchedParts = (value, path = []) => {
  if (!isObject(value)) return [];
  const inner = Object.entries(value).flatMap(([key, one]) => touchedParts(one, key === "walls" ? path : [...path, key.replace(/_/g, " ")]));
  return isNumber(value.touched_share) ? [[path.join(", ") || "all", value], ...inner] : inner;
};

const touchTable = (touch) => {
  const parts = touchedParts(touch);
  if (parts.length === 0) return anyTable(touch);
  const numbers = ["mean_normal_force_N", "pressure_Pa", "sliding_work_W_per_m2"].filter((key) => parts.some(([, p]) => isNumber(p[key])));
  return table(
    [{ title: "Surface" }, { title: "Touched, share of time", number: true }, { title: "Never touched, share of area", number: true }, ...numbers.map((key) => ({ title: inWords(key), number: true }))],
    parts.map(([name, p]) => [capital(name), percent(p.touched_share), isNumber(p.dead_share) ? percent(p.dead_share) : "–", ...numbers.map((key) => significant(p[key]))]));
};

addSection({
  id: "touch",
  title: "Touch maps",
  make: ({ runs }) => {
    const tables = runs.filter((run) => run.summary?.touch).map((run) => {
      const window = run.summary.touch.window_s;
      return [runs.length > 1 && h("h3", {}, swatch(run.colour), " ", run.label), touchTable(run.summary.touch),
        Array.isArray(window) && note(`Counted from ${significant(window[0])} s to ${significant(window[1])} s.`)];
    });
    const pictures = gallery(runs, "touch");
    return tables.length > 0 || pictures ? [tables, pictures] : null;
  },
});
