// A sweep: what came out of each combination, the means of its seeds.

const memberText = (runs, member) => {
  const run = isNumber(member.run) ? runs[member.run] : null;
  const text = member.seed === null ? member.name : `seed ${member.seed}`;
  return h("span", { class: "nowrap" }, run ? h("a", { href: `${run.link}/report.html` }, text) : text, member.status === "done" ? null : ` (${member.status})`);
};

const makeSweepTable = (data) => {
  const { runs, sweep } = data, measures = measuresOf(data).filter((m) => m.known || m.id === "steady_flow");
  const open = sweep.runs.filter((member) => member.status !== "done");
  const seeds = sweep.seeds.length > 1;
  return [
    open.length > 0 && h("p", { class: "warning" }, `${open.length} of ${sweep.runs.length} runs ${open.length === 1 ? "is" : "are"} not done: repeat the sweep to go on.`),
    table([...sweep.parameters.map((p) => ({ title: capital(inPlainWords(p.label)), number: p.values.every((v) => isNumber(v.number)) })),
      ...measures.map((m) => ({ title: `${m.title}, ${m.unit[1]}`, number: true })), { title: "Runs" }],
      combinationsOf(data).map(({ values, members, results }) => [
        ...labelsOf(sweep, values),
        ...measures.map((m) => { const mean = meanOf(results, m); return mean ? withError(mean.mean / m.unit[0], mean.error / m.unit[0]) : "none"; }),
        members.map((member, k) => [k > 0 && ", ", memberText(runs, member)])])),
    note(seeds ? "± is one standard error of the mean over the seeds; of the steady mass flow the larger of that and of the scatter within the runs' steady windows." : "± is one standard error, from the scatter within each run's steady window."),
    h("p", { class: "note" }, "A row for each run: ", h("a", { href: "sweep.csv" }, "sweep.csv"), "."),
  ];
};

addSection({ id: "sweep", title: "Results", make: (data) => (data.sweep ? makeSweepTable(data) : null) });
