// The averaged fields: slices, and what summary.json says of each average ("average_<name>"): means over its box, the
// fields just above and below the junctions of fibres, where grains stagnate and voids stay open, and the fastest lanes.

const averagesOf = (run) => Object.entries(run.summary ?? {}).filter(([key, value]) => /^average_/.test(key) && isObject(value));

const averageTable = (a) => {
  const relative = ["above", "below"].some((side) => isNumber(a.junctions?.[side]?.speed_over_section_mean));
  const row = (place, fraction, down, speed) => [place, significant(fraction), isNumber(down) ? significant(1e3 * down) : "no grains", ...(relative ? [significant(speed)] : [])];
  const beside = (side) => {
    const there = a.junctions?.[side];
    const fraction = there?.solid_fraction_of_free_space ?? there?.solid_fraction;
    return isNumber(fraction) && there.lines > 0 &&
      row(`Within one diameter ${side} a junction (mean of ${there.lines})`, fraction, there.downward_velocity_m_per_s, there.speed_over_section_mean);
  };
  const rows = [row("The whole box, outside fibres", a.solid_fraction_of_free_space, -a.mean_velocity_m_per_s?.[2]), beside("above"), beside("below")];
  return table([{ title: "Where" }, { title: "Solid fraction", number: true }, { title: "Downwards, mm/s", number: true }, ...(relative ? [{ title: "Speed / mean", number: true }] : [])], rows.filter((r) => r));
};

const averageNote = (a) => {
  const cells = Array.isArray(a.cells) && `${a.cells.join(" × ")} cells of ${a.spacing_m.map((s) => given("length", s)).join(" × ")}`;
  const window = Array.isArray(a.window_s) && `Mean of ${a.looks} looks from ${significant(a.window_s[0])} s to ${significant(a.window_s[1])} s`;
  const kernel = a.kernel && `kernel: ${a.kernel.name}, half width ${given("length", a.kernel.half_width_m)}`;
  return note([window, cells, kernel, `mass in the box ${withUnit("mass", a.mass_kg)}`].filter((t) => t).join("; ") + ".");
};

// "2.0 (1.4 to 2.6 from layer to layer)" of {mean, least, most}.
const rangeText = (range, factor = 1) => isNumber(range?.mean) && `${significant(range.mean / factor)} (${significant(range.least / factor)} to ${significant(range.most / factor)} from layer to layer)`;

// The fastest lane of each horizontal layer: how much faster than the layer's mean, and where.
const lanesOf = ({ lanes }) => {
  if (!lanes) return null;
  const l = lanes.layers, words = facts([
    ["Fastest lane", rangeText(lanes.peak_over_mean) && `${rangeText(lanes.peak_over_mean)} times the mean downward mass flux of its layer`],
    ["Its distance from the axis", rangeText(lanes.distance_from_axis_m, 1e-3) && `${rangeText(lanes.distance_from_axis_m, 1e-3)} mm`],
  ]);
  if (!Array.isArray(l?.z_m) || l.z_m.length < 2 || !Array.isArray(l.distance_from_axis_m)) return words;
  const order = l.z_m.map((_, k) => k).sort((a, b) => l.z_m[a] - l.z_m[b]);
  const distances = order.map((k) => (isNumber(l.distance_from_axis_m[k]) ? 1e3 * l.distance_from_axis_m[k] : null));
  return [words, chart({ x: order.map((k) => 1e3 * l.z_m[k]), xName: "height", xText: (z) => `${significant(z)} mm`, xLabel: "height z of the layer, mm", yLabel: "from the axis, mm",
    series: [{ label: "fastest lane", values: distances, colour: colourOf(0),
      text: (v, k) => `${significant(v)} mm${isNumber(l.peak_over_mean?.[order[k]]) ? `, ${significant(l.peak_over_mean[order[k]])} × mean` : ""}` }] })];
};

// Numbers that the page has no words of its own for.
const namedNumber = ([key, value]) => {
  const [name, unit] = lowerFirst(inWords(key)).split(", ");
  return [name, valueText(value), unit].filter(Boolean).join(" ");
};
const kToldOfAverage = ["looks", "seconds", "mass_kg", "solid_fraction_of_free_space", "mean_velocity_m_per_s", "window_s", "cells", "spacing_m", "kernel", "junctions", "lanes"];
const otherNumbers = (a) => {
  const text = (value) => isNumber(value) ? valueText(value)
    : isObject(value) && Object.values(value).some(isNumber) ? Object.entries(value).filter(([, v]) => isNumber(v)).map(namedNumber).join(", ") : null;
  const others = Object.entries(a).filter(([key, value]) => !kToldOfAverage.includes(key) && text(value));
  return others.length > 0 ? facts(others.map(([key, value]) => [inWords(key), text(value)])) : null;
};

addSection({
  id: "averages",
  title: "Averaged fields",
  make: ({ runs }) => perRun(runs, (run) => [
    averagesOf(run).map(([key, value]) => [
      h("h3", {}, capital(key.replace(/^average_/, ""))), averageTable(value), otherNumbers(value), lanesOf(value), averageNote(value)]),
    gallery(run, "averages")]),
});
