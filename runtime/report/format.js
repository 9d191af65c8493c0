// Numbers as people of the field write them. Everything in the data is SI.

// `digits` significant digits, no exponent where a plain number reads better.
const significant = (value, digits = 3) => {
  if (!isNumber(value)) return "–";
  if (value === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(value)));
  if (size < -4 || size > 8) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    const raised = [...String(Number(exponent))].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"["0123456789".indexOf(c)] ?? "⁻").join("");
    return `${mantissa}×10${raised}`.replace("-", "−");
  }
  return value.toFixed(Math.max(0, digits - 1 - size)).replace("-", "−");
};

// A number as a person wrote it in the case: 0.3, not 0.300.
const plain = (value) => {
  const text = significant(value, 4);
  return text.includes(".") && !text.includes("×") ? text.replace(/0+$/, "").replace(/\.$/, "") : text;
};

const grouped = (value) => (isNumber(value) ? Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, " ") : "–");

// The first unit that makes the value at least 1: [factor, name], from large to small.
const units = {
  length: [[1, "m"], [1e-3, "mm"], [1e-6, "µm"]],
  mass: [[1, "kg"], [1e-3, "g"], [1e-6, "mg"]],
  flow: [[1, "kg/s"], [1e-3, "g/s"], [1e-6, "mg/s"]],
  time: [[1, "s"], [1e-3, "ms"], [1e-6, "µs"], [1e-9, "ns"]],
  energy: [[1, "J"], [1e-3, "mJ"], [1e-6, "µJ"], [1e-9, "nJ"]],
  bytes: [[1e9, "GB"], [1e6, "MB"], [1e3, "kB"], [1, "bytes"]],
  pressure: [[1e9, "GPa"], [1e6, "MPa"], [1e3, "kPa"], [1, "Pa"]],
};
const unitFor = (quantity, value) => {
  const choices = units[quantity];
  return choices.find(([factor]) => Math.abs(value) >= 0.9999 * factor) ?? choices[choices.length - 1];
};
const withUnit = (quantity, value, digits = 3) => {
  if (!isNumber(value)) return "–";
  const [factor, name] = unitFor(quantity, value);
  return `${significant(value / factor, digits)} ${name}`;
};
const given = (quantity, value) => {
  if (!isNumber(value)) return "–";
  const [factor, name] = unitFor(quantity, value);
  return `${plain(value / factor)} ${name}`;
};

// A number and its standard error with the digits that the error allows: "7.89 ± 0.23".
const withError = (value, error) => {
  if (!isNumber(error) || error <= 0) return significant(value, 4);
  const places = Math.max(0, 1 - Math.floor(Math.log10(error)));
  return `${value.toFixed(Math.min(places, 12))} ± ${error.toFixed(Math.min(places, 12))}`;
};

const duration = (seconds) => {
  if (!isNumber(seconds)) return "–";
  if (seconds < 60) return `${significant(seconds, seconds < 10 ? 2 : 3)} s`;
  if (seconds < 600) return `${Math.floor(seconds / 60)} min ${Math.floor(seconds % 60)} s`;
  const minutes = Math.round(seconds / 60);
  if (minutes < 120) return `${minutes} min`;
  return minutes < 2880 ? `${Math.floor(minutes / 60)} h ${minutes % 60} min` : `${significant(minutes / 1440, 2)} days`;
};

const percent = (share) => `${plain(100 * share)} %`;

// "sliding_work_J" in words, for keys that the page has no words of its own for: "Sliding work, J".
const kUnitOfKey = /_((?:kg|g|s|m[23]?|um|mm|n|j|pa|k|w|deg|bytes)(?:_per_(?:kg|s2?|m[23]?|k))?|per_(?:s|m[23]?))$/i;
const kUnitCase = { n: "N", j: "J", pa: "Pa", k: "K", w: "W" };
const unitInWords = (unit) => unit.split("_per_").map((u) => kUnitCase[u] ?? u).join("/").replace(/^per_/, "1/").replace(/\b([ms])([23])/g, (_, unit, n) => `${unit}${"²³"[n - 2]}`);
const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);
const lowerFirst = (text) => text.charAt(0).toLowerCase() + text.slice(1);
const inWords = (key) => {
  const unit = kUnitOfKey.exec(String(key))?.[1];
  const name = unit ? key.slice(0, key.length - unit.length - 1) : String(key);
  return capital(name.replace(/_/g, " ")) + (unit ? `, ${unitInWords(unit)}` : "");
};
