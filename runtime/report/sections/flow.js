// Mass flow and discharged mass against time.

const kWindows = [0, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2];  // shares of the drain that the flow may be averaged over
const kWindowShare = 0.04;

const flowCurves = (runs) =>
  runs.map((run) => ({ run, columns: columnsOf(run, "mass_flow") })).filter(({ columns }) => columns?.time_s && columns?.discharged_kg);

// Windows to choose from, s, about these shares of the longest drain; 0: from row to row.
const windowsOf = (curves) => {
  const longest = Math.max(...curves.map(({ run, columns }) => columns.time_s[columns.time_s.length - 1] - drainStart(run)));
  return [...new Set(kWindows.map((share) => niceWindow(longest, share)))];
};

// What is drawn: a curve for each run, in a sweep one for each combination: {label, colour, curves: [of flowCurves]}.
const flowLines = ({ runs, sweep }) => {
  const lines = sweep
    ? combinationsOf({ runs, sweep }).map(({ values, results }, k) => ({ label: labelsOf(sweep, values).join(", ") || "mean", colour: k, curves: flowCurves(results) }))
    : runs.map((run) => ({ label: run.label, colour: run.colour, curves: flowCurves([run]) }));
  return lines.filter(({ curves }) => curves.length > 0);
};

const makeFlow = (data) => {
  const all = flowLines(data), lines = data.sweep ? all.slice(0, kMostCurves) : all;
  if (lines.length === 0) return null;
  const curves = lines.flatMap((line) => line.curves), several = curves.length > 1 || data.sweep;
  const massUnit = unitFor("mass", Math.max(...curves.map(({ columns }) => columns.discharged_kg[columns.discharged_kg.length - 1])) || 1e-3);
  const rateUnit = unitFor("flow", Math.max(...curves.map(({ run, columns }) => rateOf(run) ?? columns.discharged_kg[columns.discharged_kg.length - 1] / Math.max(1e-9, columns.time_s[columns.time_s.length - 1] - drainStart(run)))) || 1e-3);
  const smallest = Math.max(...curves.map(({ columns }) => 2 * (columns.time_s[1] - columns.time_s[0])));
  const windows = windowsOf(curves).filter((w) => w === 0 || w >= 0.999 * smallest);
  const wanted = Math.max(...curves.map(({ run, columns }) => columns.time_s[columns.time_s.length - 1] - drainStart(run))) * kWindowShare;
  const start = windows.reduce((best, w) => (w > 0 && Math.abs(w - wanted) < Math.abs(best - wanted) ? w : best), windows[0]);

  // {x, means: [{values, spread}], one for each line}
  const meansOf = (valuesOf) => {
    const { x, ys } = onCommonAxis(curves.map((c) => ({ x: several ? c.columns.time_s.map((t) => t - drainStart(c.run)) : c.columns.time_s, y: valuesOf(c.columns) })), several ? 0 : undefined);
    let next = 0;
    return { x, means: lines.map((line) => meanCurve(ys.slice(next, next += line.curves.length))) };
  };
  const rates = (window) => meansOf((columns) => slopeOver(columns.time_s, columns.discharged_kg, window || smallest).map((v) => v && v / rateUnit[0]));
  const rate = rates(start), masses = meansOf((columns) => columns.discharged_kg.map((v) => v / massUnit[0]));

  const only = several ? null : curves[0].run;
  const window = only?.summary?.steady_window_s;
  const common = {
    x: rate.x, xName: "time", xText: (t) => `${significant(t, 4)} s`, sync: "flow",
    bands: Array.isArray(window) ? [{ from: window[0], to: window[1] }] : [],
    marks: only ? (only.summary?.stages ?? []).filter((s) => s.end_s > s.start_s).map((s) => ({ at: s.start_s, label: s.name })) : [],
  };
  const seriesOf = ({ means }, text, unit) => lines.map((line, k) => {
    const s = { label: several ? line.label : text, ...means[k], colour: colourOf(line.colour) };
    s.text = (v, at) => `${s.spread?.[at] > 0 ? withError(v, s.spread[at]) : significant(v, 4)} ${unit[1]}`;
    return s;
  });
  const steady = only && isNumber(rateOf(only)) && window
    ? [{ label: "steady", values: rate.x.map((t) => (t >= window[0] && t <= window[1] ? rateOf(only) / rateUnit[0] : null)),
         colour: "var(--text)", dash: [6, 4], width: 1.25, text: (v) => `${significant(v, 4)} ${rateUnit[1]}` }] : [];
  const levels = [...steady, ...referenceCurves(data.sweep, "kg/s", rate.x, rateUnit)];
  const rateChart = chart({ ...common, xLabel: "", yLabel: `mass flow, ${rateUnit[1]}`, series: [...seriesOf(rate, "mass flow", rateUnit), ...levels] });
  const massChart = chart({ ...common, xLabel: several ? "time since the drain began, s" : "time, s", yLabel: `discharged, ${massUnit[1]}`, series: seriesOf(masses, "discharged", massUnit) });

  const choose = h("select", { id: "window", change: (event) => {
    rateChart.querySelector(".chart").update([...rates(Number(event.target.value)).means, ...levels]);
  } }, windows.map((w) => h("option", { value: w, selected: w === start }, w === 0 ? "nothing (row to row)" : withUnit("time", w, 1))));
  const thinned = curves.some(({ run }) => run.tables.mass_flow.every > 1);
  return [
    captionOfChart(data.sweep, "flow_curves"),
    h("p", { class: "controls" }, h("label", { for: "window" }, "Flow averaged over "), choose, h("span", { class: "hint" }, "Drag to zoom, double click for the whole curve.")),
    rateChart, captionOfChart(data.sweep, "discharged_curves"), massChart,
    common.bands.length > 0 && note("Shaded: the steady window. Dashed: the steady mass flow."),
    lines.some((line) => line.curves.length > 1) && note("Lines: means over the seeds, as long as all of them flow. Bands: one standard error of the mean to either side."),
    all.length > lines.length && note(`${all.length - lines.length} more combinations are in the runs' own reports.`),
    thinned && note("Long curves are drawn from every n-th row; all rows are in mass_flow.csv."),
  ];
};

addSection({ id: "flow", title: "Mass flow over time", make: makeFlow });
