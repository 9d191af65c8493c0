// Mass in each meter against time.

const makeMeters = (runs) => {
  const metered = runs.map((run) => ({ run, columns: columnsOf(run, "meters") })).filter(({ columns }) => columns?.time_s);
  const names = [...new Set(metered.flatMap(({ columns }) => Object.keys(columns).filter((name) => name.endsWith("_kg"))))];
  if (names.length === 0) return null;
  const several = runs.length > 1;
  return names.map((name) => {
    const having = metered.filter(({ columns }) => columns[name]);
    const unit = unitFor("mass", Math.max(...having.map(({ columns }) => Math.max(...columns[name]))) || 1e-3);
    const { x, ys } = onCommonAxis(having.map(({ run, columns }) => ({
      x: several ? columns.time_s.map((t) => t - drainStart(run)) : columns.time_s, y: columns[name].map((v) => v / unit[0]) })), several ? 0 : undefined);
    const place = lowerFirst(inWords(name.replace(/_kg$/, "")));
    return chart({ x, xName: "time", xText: (t) => `${significant(t, 4)} s`, xLabel: several ? "time since the drain began, s" : "time, s",
      yLabel: `mass in ${place}, ${unit[1]}`, sync: "flow",
      series: having.map(({ run }, k) => ({ label: several ? run.label : place, values: ys[k], colour: colourOf(run.colour), text: (v) => `${significant(v, 4)} ${unit[1]}` })) });
  });
};

addSection({ id: "meters", title: "Mass in the meters", make: ({ runs }) => makeMeters(runs) });
