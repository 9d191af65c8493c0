// Puts the sections that have something to show on the page.

const data = JSON.parse(document.getElementById("data").textContent);

nameRuns(data);

const subtitle = ({ runs, sweep }) => {
  if (sweep) return `Sweep of ${sweep.parameters.map((p) => p.label).join(", ") || "seeds"}: ${sweep.runs.length} runs, ${runs.length} with results`;
  if (runs.length > 1) return runs.map((run) => run.label).join(", ");
  return runs[0]?.name ?? "";
};

// A section that fails says so and leaves the others alone: a report of a broken run is when it is needed most.
const contentOf = (section) => {
  try {
    return section.make(data);
  } catch (error) {
    console.error(section.id, error);
    return note(`This section could not be made: ${error.message}`);
  }
};

const shown = sections.map((section) => ({ ...section, content: contentOf(section) })).filter(({ content }) => !isEmpty(content));

document.title = `${data.title || "Scree"} – Scree`;
document.getElementById("top").append(
  h("p", { class: "kind" }, data.sweep ? "Scree sweep" : data.runs.length > 1 ? "Scree comparison" : "Scree run"),
  h("h1", {}, data.title || "Untitled"),
  h("p", { class: "subtitle" }, subtitle(data)),
  h("nav", { "aria-label": "Sections" }, shown.map(({ id, title }) => h("a", { href: `#${id}` }, title))));
document.getElementById("page").replaceChildren(
  ...shown.map(({ id, title, content }) => h("section", { id, "aria-labelledby": `${id}-title` }, h("h2", { id: `${id}-title` }, title), content)));
document.getElementById("foot").append("Made by Scree ", data.version, ". This page is complete in itself: it can be moved, sent and opened offline; its links to files need the folder beside it.");
