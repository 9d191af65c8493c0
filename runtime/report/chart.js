// Charts: uPlot with the page's colours, zoom and read-out. A chart is made again when the theme or its width changes.

const kChartHeight = 280, kPhoneChartHeight = 220, kPhoneWidth = 520;  // px
const charts = new Set();  // of {rebuild(), reset()}

const cssColour = (text) => {
  const name = /^var\((--[\w-]+)\)$/.exec(text)?.[1];
  return name ? getComputedStyle(document.documentElement).getPropertyValue(name).trim() : text;
};

// Draws inside the plot's frame.
const inFrame = (u, draw) => {
  const { ctx } = u, { top, height, left, width } = u.bbox, ratio = devicePixelRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, width, height);
  ctx.clip();
  draw(ctx, top, height, ratio);
  ctx.restore();
};

// Shaded stretches of x.
const drawBands = (bands) => (u) => inFrame(u, (ctx, top, height, ratio) => {
  for (const band of bands) {
    const a = u.valToPos(band.from, "x", true), b = u.valToPos(band.to, "x", true);
    ctx.fillStyle = cssColour("var(--band)");
    ctx.fillRect(a, top, Math.max(b - a, ratio), height);
  }
});

// Named moments.
const drawMarks = (marks) => (u) => inFrame(u, (ctx, top, height, ratio) => {
  ctx.font = `${11 * ratio}px system-ui, sans-serif`;
  ctx.textBaseline = "top";
  ctx.textAlign = "left";
  let free = -Infinity;  // where the labels so far end
  for (const mark of marks) {
    const x = Math.round(u.valToPos(mark.at, "x", true));
    ctx.strokeStyle = cssColour("var(--rule)");
    ctx.lineWidth = ratio;
    ctx.beginPath();
    ctx.moveTo(x, top);
    ctx.lineTo(x, top + height);
    ctx.stroke();
    if (x + 4 * ratio < free) continue;
    ctx.fillStyle = cssColour("var(--quiet)");
    ctx.fillText(mark.label, x + 4 * ratio, top + 3 * ratio);
    free = x + 12 * ratio + ctx.measureText(mark.label).width;
  }
});

// Bands of +- spread[k] round the curves that have them, under the curves.
const drawSpreads = (series) => (u) => inFrame(u, (ctx) => {
  ctx.globalAlpha = 0.2;
  series.forEach((s, index) => {
    if (!s.spread || !u.series[index + 1].show) return;
    ctx.fillStyle = cssColour(s.colour);
    const at = (k, sign) => [u.valToPos(u.data[0][k], "x", true), u.valToPos(s.values[k] + sign * s.spread[k], "y", true)];
    const known = (k) => isNumber(s.values[k]) && isNumber(s.spread[k]);
    for (let from = 0, to = 0; from < s.values.length; from = to + 1) {
      for (to = from; to < s.values.length && known(to); ++to);
      if (to - from < 2) continue;
      ctx.beginPath();
      for (let k = from; k < to; ++k) ctx.lineTo(...at(k, 1));
      for (let k = to - 1; k >= from; --k) ctx.lineTo(...at(k, -1));
      ctx.fill();
    }
  });
});

// Vertical bars of +- errors[k] at the points of the series that have them.
const drawErrors = (series) => (u) => {
  const { ctx } = u, ratio = devicePixelRatio;
  ctx.save();
  ctx.lineWidth = 1.5 * ratio;
  ctx.setLineDash([]);
  series.forEach((s, index) => {
    if (!s.errors || !u.series[index + 1].show) return;
    ctx.strokeStyle = cssColour(s.colour);
    u.data[0].forEach((x, k) => {
      const value = u.data[index + 1][k], error = s.errors[k];
      if (!isNumber(value) || !(error > 0)) return;
      const at = Math.round(u.valToPos(x, "x", true)), cap = 4 * ratio;
      const low = u.valToPos(value - error, "y", true), high = u.valToPos(value + error, "y", true);
      ctx.beginPath();
      ctx.moveTo(at, low), ctx.lineTo(at, high);
      ctx.moveTo(at - cap, low), ctx.lineTo(at + cap, low);
      ctx.moveTo(at - cap, high), ctx.lineTo(at + cap, high);
      ctx.stroke();
    });
  });
  ctx.restore();
};

const axis = (label, more) => ({
  label: label || undefined,
  labelSize: 20,
  labelFont: "12px system-ui, sans-serif",
  font: "12px system-ui, sans-serif",
  stroke: cssColour("var(--quiet)"),
  grid: { stroke: cssColour("var(--grid)"), width: 1 },
  ticks: { show: false },
  ...more,
});

