// A sweep: the steady mass flow against each swept parameter, a curve for each combination of the others.

const kMostCurves = 16;

const otherValues = (values, parameter) => values.filter((_, k) => k !== parameter).join();

const parameterChart = (data, parameter) => {
  const { runs, sweep } = data, unit = flowUnit(runs), p = sweep.parameters[parameter];
  const combinations = combinationsOf(data);
  const numeric = p.values.every((v) => isNumber(v.number));
  const order = p.values.map((_, k) => k);
  if (numeric) order.sort((a, b) => p.values[a].number - p.values[b].number);
  const x = order.map((v, k) => (numeric ? p.values[v].number : k));
  const groups = [...new Set(combinations.map(({ values }) => otherValues(values, parameter)))];
  const series = groups.slice(0, kMostCurves).map((group, index) => {
    const members = combinations.filter(({ values }) => otherValues(values, parameter) === group);
    const means = order.map((v) => meanOf(members.find(({ values }) => values[parameter] === v)?.results ?? []));
    const others = labelsOf(sweep, members[0].values).map((text, k) => `${sweep.parameters[k].label} ${text}`).filter((_, k) => k !== parameter);
    return { label: others.join(", ") || "mass flow", colour: colourOf(index), width: 1.25, markers: true,
      values: means.map((m) => m && m.mean / unit[0]), errors: means.map((m) => m && m.error / unit[0]),
      text: (v) => { const k = means.findIndex((m) => m && m.mean / unit[0] === v); return k < 0 ? significant(v, 3) : withError(v, means[k].error / unit[0]) + ` ${unit[1]}`; } };
  });
  const all = series.flatMap((s) => s.values.map((v, k) => (isNumber(v) ? v + (s.errors[k] ?? 0) : 0)));
  const pad = numeric ? 0.08 * (x[x.length - 1] - x[0] || Math.abs(x[0]) || 1) : 0.5;
  return [
    sweep.parameters.length > 1 && h("h3", {}, p.label),
    chart({ x, xName: p.label, xLabel: numeric || p.keys.length === 1 ? p.keys.join(", ") : p.label, yLabel: `steady mass flow, ${unit[1]}`,
      xText: (v) => (numeric ? String(v) : p.values[order[Math.round(v)]]?.text ?? ""), series,
      xRange: () => [x[0] - pad, x[x.length - 1] + pad], yRange: () => [0, 1.08 * Math.max(...all, 1e-9)],
      xAxis: { splits: () => x, values: (u, at) => at.map((v) => (numeric ? String(v) : p.values[order[v]]?.text ?? "")) } }),
    groups.length > kMostCurves && note(`${groups.length - kMostCurves} more combinations are in sweep.csv.`),
  ];
};

addSection({
  id: "trends",
  title: "Against each parameter",
  make: (data) => {
    if (!data.sweep || data.runs.length === 0) return null;
    const swept = data.sweep.parameters.map((p, k) => [p, k]).filter(([p]) => p.values.length > 1);
    return swept.length > 0 ? [swept.map(([, k]) => parameterChart(data, k)), note("Points: means over the seeds. Bars: one standard error.")] : null;
  },
});
