// How much of the fibres and walls the grains touch: unrolled pictures, and the numbers of summary.json.
addSection({
  id: "touch",
  title: "Touch maps",
  make: ({ runs }) => {
    const tables = runs.map((run, k) => run.summary?.touch && [runs.length > 1 && h("h3", {}, swatch(k), " ", run.name), anyTable(run.summary.touch)]).filter(Boolean);
    const pictures = gallery(runs, "touch");
    return tables.length > 0 || pictures ? [tables, pictures] : null;
  },
});
