// How much of the fibres and walls the grains touch: unrolled pictures, and the numbers of summary.json.
addSection({
  id: "touch",
  title: "Touch maps",
  make: ({ runs }) => {
    const tables = runs.map((run) => run.summary?.touch && [runs.length > 1 && h("h3", {}, swatch(run.colour), " ", run.label), anyTable(run.summary.touch)]).filter(Boolean);
    const pictures = gallery(runs, "touch");
    return tables.length > 0 || pictures ? [tables, pictures] : null;
  },
});
