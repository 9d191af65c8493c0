// The case in words: what was simulated, from case.toml as the program understood it.

const list = (value) => (Array.isArray(value) ? value : value === undefined ? [] : [value]);
const lengths = (values) => {
  const [factor, name] = unitFor("length", Math.max(...values.map(Math.abs)) || 1);
  return `${values.map((v) => plain(v / factor)).join(" × ")} ${name}`;
};

const sizeText = (kind) => {
  const d = kind.distribution;
  if (!d) return `${given("length", kind.diameter)} in diameter`;
  if (d.kind === "list") return `diameters ${d.diameters.map((x) => given("length", x)).join(", ")} (${d.fractions.map((f) => percent(f)).join(", ")} by ${d.by ?? "mass"})`;
  return `diameters ${given("length", d.min)} to ${given("length", d.max)}, ${d.kind} about ${given("length", d.mean ?? d.median)}`;
};

const grainText = (c, kind) => {
  const material = list(c.material).find((m) => m.name === kind.material) ?? {};
  return [`${kind.name}: ${kind.material}, ${sizeText(kind)}`, material.density && `${plain(material.density)} kg/m³`,
    material.youngs_modulus && `Young's modulus ${given("pressure", material.youngs_modulus)}`,
    isNumber(material.poisson_ratio) && `Poisson's ratio ${material.poisson_ratio}`].filter(Boolean).join("; ");
};

const cellsText = (lattice) => `${list(lattice.cells).join(" × ")} cells of ${given("length", lattice.cell_size)}`;

const latticeText = (c, summary) => {
  const lattice = c.lattice;
  const porosity = isNumber(summary?.porosity) && `porosity ${significant(summary.porosity, 3)}`;
  if (!lattice) return list(c.fibres).length > 0 ? [`${grouped(summary?.fibres)} fibres`, porosity].filter(Boolean).join(", ") : null;
  const size = list(lattice.cells).map((n) => n * lattice.cell_size);
  return [`${lattice.kind} of ${cellsText(lattice)}`, size.length === 3 && lengths(size),
    isNumber(lattice.fibre_diameter) ? `fibres ${given("length", lattice.fibre_diameter)} in diameter (${grouped(summary?.fibres)} of them)` : `${grouped(summary?.fibres)} fibres`, porosity]
    .filter(Boolean).join("; ");
};

const kLaws = { hertz_mindlin: "Hertz-Mindlin with tangential history" };
const kRolling = { none: "no rolling friction", cdt: "rolling friction of constant torque (CDT)", epsd2: "elastic-plastic rolling friction (EPSD2)" };
const lawText = (c) => [kLaws[c.contact?.law] ?? c.contact?.law, kRolling[c.contact?.rolling] ?? c.contact?.rolling].filter(Boolean).join(", ");

const pairText = (pair) => `${pair.materials.join(" – ")}: restitution ${pair.restitution}, sliding friction ${pair.sliding_friction}, rolling friction ${pair.rolling_friction ?? 0}`;

const placed = (s) => (isNumber(s.mass) && s.mass > 0 ? given("mass", s.mass) : isNumber(s.count) && s.count > 0 ? `${grouped(s.count)} grains` : "as many grains as fit");
const until = (s) => [
  isNumber(s.discharged_fraction) && s.discharged_fraction > 0 && `${percent(s.discharged_fraction)} has left`,
  isNumber(s.no_flow_time) && s.no_flow_time > 0 && `nothing has left for ${given("time", s.no_flow_time)}`,
  isNumber(s.kinetic_energy_per_particle) && s.kinetic_energy_per_particle > 0 && `the kinetic energy is below ${significant(s.kinetic_energy_per_particle)} J a grain`,
  isNumber(s.max_time) && s.max_time > 0 && `at most ${given("time", s.max_time)}`,
].filter(Boolean).join(", or ");
const stageWords = {
  fill: (s) => `place ${placed(s)} in ${list(s.regions ?? s.region).join(", then ")} at a solid fraction of ${s.solid_fraction ?? "–"}`,
  pour: (s) => `pour ${placed(s)} from ${list(s.region).join(", ")}${isNumber(s.rate) ? ` at ${given("flow", s.rate)}` : ""}`,
  read: (s) => `place the grains of ${s.file}`,
  settle: (s) => (isNumber(s.time) ? `let them settle for ${given("time", s.time)}` : `let them settle until ${until(s)}`),
  open: (s) => `open ${list(s.walls).join(", ")}`,
  drain: (s) => `let them drain until ${until(s)}`,
};
const stageText = (s) => stageWords[s.kind]?.(s) ?? inWords(s.name ?? s.kind);

const lines = (texts) => (texts.length > 0 ? texts.map((t) => h("div", {}, t)) : null);

const caseFacts = (run) => {
  const c = run.case, s = run.summary;
  const step = s?.time_step_s ?? c.time?.step;
  return facts([
    ["Grains", lines([s && `${grouped(s.particles)} in all`, ...list(c.particles).map((kind) => grainText(c, kind))].filter(Boolean))],
    [c.lattice ? "Lattice" : "Fibres", latticeText(c, s)],
    ["Walls", list(c.wall).map((w) => `${w.name} (${w.kind})`).join(", ")],
    ["Contacts", lawText(c)],
    ["Pairs", lines(list(c.pair).map(pairText))],
    ["Time step", isNumber(step) && given("time", step)],
    ["Simulated time", isNumber(s?.physical_time_s) && given("time", s.physical_time_s)],
    ["Stages", list(c.stage).length > 0 && h("ol", {}, list(c.stage).map((one) => h("li", {}, stageText(one))))],
    ["Seed", c.seed],
  ]);
};

addSection({
  id: "case",
  title: "What was simulated",
  make: ({ runs, sweep }) => {
    const run = runs.find((one) => one.case);
    if (!run) return null;
    if (sweep) return [note("The case that all runs share; the swept keys are those of its first run."), caseFacts(run)];
    return runs.length === 1 ? caseFacts(run) : [note(`The first run, ${run.name}; what differs in the others is listed next.`), caseFacts(run)];
  },
});
