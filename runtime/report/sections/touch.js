// How much of the fibres and walls the grains touch: unrolled pictures, and the numbers of summary.json.

// Every part of summary.touch that has a touched share, by its path: "fibres", "fibres, upper half", "channel".
const touchedParts = (value, path = []) => {
  if (!isObject(value)) return [];
  const inner = Object.entries(value).flatMap(([key, one]) => touchedParts(one, key === "walls" ? path : [...path, key.replace(/_/g, " ")]));
  return isNumber(value.touched_share) ? [[path.join(", ") || "all", value], ...inner] : inner;
};

// Columns of the table, where a run has them: [title, text(part)].
const kTouchColumns = [
  ["Touched, share of time", (p) => isNumber(p.touched_share) && percent(p.touched_share)],
  ["Never touched, share of area", (p) => isNumber(p.dead_share) && percent(p.dead_share)],
  ["Out of reach, share of area", (p) => isNumber(p.out_of_reach_share) && percent(p.out_of_reach_share)],
  ["Contacts at a time", (p) => isNumber(p.contacts_per_m2) && isNumber(p.exposed_area_m2) && significant(p.contacts_per_m2 * p.exposed_area_m2)],
  ["Contacts, 1/mm²", (p) => isNumber(p.contacts_per_m2) && significant(1e-6 * p.contacts_per_m2)],
  ["Mean normal force, µN", (p) => isNumber(p.mean_normal_force_N) && significant(1e6 * p.mean_normal_force_N)],
  ["Pressure, Pa", (p) => isNumber(p.pressure_Pa) && significant(p.pressure_Pa)],
  ["Sliding work, W/m²", (p) => isNumber(p.sliding_work_W_per_m2) && significant(p.sliding_work_W_per_m2)],
];

const touchTable = (touch) => {
  const parts = touchedParts(touch);
  if (parts.length === 0) return anyTable(touch);
  const columns = kTouchColumns.filter(([, text]) => parts.some(([, p]) => text(p)));
  return table([{ title: "Surface" }, ...columns.map(([title]) => ({ title, number: true }))],
    parts.map(([name, p]) => [capital(name), ...columns.map(([, text]) => text(p) || "–")]));
};

const touchWords = ({ touch }) => touch && [
  touchTable(touch),
  touchedParts(touch).some(([, p]) => p.out_of_reach_share > 0) && note("Out of reach: where no grain fits, in corners of fibres and walls; it counts as never touched."),
  Array.isArray(touch.window_s) && note(`Counted from ${significant(touch.window_s[0])} s to ${significant(touch.window_s[1])} s.`),
];

addSection({
  id: "touch",
  title: "Touch maps",
  make: ({ runs }) => perRun(runs, (run) => [touchWords(run.summary ?? {}), gallery(run, "touch")]),
});
