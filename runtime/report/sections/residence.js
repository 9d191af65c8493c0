// How long grains stay between entry and exit, and what stays behind: summary.residence, residence.csv (mass by time,
// in bins), retained.csv (mass at each junction), residence/*.png.

const kMostJunctions = 20;

const residenceHistogram = (runs) => {
  const having = runs.map((run) => ({ run, bins: columnsOf(run, "residence") })).filter(({ bins }) => bins?.from_s && bins?.to_s && bins?.mass_kg);
  if (having.length === 0) return null;
  // The share of the mass per second, a step for each bin.
  const curves = having.map(({ bins }) => {
    const total = bins.mass_kg.reduce((sum, m) => sum + m, 0) || 1;
    const share = bins.mass_kg.map((m, k) => m / total / (bins.to_s[k] - bins.from_s[k]));
    return { x: [...bins.from_s, bins.to_s[bins.to_s.length - 1]], y: [...share, 0] };
  });
  const { x, ys } = onCommonAxis(curves);
  return chart({ x, xName: "residence time", xText: (t) => `${significant(t)} s`, xLabel: "residence time, s", yLabel: "share of the mass, 1/s",
    series: having.map(({ run }, k) => ({ label: runs.length > 1 ? run.label : "share", values: ys[k], colour: colourOf(run.colour), steps: curves.length === 1, text: (v) => `${significant(v)} 1/s` })) });
};

// What had entered and not come through: where it is much, the run may have ended while grains flowed.
const kManyInside = 0.05;
const insideShare = (r) => (r.entered_kg > 0 && isNumber(r.went_through_kg) ? 1 - r.went_through_kg / r.entered_kg : 0);

const residenceFacts = (r) => [insideShare(r) > kManyInside && note(`${significant(100 * insideShare(r), 2)} % of what entered was still inside when the run ended. Where grains still flowed then, the times are of the quicker ones, and what is inside is not what would stay: a drain to the end (discharged_fraction = 1) tells both.`), facts([
  ["Went through", isNumber(r.went_through_kg) && `${withUnit("mass", r.went_through_kg)} of ${withUnit("mass", r.entered_kg)} that entered`],
  ["Mean", isNumber(r.mean_s) && withUnit("time", r.mean_s)],
  ["10 %, half, 90 %", isNumber(r.median_s) && `within ${[r.p10_s, r.median_s, r.p90_s].map((t) => withUnit("time", t)).join(", ")}`],
  [insideShare(r) > kManyInside ? "Inside at the end" : "Left behind", isNumber(r.retained_kg) && `${withUnit("mass", r.retained_kg)} (${grouped(r.retained_grains)} grains), ${withUnit("mass", r.retained_at_no_junction_kg ?? 0)} of it at no junction`],
  ["Of it", isNumber(r.retained_near_junctions_kg) && `${withUnit("mass", r.retained_near_junctions_kg)} near the junctions (nearer than to a fibre's middle)${isNumber(r.retained_along_fibres_kg) ? `, ${withUnit("mass", r.retained_along_fibres_kg)} along the fibres between them or still falling` : ""}`],
])];

const retainedTable = (run) => {
  const t = columnsOf(run, "retained");
  if (!t?.mass_kg) return null;
  const order = t.mass_kg.map((_, k) => k).filter((k) => t.mass_kg[k] > 0).sort((a, b) => t.mass_kg[b] - t.mass_kg[a]);
  if (order.length === 0) return note("Nothing is at a junction.");
  return [
    table([{ title: "Junction at x, y, z, mm" }, { title: "Mass, mg", number: true }, { title: "Grains", number: true }],
      order.slice(0, kMostJunctions).map((k) => [[t.x_m, t.y_m, t.z_m].map((x) => plain(1e3 * x[k])).join(", "), significant(1e6 * t.mass_kg[k]), grouped(t.grains?.[k])])),
    order.length > kMostJunctions && note(`The ${kMostJunctions} that hold the most, of ${grouped(order.length)}: all are in retained.csv.`),
  ];
};

addSection({
  id: "residence",
  title: "Residence and retention",
  make: ({ runs }) => {
    const histogram = residenceHistogram(runs);
    const ofRuns = perRun(runs, (run) => {
      const numbers = run.summary?.residence && residenceFacts(run.summary.residence), retained = retainedTable(run);
      return [numbers, runs.length === 1 && histogram, retained && [h("h3", {}, "At the junctions at the end"), retained], gallery(run, "residence")];
    });
    return [runs.length > 1 && histogram, ofRuns];
  },
});
