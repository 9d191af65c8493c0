// A sweep: steady mass flow, drain time and mass left against each swept parameter, a curve for each combination of the
// others.

const kMostCurves = 16;

const otherValues = (values, parameter) => values.filter((_, k) => k !== parameter).join();
const inPlainWords = (label) => lowerFirst(label.replace(/_/g, " "));

const namesOf = (sweep, values) => labelsOf(sweep, values).map((text, k) => `${inPlainWords(sweep.parameters[k].label)} ${text}`).join(", ");

const measureChart = ({ sweep }, combinations, parameter, measure) => {
  const { unit } = measure, p = sweep.parameters[parameter];
  const numeric = p.values.every((v) => isNumber(v.number));
  const order = p.values.map((_, k) => k);
  if (numeric) order.sort((a, b) => p.values[a].number - p.values[b].number);
  const x = order.map((v, k) => (numeric ? p.values[v].number : k));
  const groups = [...new Set(combinations.map(({ values }) => otherValues(values, parameter)))];
  const series = groups.slice(0, kMostCurves).map((group, index) => {
    const members = combinations.filter(({ values }) => otherValues(values, parameter) === group);
    const means = order.map((v) => meanOf(members.find(({ values }) => values[parameter] === v)?.results ?? [], measure));
    const others = labelsOf(sweep, members[0].values).map((text, k) => `${sweep.parameters[k].label} ${text}`).filter((_, k) => k !== parameter);
    return { label: others.join(", ") || lowerFirst(measure.title), colour: colourOf(index), markers: true,
      width: numeric || groups.length > 1 ? 1.25 : 0,  // nothing lies between two names
      values: means.map((m) => m && m.mean / unit[0]), errors: means.map((m) => m && m.error / unit[0]),
      text: (v, k) => `${withError(v, means[k].error / unit[0])} ${unit[1]}` };
  });
  series.push(...referenceCurves(sweep, measure.si, x, unit));
  const all = series.flatMap((s) => s.values.map((v, k) => (isNumber(v) ? v + (s.errors?.[k] ?? 0) : 0)));
  const pad = numeric ? 0.08 * (x[x.length - 1] - x[0] || Math.abs(x[0]) || 1) : 0.5;
  const name = (v) => (numeric ? String(v) : p.values[order[Math.round(v)]]?.text ?? "");
  return [
    h("h3", {}, `${measure.title} against ${inPlainWords(p.label)}`),
    captionOfChart(sweep, measure.id),
    chart({ x, xName: p.label, xText: name, xLabel: numeric || p.keys.length === 1 ? p.keys.join(", ") : p.label,
      yLabel: `${measure.axis}, ${unit[1]}`, series,
      xRange: () => [x[0] - pad, x[x.length - 1] + pad], yRange: () => [0, 1.08 * Math.max(...all, 1e-9)],
      xAxis: { splits: () => x, values: (u, at) => at.map(name) } }),
    groups.length > kMostCurves && note(`${groups.length - kMostCurves} more combinations are in sweep.csv.`),
  ];
};

addSection({
  id: "trends",
  title: "Against each parameter",
  make: (data) => {
    if (!data.sweep || data.runs.length === 0) return null;
    const swept = data.sweep.parameters.map((p, k) => [p, k]).filter(([p]) => p.values.length > 1);
    const measures = measuresOf(data), combinations = combinationsOf(data);
    if (swept.length === 0) return null;
    const begun = combinations.filter(({ results }) => results.length > 0 && !results.some((run) => run.summary?.status === "done"));
    return [
      begun.length > 0 && h("p", { class: "warning" }, `Points of runs that are not done: ${begun.map(({ values }) => namesOf(data.sweep, values)).join("; ")}.`),
      swept.map(([, k]) => measures.filter((m) => m.known).map((m) => measureChart(data, combinations, k, m))),
      note(data.sweep.seeds.length > 1 ? "Points: means over the seeds. Bars: one standard error." : "Bars: one standard error, where a run alone tells it."),
      measures.map((m) => m.known ? m.without > 0 && note(`${m.title}: ${m.without} of the runs ${m.without === 1 ? "has" : "have"} none, as ${m.without === 1 ? "it" : "they"} did not flow long enough.`) : m.why && note(m.why)),
    ];
  },
});
