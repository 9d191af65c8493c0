// The averaged fields: slices, and what summary.json says of each average ("average", "average_<name>").

const averagesOf = (run) => Object.entries(run.summary ?? {}).filter(([key, value]) => /^averages?(_|$)/.test(key) && isObject(value));

addSection({
  id: "averages",
  title: "Averaged fields",
  make: ({ runs }) => {
    const pictures = gallery(runs, "averages");
    const tables = runs.map((run) => averagesOf(run).map(([key, value]) => [
      h("h3", {}, runs.length > 1 && [swatch(run.colour), ` ${run.label}: `], capital(key.replace(/^averages?_?/, "") || "average")), anyTable(value)]));
    return pictures || tables.flat().length > 0 ? [pictures, tables] : null;
  },
});
