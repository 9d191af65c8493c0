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

const makeFlow = (runs) => {
  const curves = flowCurves(runs);
  if (curves.length === 0) return null;
  const several = runs.length > 1;
  const massUnit = unitFor("mass", Math.max(...curves.map(({ columns }) => columns.discharged_kg[columns.discharged_kg.length - 1])) || 1e-3);
  const rateUnit = unitFor("flow", Math.max(...curves.map(({ run, columns }) => rateOf(run) ?? columns.discharged_kg[columns.discharged_kg.length - 1] / Math.max(1e-9, columns.time_s[columns.time_s.length - 1] - drainStart(run)))) || 1e-3);
  const smallest = Math.max(...curves.map(({ columns }) => 2 * (columns.time_s[1] - columns.time_s[0])));
  const windows = windowsOf(curves).filter((w) => w === 0 || w >= 0.999 * smallest);
  const wanted = Math.max(...curves.map(({ run, columns }) => columns.time_s[columns.time_s.length - 1] - drainStart(run))) * kWindowShare;
  const start = windows.reduce((best, w) => (w > 0 && Math.abs(w - wanted) < Math.abs(best - wanted) ? w : best), windows[0]);

  const timeOf = ({ run, columns }) => (several ? columns.time_s.map((t) => t - drainStart(run)) : columns.time_s);
  const rates = (window) => onCommonAxis(curves.map((c) => ({
    x: timeOf(c), y: slopeOver(c.columns.time_s, c.columns.discharged_kg, window || smallest).map((v) => v && v / rateUnit[0]) })), several ? 0 : undefined);
  const masses = onCommonAxis(curves.map((c) => ({ x: timeOf(c), y: c.columns.discharged_kg.map((v) => v / massUnit[0]) })), several ? 0 : undefined);
  const rate = rates(start);

  const only = several ? null : curves[0].run;
  const window = only?.summary?.steady_window_s;
  const common = {
    x: rate.x, xName: "time", xText: (t) => `${significant(t, 4)} s`, sync: "flow",
    bands: Array.isArray(window) ? [{ from: window[0], to: window[1] }] : [],
    marks: only ? (only.summary?.stages ?? []).filter((s) => s.end_s > s.start_s).map((s) => ({ at: s.start_s, label: s.name })) : [],
  };
  const named = (run, text) => (several ? run.label : text);
  const steady = only && isNumber(rateOf(only)) && window
    ? [{ label: "steady", values: rate.x.map((t) => (t >= window[0] && t <= window[1] ? rateOf(only) / rateUnit[0] : null)),
         colour: "var(--text)", dash: [6, 4], width: 1.25, text: (v) => `${significant(v, 4)} ${rateUnit[1]}` }] : [];
  const rateChart = chart({ ...common, xLabel: "", yLabel: `mass flow, ${rateUnit[1]}`,
    series: [...curves.map(({ run }, k) => ({ label: named(run, "mass flow"), values: rate.ys[k], colour: colourOf(run.colour), text: (v) => `${significant(v, 4)} ${rateUnit[1]}` })), ...steady] });
  const massChart = chart({ ...common, xLabel: several ? "time since the drain began, s" : "time, s", yLabel: `discharged, ${massUnit[1]}`,
    series: curves.map(({ run }, k) => ({ label: named(run, "discharged"), values: masses.ys[k], colour: colourOf(run.colour), text: (v) => `${significant(v, 4)} ${massUnit[1]}` })) });

  const choose = h("select", { id: "window", change: (event) => {
    const again = rates(Number(event.target.value));
    rateChart.querySelector(".chart").update([...again.ys, ...steady.map((s) => s.values)]);
  } }, windows.map((w) => h("option", { value: w, selected: w === start }, w === 0 ? "nothing (row to row)" : withUnit("time", w, 1))));
  const thinned = curves.some(({ run }) => run.tables.mass_flow.every > 1);
  return [
    h("p", { class: "controls" }, h("label", { for: "window" }, "Flow averaged over "), choose, h("span", { class: "hint" }, "Drag to zoom, double click for the whole curve.")),
    rateChart, massChart,
    common.bands.length > 0 && note("Shaded: the steady window. Dashed: the steady mass flow."),
    thinned && note("Long curves are drawn from every n-th row; all rows are in mass_flow.csv."),
  ];
};

addSection({ id: "flow", title: "Mass flow over time", make: ({ runs }) => makeFlow(runs) });