const seriesOptions = (s) => ({
  label: s.label,
  stroke: cssColour(s.colour),
  width: s.width ?? 1.75,
  dash: s.dash,
  paths: s.steps ? uPlot.paths.stepped({ align: 1 }) : undefined,
  points: s.markers ? { show: true, size: 8, fill: cssColour(s.colour) } : { show: false },
  value: (u, value, series, index) => (isNumber(value) ? s.text(value, index) : "–"),
});

// From 0, or below what lies below, to a little above what is in sight, bands included.
const rangeWith = (series) => (u, low, high) => {
  const [first, last] = u.series[0].idxs ?? [0, u.data[0].length - 1];
  series.forEach((s, index) => {
    if (!s.spread || !u.series[index + 1].show) return;
    for (let k = first; k <= last; ++k) {
      if (!isNumber(s.values[k]) || !isNumber(s.spread[k])) continue;
      low = Math.min(low, s.values[k] - s.spread[k]), high = Math.max(high, s.values[k] + s.spread[k]);
    }
  });
  return low === high ? [0, high > 0 ? 1.2 * high : 1] : [Math.min(0, low), high + 0.06 * (high - Math.min(0, low))];
};

const chartOptions = (c, width) => ({
  width,
  height: c.height ?? (width < kPhoneWidth ? kPhoneChartHeight : kChartHeight),
  cursor: {
    drag: { x: true, y: false, setScale: true },
    points: { size: 7 },
    sync: c.sync ? { key: c.sync, scales: ["x", null] } : undefined,
  },
  legend: { live: true, markers: { width: 0, fill: (u, k) => cssColour(c.series[k - 1].colour) } },
  scales: {
    x: { time: false, range: c.xRange },
    y: { range: c.yRange ?? rangeWith(c.series) },
  },
  axes: [axis(c.xLabel, { size: 30, ...c.xAxis }), axis(c.yLabel, { size: width < kPhoneWidth ? 44 : 56 })],
  series: [{ label: c.xName, value: (u, value) => (isNumber(value) ? c.xText(value) : "–") }, ...c.series.map(seriesOptions)],
  hooks: {
    drawClear: [drawBands(c.bands ?? [])],
    drawAxes: [drawMarks(c.marks ?? []), drawSpreads(c.series)],
    draw: [drawErrors(c.series)],
    setScale: [(u, key) => key === "x" && c.onZoom?.(u)],
  },
});

// A chart that fills its parent's width:
//   x, xName, xText(value), xLabel   the axis; xText is the read-out's
//   series  [{label, values, colour, text(value, index), dash?, width?, markers?, errors?, spread?, steps?}]
//           errors: bars at the points; spread: a band round the curve; both +- so much for each value
//   yLabel, bands? [{from, to}], marks? [{at, label}], sync? (charts that move and zoom together), xRange?, yRange?
const chart = (c) => {
  if (typeof uPlot === "undefined")
    return note("This build of Scree has no charts: npm could not install the charting library. The curves are in the run's CSV files.");
  const holder = h("div", { class: "chart" });
  const reset = h("button", { class: "reset", type: "button", hidden: true, click: () => resetZoom(c.sync, me) }, "Whole curve");
  let plot = null, width = 0;
  const first = c.x[0], last = c.x[c.x.length - 1];
  c.onZoom = (u) => {
    const { min, max } = u.scales.x;
    reset.hidden = !isNumber(min) || (max - min) >= 0.999 * (last - first);
  };
  const build = () => {
    const shown = plot?.scales.x, series = plot?.series.map((s) => s.show);
    plot?.destroy();
    plot = new uPlot(chartOptions(c, width), [c.x, ...c.series.map((s) => s.values)], holder);
    if (shown && !reset.hidden) plot.setScale("x", { min: shown.min, max: shown.max });
    series?.forEach((show, k) => k > 0 && !show && plot.setSeries(k, { show }));
  };
  const me = {
    sync: c.sync,
    rebuild: () => width > 0 && build(),
    reset: () => plot?.setScale("x", { min: first, max: last }),
  };
  new ResizeObserver(() => {
    const now = Math.floor(holder.clientWidth);
    if (now > 0 && now !== width) { width = now; build(); }
  }).observe(holder);
  charts.add(me);
  // The same curves with new values and spreads on the same axis: [{values, spread?}, ...].
  holder.update = (curves) => { c.series.forEach((s, k) => { s.values = curves[k].values, s.spread = curves[k].spread; }); if (plot) build(); };
  return h("div", { class: "chart-box" }, reset, holder);
};

const resetZoom = (sync, one) => {
  for (const other of charts) if (other === one || (sync && other.sync === sync)) other.reset();
};

const rebuildCharts = () => charts.forEach((c) => c.rebuild());
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", rebuildCharts);
// Folds are printed as they are: what the reader has opened.
addEventListener("beforeprint", () => { document.documentElement.dataset.theme = "light"; rebuildCharts(); });
addEventListener("afterprint", () => { delete document.documentElement.dataset.theme; rebuildCharts(); });
