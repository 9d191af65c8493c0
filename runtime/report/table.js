// Tables.

// columns: [{title, number?: true}], rows: arrays of texts or nodes. Wide ones scroll inside their own box.
const table = (columns, rows) =>
  h("div", { class: "table-box" },
    h("table", {},
      h("thead", {}, h("tr", {}, columns.map((c) => h("th", { class: c.number && "number", scope: "col" }, c.title)))),
      h("tbody", {}, rows.map((row) => h("tr", {}, row.map((cell, k) => h("td", { class: columns[k].number && "number" }, cell)))))));

// Names and values, one under the other: [[name, value], ...]; pairs without a value are left out.
const facts = (pairs) =>
  h("dl", { class: "facts" },
    pairs.filter(([, value]) => value !== null && value !== undefined && value !== false && value !== "")
      .map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value))));

const valueText = (value) =>
  isNumber(value) ? (Number.isInteger(value) ? grouped(value) : plain(value))
  : Array.isArray(value) ? value.map(valueText).join(", ")
  : value === null || value === undefined ? "–"
  : value === true ? "yes" : value === false ? "no" : String(value);

// Whatever a part of summary.json holds: an object of values as facts, a list of objects (or an object of objects) as
// a table with a column for each key.
const anyTable = (value) => {
  if (isObject(value) && Object.values(value).every(isObject) && Object.keys(value).length > 0)
    value = Object.entries(value).map(([name, row]) => ({ name, ...row }));
  if (Array.isArray(value) && value.length > 0 && value.every(isObject)) {
    const keys = [...new Set(value.flatMap(Object.keys))].filter((key) => value.some((row) => !isObject(row[key])));
    const isColumnOfNumbers = (key) => value.every((row) => row[key] === null || row[key] === undefined || isNumber(row[key]));
    return table(keys.map((key) => ({ title: inWords(key), number: isColumnOfNumbers(key) })),
      value.map((row) => keys.map((key) => valueText(row[key]))));
  }
  if (!isObject(value)) return null;
  const nested = Object.entries(value).filter(([, v]) => isObject(v) || (Array.isArray(v) && v.some(isObject)));
  return [facts(Object.entries(value).filter(([, v]) => !nested.some(([, n]) => n === v)).map(([key, v]) => [inWords(key), valueText(v)])),
    nested.map(([key, v]) => [h("h3", {}, inWords(key)), anyTable(v)])];
};
