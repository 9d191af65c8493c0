// Residence times and what stays behind: residence*.csv and retention*.csv, as curves where they are numbers over a
// first column, as tables where they name places; and residence/*.png.

const kMostTableRows = 60;

const isCurve = (t) => t.data.length > 1 && t.data[0].length > 2 && t.data.every((column) => column.every(isNumber))
  && t.data[0].every((x, k) => k === 0 || x > t.data[0][k - 1]);

const residenceCurves = (runs, name) => {
  const having = runs.map((run) => ({ run, t: run.tables[name] })).filter(({ t }) => t && isCurve(t));
  const t = having[0].t;
  return t.columns.slice(1).map((column, k) => {
    const { x, ys } = onCommonAxis(having.map((one) => ({ x: one.t.data[0], y: one.t.data[k + 1] })));
    return chart({ x, xName: lowerFirst(inWords(t.columns[0])), xText: (v) => significant(v, 4), xLabel: lowerFirst(inWords(t.columns[0])), yLabel: lowerFirst(inWords(column)),
      series: having.map(({ run }, j) => ({ label: runs.length > 1 ? run.label : lowerFirst(inWords(column)), values: ys[j], colour: colourOf(run.colour), text: (v) => significant(v, 4) })) });
  });
};

const residenceTable = (runs, name) => runs.filter((run) => run.tables[name]).map((run) => {
  const t = run.tables[name], rows = Math.min(t.data[0].length, kMostTableRows);
  return [
    runs.length > 1 && h("h4", {}, run.label),
    table(t.columns.map((c, k) => ({ title: inWords(c), number: isNumber(t.data[k][0]) })),
      Array.from({ length: rows }, (_, k) => t.data.map((column) => valueText(column[k])))),
    t.rows > rows && note(`${grouped(t.rows - rows)} more rows in ${name}.csv.`),
  ];
});

addSection({
  id: "residence",
  title: "Residence and retention",
  make: ({ runs }) => {
    const names = [...new Set(runs.flatMap((run) => Object.keys(run.tables)))].filter((name) => /^(residence|retention)/.test(name));
    const parts = names.filter((name) => runs.some((run) => run.tables[name]?.rows > 0)).map((name) => [
      h("h3", {}, inWords(name)),
      runs.some((run) => run.tables[name] && isCurve(run.tables[name])) ? residenceCurves(runs, name) : residenceTable(runs, name)]);
    const facts = runs.map((run) => [run.summary?.residence, run.summary?.retention].filter(Boolean).map(anyTable)).filter((f) => f.length > 0);
    const pictures = gallery(runs, "residence");
    return parts.length > 0 || facts.length > 0 || pictures ? [facts, parts, pictures] : null;
  },
});
