// What must hold whatever was simulated: no particle lost, no mass lost, the energy ledger when there is one.

const check = (holds, text, ...more) => h("li", { class: holds ? "holds" : "fails" }, h("strong", {}, holds ? "Holds. " : "Does not hold. "), text, ...more);

// Mass is sums of doubles over the grains: equal but for rounding.
const kRounding = 1e-9;

const particleCheck = (s) => {
  if (!isNumber(s.lost_particles)) return null;
  const removed = s.particles - s.particles_left - s.lost_particles;
  return check(s.lost_particles === 0, `Particles: ${grouped(s.particles)} placed = ${grouped(s.particles_left)} still in the run + ${grouped(removed)} taken out behind an outlet + ${grouped(s.lost_particles)} lost.`);
};

const askedMass = (run) => {
  const stages = list(run.case?.stage).filter((s) => ["fill", "pour", "read"].includes(s.kind));
  return stages.length > 0 && stages.every((s) => isNumber(s.mass) && s.mass > 0) ? stages.reduce((sum, s) => sum + s.mass, 0) : null;
};

// A stage places the grain that brings the mass nearest to what is asked for: in mean grains, a few where the last one is
// large.
const massCheck = (run, s) => {
  const out = s.mass_discharged_kg, left = s.mass_retained_kg;
  if (!isNumber(out) || !isNumber(left)) return null;
  const sum = out + left, asked = askedMass(run);
  const text = `Mass: ${withUnit("mass", out, 5)} discharged + ${withUnit("mass", left, 5)} left = ${withUnit("mass", sum, 6)}`;
  if (s.status !== "done" || asked === null) return h("li", {}, `${text}.`);
  const grains = (sum - asked) / (sum / s.particles);
  return check(Math.abs(grains) <= 20, `${text}; the case asks for ${withUnit("mass", asked, 6)}, which is ${significant(Math.abs(grains), 2)} grains ${grains > 0 ? "less" : "more"}.`);
};

const curveCheck = (run, s) => {
  const columns = columnsOf(run, "mass_flow");
  if (!columns?.discharged_kg || !isNumber(s.mass_discharged_kg)) return null;
  const end = columns.discharged_kg[columns.discharged_kg.length - 1];
  const falls = columns.discharged_kg.some((m, k) => k > 0 && m < columns.discharged_kg[k - 1] * (1 - kRounding));
  const same = Math.abs(end - s.mass_discharged_kg) <= 1e-6 * Math.max(s.mass_discharged_kg, 1e-9);
  const stopped = s.status !== "done" && end < s.mass_discharged_kg;  // between two samples of the curve
  return [
    stopped && !same
      ? h("li", {}, `The curve ends at ${withUnit("mass", end, 6)}, its last sample before the run stopped.`)
      : check(same, `The curve ends at ${withUnit("mass", end, 6)}, the mass that the outlets counted.`),
    falls && h("li", {}, "Some grains came back through an outlet: the discharged mass falls now and then."),
  ];
};

// What the ledger's terms leave over, as shares of what was turned over; `closes` is the program's own verdict.
const energyCheck = ({ closes, tolerance, energy_residual_share: energy, momentum_residual_share: momentum, time_stepping_share: stepping, time_stepping_tolerance: most }) => {
  if (typeof closes !== "boolean") return null;
  const shares = [isNumber(energy) && `${smallShare(energy)} of the energy turned over is in no term of the ledger`,
    isNumber(momentum) && `${smallShare(momentum)} of the momentum`].filter(Boolean).join(", ");
  return check(closes, `Energy: ${shares || (closes ? "the ledger closes" : "the ledger does not close")}${isNumber(tolerance) ? `; rounding explains up to ${smallShare(tolerance)}` : ""}${isNumber(stepping) ? `. Finite time steps make ${smallShare(stepping)} of it, mostly work of dissipating forces booked half a step early${isNumber(most) ? ` (up to ${smallShare(most)} are held to be sound)` : ""}` : ""}.`);
};
const smallShare = (share) => `${significant(100 * share, 2)} %`;

const ledgerOf = (s) => s?.energy;
const ledgerWants = () => [" A ledger of every term wants ", h("code", {}, "energy_ledger = true"), " under [output] and a third more time."];
const noLedger = ({ energy_watch: w, resumed_from }) => w?.looks > 0
  ? check(w.largest_share_of_bound <= 1, `Energy: looked at ${grouped(w.looks)} times, the kinetic energy of all particles was at most ${smallShare(w.largest_share_of_bound)} of what stops a run: twice what gravity, contacts, moving walls and what came in can make of it between two looks${resumed_from ? ", since it was resumed" : ""}.`, ledgerWants())
  : h("li", {}, "Energy: watched for jumps, none stopped the run.", ledgerWants());

const checksOf = (run) => {
  const s = run.summary;
  if (!s) return null;
  const ledger = ledgerOf(s), terms = ledger && Object.fromEntries(Object.entries(ledger).filter(([key]) => /_J$/.test(key)));
  return [h("ul", { class: "checks" }, particleCheck(s), massCheck(run, s), curveCheck(run, s), ledger ? energyCheck(ledger) : s.status === "done" && noLedger(s)),
    ledger && [h("h3", {}, "Energy ledger, from the run's beginning to its end"), energyTable(terms)]];
};

// The ledger's terms, the largest first.
const energyTable = (terms) => {
  const rows = Object.entries(terms).filter(([, value]) => isNumber(value)).sort(([, a], [, b]) => Math.abs(b) - Math.abs(a));
  const [factor, unit] = unitFor("energy", rows[0]?.[1] ?? 1);
  return table([{ title: "Energy" }, { title: unit, number: true }], rows.map(([key, value]) => [inWords(key.replace(/_J$/, "")), significant(value / factor, 4)]));
};

addSection({
  id: "checks",
  title: "Conservation",
  make: ({ runs }) => {
    if (runs.length === 1) return checksOf(runs[0]);
    const ended = runs.filter((run) => run.summary);
    if (ended.length === 0) return null;
    const withLedger = ended.some((run) => ledgerOf(run.summary));
    const verdict = (ledger) => (typeof ledger?.closes !== "boolean" ? "no ledger" : ledger.closes ? "holds" : h("strong", { class: "bad" }, "does not hold"));
    return table([{ title: "Run" }, { title: "Lost particles", number: true }, { title: "Discharged", number: true }, { title: "Left", number: true }, ...(withLedger ? [{ title: "Energy" }] : [])],
      ended.map((run) => [run.label, grouped(run.summary.lost_particles), withUnit("mass", run.summary.mass_discharged_kg, 5), withUnit("mass", run.summary.mass_retained_kg, 5), ...(withLedger ? [verdict(ledgerOf(run.summary))] : [])]));
  },
});
