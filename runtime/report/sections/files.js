// The files of the run, where they are and what they hold.

const kFileWords = [
  [/^mass_flow\.csv$/, "time, discharged mass, mass flow"],
  [/^meters\.csv$/, "time, mass in each meter"],
  [/^summary\.json$/, "the numbers of this page"],
  [/^particles\.vtp$/, "the final particles, for ParaView"],
  [/^failure\.vtp$/, "the particles round the place of the failure"],
  [/^case\.toml$/, "the case in full, defaults filled in: can be run again"],
  [/^run\.log$/, "what happened when"],
  [/^console\.log$/, "what the program said"],
  [/^checkpoints\/$/, "states that the run can go on from"],
  [/^pictures\/$/, "pictures"],
  [/^fields\/$/, "particles and walls over time, for ParaView"],
  [/^residence\.csv$/, "mass by residence time"],
  [/^retained\.csv$/, "mass left at each junction"],
  [/^touch\.csv$/, "how much each fibre and wall is touched"],
];
// Folders are one row each: they may hold hundreds of files.
const rowsOfFiles = (run) => {
  const rows = new Map();
  for (const { file, bytes } of run.files) {
    if (file === "report.html") continue;
    const folder = file.includes("/") ? `${file.split("/")[0]}/` : file;
    const row = rows.get(folder) ?? { count: 0, bytes: 0 };
    rows.set(folder, { count: row.count + 1, bytes: row.bytes + bytes });
  }
  return [...rows].map(([name, { count, bytes }]) => [
    h("a", { href: `${run.link}/${name}` }, name),
    [kFileWords.find(([pattern]) => pattern.test(name))?.[1], name.endsWith("/") && `${grouped(count)} file${count === 1 ? "" : "s"}`].filter(Boolean).join(": "),
    withUnit("bytes", bytes)]);
};

addSection({
  id: "files",
  title: "Files",
  make: ({ runs }) =>
    runs.length === 1
      ? [note("In ", h("code", {}, runs[0].path)), table([{ title: "File" }, { title: "What" }, { title: "Size", number: true }], rowsOfFiles(runs[0]))]
      : table([{ title: "Run" }, { title: "Folder" }], runs.map((run) => [reportLink(run), h("code", {}, run.path)])),
});
