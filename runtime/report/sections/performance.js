// How fast it was, and where the time went.

const kShares = { step: "contacts and motion", history: "contact history", sort: "sorting", pair_search: "search of pairs", solid_search: "search of walls and fibres", checkpoints: "checkpoints" };

const timeShares = (s) => {
  const parts = Object.entries(s.wall_seconds ?? {}).filter(([, seconds]) => isNumber(seconds)).map(([key, seconds]) => [kShares[key] ?? lowerFirst(inWords(key)), seconds]);
  if (isNumber(s.checkpoints?.seconds)) parts.push([kShares.checkpoints, s.checkpoints.seconds]);
  const other = s.wall_time_s - parts.reduce((sum, [, seconds]) => sum + seconds, 0);
  if (other > 0) parts.push(["placing, measuring, writing", other]);
  return parts.filter(([, seconds]) => seconds > 0);
};

const shareBar = (s) => {
  const parts = timeShares(s), total = parts.reduce((sum, [, seconds]) => sum + seconds, 0);
  if (parts.length === 0 || s.resumed_from) return null;  // the parts are of the last process only
  return [
    h("h3", {}, "Where the time went"),
    h("div", { class: "shares", "aria-hidden": "true" }, parts.map(([name, seconds], k) => h("div", { title: name, style: `flex:${seconds} 0 0;background:${colourOf(k)}` }))),
    h("ul", { class: "key" }, parts.map(([name, seconds], k) => h("li", {}, swatch(k), ` ${name} `, h("span", { class: "quiet" }, `${duration(seconds)}, ${significant((100 * seconds) / total, 2)} %`)))),
  ];
};

const performanceOf = (s) => [
  facts([
    ["Speed", isNumber(s.particle_steps_per_second) && `${significant(s.particle_steps_per_second / 1e6)} million particle-steps a second`],
    ["Wall time", isNumber(s.wall_time_s) && duration(s.wall_time_s)],
    ["Steps", isNumber(s.steps) && `${grouped(s.steps)}, lists renewed ${grouped(s.rebuilds)} times`],
    ["Threads", isNumber(s.threads) && `${s.threads} (${s.isa} kernels)`],
    ["Memory", isNumber(s.peak_rss_bytes) && `${withUnit("bytes", s.peak_rss_bytes)} at the most`],
    ["Resumed from", s.resumed_from],
    ["State hash", s.state_hash && h("code", {}, s.state_hash)],
  ]),
  shareBar(s),
];

addSection({
  id: "performance",
  title: "Performance",
  make: ({ runs }) => {
    if (runs.length === 1) return runs[0].summary ? performanceOf(runs[0].summary) : null;
    const ended = runs.filter((run) => run.summary);
    if (ended.length === 0) return null;
    return table([{ title: "Run" }, { title: "Million particle-steps/s", number: true }, { title: "Wall time", number: true }, { title: "Threads", number: true }, { title: "Memory", number: true }],
      ended.map(({ label, summary: s }) => [label, significant(s.particle_steps_per_second / 1e6), duration(s.wall_time_s), s.threads, withUnit("bytes", s.peak_rss_bytes)]));
  },
});
