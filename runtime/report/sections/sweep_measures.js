// A sweep: what its table and its charts tell of each run, and the means over seeds.

const kDrainStep = 0.05;  // shares that the drain time is told for: multiples of this

const labelsOf = (sweep, values) => values.map((v, k) => sweep.parameters[k].values[v].text);

// Combinations in the order of the sweep: [{values, members: [of sweep.runs], results: [run]}]. Results are of the runs
// that are done, or of what there is where none is.
const combinationsOf = ({ runs, sweep }) => {
  const found = new Map();
  for (const member of sweep.runs) {
    const key = member.values.join();
    if (!found.has(key)) found.set(key, { values: member.values, members: [], results: [] });
    found.get(key).members.push(member);
    if (isNumber(member.run)) found.get(key).results.push(runs[member.run]);
  }
  for (const combination of found.values()) {
    const done = combination.results.filter((run) => run.summary?.status === "done");
    if (done.length > 0) combination.results = done;
  }
  return [...found.values()];
};

const massIn = ({ summary: s }) => (s ? s.mass_discharged_kg + s.mass_retained_kg : NaN);
const shareOut = (run) => run.summary?.mass_discharged_kg / massIn(run);

// The largest share of the mass that has left in all of these runs, but for those that jammed before half of what left
// in the others.
const commonShareOut = (runs) => {
  const shares = runs.map(shareOut).filter(isNumber), most = Math.max(0, ...shares);
  const flowing = shares.filter((share) => share > 0 && share >= most / 2);
  return flowing.length > 0 ? Math.floor(Math.min(...flowing) / kDrainStep + 1e-6) * kDrainStep : 0;
};

// s from the drain's begin until that share of the mass has left.
const drainTime = (run, share) => {
  const columns = columnsOf(run, "mass_flow");
  if (!columns?.discharged_kg || !(share > 0)) return null;
  const at = firstReach(columns.time_s, columns.discharged_kg, share * massIn(run));
  return at === null ? null : at - drainStart(run);
};

// The share at which the case stops the run's drain, whatever is left in it; null if it goes on.
const stopShare = (run) => {
  const share = Math.min(...list(run.case?.stage).map((s) => (s.kind === "drain" && s.discharged_fraction > 0 ? s.discharged_fraction : Infinity)));
  return share < 1 && shareOut(run) >= share * (1 - 1e-9) ? share : null;
};

// The quantities that stand against the parameters: {id, title, axis, unit: [factor, name], si, valueOf(run), errorOf(run)}.
// `id` as in [captions] of the sweep file, `si` as in its [reference]. `why`: what to say where there is no value.
const measuresOf = (data) => {
  const results = combinationsOf(data).flatMap((c) => c.results), share = commonShareOut(results);
  const stops = results.map(stopShare), stopped = stops.some((s) => s !== null);
  const measure = (id, title, axis, quantity, si, valueOf, errorOf, why) => {
    const values = results.map(valueOf).filter(isNumber);
    return { id, title, axis, unit: unitFor(quantity, Math.max(0, ...values) || 1), si, valueOf, errorOf, known: values.length > 0, without: results.length - values.length, why };
  };
  return [
    { ...measure("steady_flow", "Steady mass flow", "mass flow", "flow", "kg/s", rateOf, rateErrorOf), unit: flowUnit(data.runs) },
    measure("drain_time", `Drain time to ${percent(share)} discharged`, "drain time", "time", "s", (run) => drainTime(run, share), () => 0),
    measure("retained", "Mass left in the end", "mass left", "mass", "kg", (run) => (stopped ? null : run.summary?.mass_retained_kg), () => 0,
      stopped && `Mass left in the end: the case ends a run when ${percent(Math.min(...stops.filter((s) => s !== null)))} of the mass has left, so these runs do not show what would stay for good.`),
  ];
};

// The mean of a measure over runs and its standard error: the larger of the scatter over the runs and of what the runs'
// own errors make. Two or three seeds may lie close by chance.
const meanOf = (runs, { valueOf, errorOf }) => {
  const known = runs.filter((run) => isNumber(valueOf(run)));
  if (known.length === 0) return null;
  const { mean, error } = meanAndError(known.map(valueOf));
  return { mean, error: Math.max(error, Math.hypot(...known.map((run) => errorOf(run) ?? 0)) / known.length) };
};

// The level that the sweep file gives for this unit, as one more curve; nothing if it gives none.
const referenceCurves = (sweep, si, x, [factor, name]) => {
  const r = sweep?.reference;
  if (r?.unit !== si) return [];
  return [{ label: r.label, values: x.map(() => r.value / factor), colour: "var(--text)", dash: [6, 4], width: 1.25, text: (v) => `${significant(v, 4)} ${name}` }];
};

// What the sweep file says that a chart may be held against.
const captionOfChart = (sweep, id) => sweep?.captions?.[id] && h("p", { class: "note caption" }, `${capital(sweep.captions[id])}.`);
