// Curves out of the tables of a run.

// The columns of a table as {name: values}, or null if the run has no such table with at least two rows.
const columnsOf = (run, table) => {
  const t = run.tables?.[table];
  if (!t || t.data.length === 0 || t.data[0].length < 2) return null;
  return Object.fromEntries(t.columns.map((name, k) => [name, t.data[k]]));
};

// Linear in between; null outside [xs[0], xs[last]]. xs ascend.
const valueAt = (xs, ys, x) => {
  const last = xs.length - 1;
  if (!(x >= xs[0] && x <= xs[last])) return null;
  let low = 0, high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (xs[middle] <= x) low = middle;
    else high = middle;
  }
  const width = xs[high] - xs[low];
  return width > 0 ? ys[low] + ((x - xs[low]) / width) * (ys[high] - ys[low]) : ys[high];
};

// d(ys)/dx as the slope over `window` round each x, cut at the curve's ends.
const slopeOver = (xs, ys, window) => {
  const first = xs[0], last = xs[xs.length - 1];
  return xs.map((x) => {
    const a = Math.max(first, x - window / 2), b = Math.min(last, x + window / 2);
    return b > a ? (valueAt(xs, ys, b) - valueAt(xs, ys, a)) / (b - a) : null;
  });
};

// Start of the first stage of this kind, s; null if there is none.
const stageStart = (run, kind) => run.summary?.stages?.find((stage) => stage.kind === kind)?.start_s ?? null;

// Where the discharge begins, s.
const drainStart = (run) => stageStart(run, "drain") ?? 0;

// Several curves {x, y} on one axis: the only one's own points, or a common grid fine enough for a screen, which begins
// no earlier than `from`.
const kGridPoints = 2000;
const onCommonAxis = (curves, from = -Infinity) => {
  if (curves.length === 1) return { x: curves[0].x, ys: [curves[0].y] };
  const low = Math.max(from, Math.min(...curves.map((c) => c.x[0])));
  const high = Math.max(...curves.map((c) => c.x[c.x.length - 1]));
  const x = Array.from({ length: kGridPoints }, (_, k) => low + ((high - low) * k) / (kGridPoints - 1));
  return { x, ys: curves.map((c) => x.map((at) => valueAt(c.x, c.y, at))) };
};

// The mean of values and its standard error from their scatter; 0 for one alone, which has none.
const meanAndError = (values) => {
  const n = values.length, mean = values.reduce((sum, v) => sum + v, 0) / n;
  const square = values.reduce((sum, v) => sum + (v - mean) ** 2, 0);
  return { mean, error: n > 1 ? Math.sqrt(square / (n - 1) / n) : 0 };
};

// Several curves on one axis as {values, spread}: their mean where all of them are, and its standard error.
const meanCurve = (ys) => {
  if (ys.length === 1) return { values: ys[0], spread: null };
  const points = ys[0].map((_, k) => (ys.every((y) => isNumber(y[k])) ? meanAndError(ys.map((y) => y[k])) : null));
  return { values: points.map((p) => p && p.mean), spread: points.map((p) => p && p.error) };
};

// The first x at which the curve reaches `level`; null if it never does.
const firstReach = (xs, ys, level) => {
  const k = ys.findIndex((y) => y >= level);
  if (k <= 0) return k === 0 ? xs[0] : null;
  return xs[k - 1] + ((level - ys[k - 1]) / (ys[k] - ys[k - 1])) * (xs[k] - xs[k - 1]);
};

// A window of 1, 2 or 5 times a power of ten, near `share` of the duration.
const niceWindow = (seconds, share) => {
  const wanted = seconds * share;
  if (!(wanted > 0)) return 0;
  const power = 10 ** Math.floor(Math.log10(wanted));
  return [5, 2, 1].find((k) => k * power <= wanted * 1.001) * power;
};
