// The answer first: the steady mass flow, its error and its window; for several runs a table of them.

const statusText = (run) => {
  const status = run.summary?.status;
  if (!status) return "This run has not ended: it goes on, or was killed (scree resume goes on with it).";
  if (status === "interrupted") return "This run was interrupted: what is here is complete up to that moment (scree resume goes on with it).";
  if (status === "failed") return `This run failed: ${run.summary.message ?? "no reason is known"}`;
  return null;
};

const rateOf = (run) => run.summary?.steady_mass_flow_kg_per_s ?? null;
const rateErrorOf = (run) => run.summary?.steady_mass_flow_standard_error_kg_per_s ?? null;

const flowUnit = (runs) => unitFor("flow", Math.max(0, ...runs.map((run) => rateOf(run) ?? 0)) || 1e-3);
const rateText = (run, [factor]) => (isNumber(rateOf(run)) ? withError(rateOf(run) / factor, rateErrorOf(run) / factor) : "none");
const windowText = (run) => {
  const window = run.summary?.steady_window_s;
  return Array.isArray(window) ? `${significant(window[0], 3)} s to ${significant(window[1], 3)} s` : "–";
};

const warning = (run) => {
  const text = statusText(run);
  return text && h("p", { class: "warning", role: "status" }, text);
};

const oneHeadline = (run) => {
  const unit = flowUnit([run]);
  if (!isNumber(rateOf(run)))
    return [h("p", { class: "big none" }, "No steady mass flow"),
      note("The run has no drain, the drain has not ended, or its discharge has no plateau: see the curve below.")];
  return [h("p", { class: "big" }, rateText(run, unit), h("small", {}, ` ${unit[1]}`)),
    note(`Steady mass flow from ${windowText(run)} (the shaded window below); ± is one standard error, from the scatter of ${run.summary.steady_bins ?? 8} stretches of the window.`)];
};

const reportLink = (run) => (run.files.some((f) => f.file === "report.html") ? h("a", { href: `${run.link}/report.html` }, run.label) : run.label);

const allHeadlines = (runs) => {
  const unit = flowUnit(runs);
  return [table(
    [{ title: "Run" }, { title: `Steady mass flow, ${unit[1]}`, number: true }, { title: "Window", number: true }, { title: "Grains", number: true }, { title: "Status" }],
    runs.map((run) => [[swatch(run.colour), " ", reportLink(run)], rateText(run, unit), windowText(run), grouped(run.summary?.particles), run.summary?.status ?? "not ended"])),
    note("± is one standard error, from the scatter within the run's steady window.")];
};

addSection({
  id: "result",
  title: "Steady mass flow",
  make: ({ runs, sweep }) => (sweep ? null : [runs.map(warning), runs.length === 1 ? oneHeadline(runs[0]) : allHeadlines(runs)]),
});
