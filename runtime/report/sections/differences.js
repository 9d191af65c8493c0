// Several runs: the keys of their cases that differ.

const kMostDifferences = 40;

// Every value of a case under its full key; elements of lists by their name, kind, materials or number.
const leaves = (value, path = "", found = new Map()) => {
  if (isObject(value)) {
    for (const [key, one] of Object.entries(value)) leaves(one, path ? `${path}.${key}` : key, found);
  } else if (Array.isArray(value) && value.some(isObject)) {
    value.forEach((one, k) => leaves(one, `${path}.${one.name ?? (one.materials ?? [one.kind ?? k + 1]).join("+")}`, found));
  } else {
    found.set(path, JSON.stringify(value));
  }
  return found;
};

const makeDifferences = (runs) => {
  const cases = runs.map((run) => leaves(run.case ?? {}));
  const keys = [...new Set(cases.flatMap((c) => [...c.keys()]))].filter((key) => new Set(cases.map((c) => c.get(key))).size > 1);
  if (keys.length === 0) return note("The cases are the same in every key.");
  const shown = keys.slice(0, kMostDifferences);
  return [
    table([{ title: "Run" }, ...shown.map((key) => ({ title: key }))],
      runs.map((run, k) => [[swatch(run.colour), " ", run.label], ...shown.map((key) => cases[k].get(key)?.replace(/^"|"$/g, "") ?? "–")])),
    keys.length > shown.length && note(`${keys.length - shown.length} more keys differ: see the case.toml of the runs.`),
  ];
};

addSection({ id: "differences", title: "What differs", make: ({ runs, sweep }) => (runs.length > 1 && !sweep ? makeDifferences(runs) : null) });
