// Building the page, and the list of its sections.

// h("p", {class: "note"}, "text", child, ...): an element. Attributes with the value null or false are left out;
// functions are event listeners. Children that are null or false are left out.
const h = (tag, attributes, ...children) => {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (typeof value === "function") element.addEventListener(name, value);
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(name, value === true ? "" : value);
  }
  for (const child of children.flat(Infinity)) {
    if (child !== null && child !== undefined && child !== false) element.append(child);
  }
  return element;
};

const svg = (tag, attributes, ...children) => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes ?? {})) element.setAttribute(name, value);
  element.append(...children);
  return element;
};

// A section: {id, title, make(data)}. make() returns the section's content (nodes), or null if there is nothing to
// show. Sections stand in the order in which their files are bundled (report.cmake).
const sections = [];
const addSection = (section) => sections.push(section);

const note = (...children) => h("p", { class: "note" }, ...children);

const isEmpty = (content) => [content].flat(Infinity).every((part) => part === null || part === undefined || part === false);
const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

// The name and the colour that each run has in every chart and table. In a sweep those of its combination.
const nameRuns = ({ runs, sweep }) => {
  runs.forEach((run, index) => { run.label = run.name; run.colour = index; });
  const combinations = [];
  for (const member of sweep?.runs ?? []) {
    const texts = member.values.map((v, k) => sweep.parameters[k].values[v].text), key = texts.join();
    if (!combinations.includes(key)) combinations.push(key);
    if (!isNumber(member.run)) continue;
    runs[member.run].label = [...texts, ...(member.seed === null ? [] : [`seed ${member.seed}`])].join(", ");
    runs[member.run].colour = combinations.indexOf(key);
  }
};
// What a section has to say of each run, one after the other: content(run) returns nodes, or null. Many runs are folded
// away, so that the page stays one that can be read; each opens by itself. Null if no run has anything.
const kMostUnfolded = 2;
const perRun = (runs, content) => {
  const parts = runs.map((run) => {
    const part = content(run), name = [swatch(run.colour), " ", run.label];
    if (isEmpty(part)) return null;
    if (runs.length === 1) return part;
    if (runs.length <= kMostUnfolded) return [h("h3", {}, name), part];
    return h("details", { class: "of-run" }, h("summary", {}, name), part);
  }).filter(Boolean);
  return parts.length > 0 ? parts : null;
};

const kSeriesColours = 8;
const colourOf = (index) => `var(--series-${index % kSeriesColours})`;
const swatch = (index) => h("span", { class: "swatch", style: `background:${colourOf(index)}`, "aria-hidden": "true" });
