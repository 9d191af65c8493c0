// The averaged fields: slices, and what summary.json says of each average ("average_<name>"): means over its box, and
// the fields just above and below the junctions of fibres, where grains stagnate and voids stay open.

const averagesOf = (run) => Object.entries(run.summary ?? {}).filter(([key, value]) => /^average_/.test(key) && isObject(value));

const averageTable = (a) => {
  const row = (place, fraction, down) => [place, significant(fraction), isNumber(down) ? significant(1e3 * down) : "no grains"];
  const beside = (side) => {
    const there = a.junctions?.[side];
    return isNumber(there?.solid_fraction) && there.lines > 0 &&
      row(`Within one diameter ${side} a junction (mean of ${there.lines})`, there.solid_fraction, there.downward_velocity_m_per_s);
  };
  const rows = [row("The whole box, outside fibres", a.solid_fraction_of_free_space, -a.mean_velocity_m_per_s?.[2]), beside("above"), beside("below")];
  return table([{ title: "Where" }, { title: "Solid fraction", number: true }, { title: "Downwards, mm/s", number: true }], rows.filter((r) => r));
};

const averageNote = (a) => {
  const cells = Array.isArray(a.cells) && `${a.cells.join(" × ")} cells of ${a.spacing_m.map((s) => given("length", s)).join(" × ")}`;
  const window = Array.isArray(a.window_s) && `Mean of ${a.looks} looks from ${significant(a.window_s[0])} s to ${significant(a.window_s[1])} s`;
  const kernel = a.kernel && `kernel: ${a.kernel.name}, half width ${given("length", a.kernel.half_width_m)}`;
  return note([window, cells, kernel, `mass in the box ${withUnit("mass", a.mass_kg)}`].filter((t) => t).join("; ") + ".");
};

addSection({
  id: "averages",
  title: "Averaged fields",
  make: ({ runs }) => {
    const pictures = gallery(runs, "averages");
    const tables = runs.map((run) => averagesOf(run).map(([key, value]) => [
      h("h3", {}, runs.length > 1 && [swatch(run.colour), ` ${run.label}: `], capital(key.replace(/^average_/, ""))), averageTable(value), averageNote(value)]));
    return pictures || tables.flat().length > 0 ? [tables, pictures] : null;
  },
});
