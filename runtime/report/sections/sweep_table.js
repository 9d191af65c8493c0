// A sweep: the steady mass flow of each combination, the mean of its seeds.

const labelsOf = (sweep, values) => values.map((v, k) => sweep.parameters[k].values[v].text);

// The mean of rates and its standard error: the larger of the scatter over the runs and of what the runs' own errors
// make. Two or three seeds may lie close by chance.
const meanOf = (runs) => {
  const rates = runs.map(rateOf).filter(isNumber);
  if (rates.length === 0) return null;
  const mean = rates.reduce((sum, r) => sum + r, 0) / rates.length;
  const own = Math.hypot(...runs.filter((run) => isNumber(rateOf(run))).map((run) => rateErrorOf(run) ?? 0)) / rates.length;
  if (rates.length === 1) return { mean, error: own };
  const square = rates.reduce((sum, r) => sum + (r - mean) ** 2, 0);
  return { mean, error: Math.max(own, Math.sqrt(square / (rates.length - 1) / rates.length)) };
};

// Combinations in the order of the sweep: [{values, members: [of sweep.runs], results: [run]}].
const combinationsOf = ({ runs, sweep }) => {
  const found = new Map();
  for (const member of sweep.runs) {
    const key = member.values.join();
    if (!found.has(key)) found.set(key, { values: member.values, members: [], results: [] });
    found.get(key).members.push(member);
    if (isNumber(member.run)) found.get(key).results.push(runs[member.run]);
  }
  return [...found.values()];
};

const memberText = (runs, member) => {
  const run = isNumber(member.run) ? runs[member.run] : null;
  const text = member.seed === null ? member.name : `seed ${member.seed}`;
  return [run ? h("a", { href: `${run.link}/report.html` }, text) : text, member.status === "done" ? null : ` (${member.status})`];
};

const makeSweepTable = (data) => {
  const { runs, sweep } = data, unit = flowUnit(runs);
  const combinations = combinationsOf(data);
  const open = sweep.runs.filter((member) => member.status !== "done");
  const seeds = sweep.seeds.length > 1;
  return [
    open.length > 0 && h("p", { class: "warning" }, `${open.length} of ${sweep.runs.length} runs ${open.length === 1 ? "is" : "are"} not done: repeat the sweep to go on.`),
    table([...sweep.parameters.map((p) => ({ title: p.label, number: p.values.every((v) => isNumber(v.number)) })),
      { title: `Steady mass flow, ${unit[1]}`, number: true }, { title: "Runs" }],
      combinations.map(({ values, members, results }) => {
        const mean = meanOf(results);
        return [...labelsOf(sweep, values), mean ? withError(mean.mean / unit[0], mean.error / unit[0]) : "none",
          members.map((member, k) => [k > 0 && ", ", memberText(runs, member)])];
      })),
    note(seeds ? "± is one standard error of the mean: the larger of the scatter over the seeds and of the scatter within the runs' steady windows." : "± is one standard error, from the scatter within each run's steady window."),
    h("p", { class: "note" }, "The same as a table: ", h("a", { href: "sweep.csv" }, "sweep.csv"), "."),
  ];
};

addSection({ id: "sweep", title: "Steady mass flow", make: (data) => (data.sweep ? makeSweepTable(data) : null) });
