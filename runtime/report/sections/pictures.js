// Pictures of the run. gallery() serves the sections of other folders, too.

// "front_speed_0.350000.png": a camera's name, a colour's, a moment.
const captionOf = ({ file }) => {
  const stem = file.replace(/\.png$/, ""), timed = /^(.*?)_?(\d+\.\d+)$/.exec(stem);
  return timed ? `${inWords(timed[1])}, t = ${plain(Number(timed[2]))} s` : inWords(stem);
};

const zoomPicture = (picture) => {
  const box = document.getElementById("zoom");
  box.replaceChildren(h("img", { src: picture.uri, alt: captionOf(picture) }), h("p", {}, captionOf(picture)));
  box.onclick = () => box.close();
  box.showModal();
};

const figure = (picture, caption = captionOf(picture)) =>
  h("figure", {},
    h("button", { type: "button", class: "picture", "aria-label": `Enlarge ${captionOf(picture)}`, click: () => zoomPicture(picture) },
      h("img", { src: picture.uri, alt: captionOf(picture), width: picture.width, height: picture.height })),
    h("figcaption", {}, caption));

// The pictures of one folder of a run; null if there are none.
const gallery = (run, folder) => {
  const pictures = run.pictures.filter((p) => p.folder === folder);
  if (pictures.length === 0) return null;
  const out = pictures.find((p) => p.left_out)?.left_out;
  return [
    h("div", { class: "gallery" }, pictures.filter((p) => p.uri).map((p) => figure(p))),
    out && note(`${grouped(out)} more in `, h("a", { href: `${run.link}/${folder}/` }, `${folder}/`), "."),
  ];
};

// Many runs side by side: of each the last picture there is.
const lastPictures = (runs) => {
  if (runs.length <= kMostUnfolded) return null;
  const having = runs.map((run) => ({ run, picture: run.pictures.findLast((p) => p.folder === "pictures" && p.uri) })).filter(({ picture }) => picture);
  return having.length > 0 && h("div", { class: "gallery small" }, having.map(({ run, picture }) => figure(picture, [swatch(run.colour), ` ${run.label}: ${lowerFirst(captionOf(picture))}`])));
};

addSection({
  id: "pictures",
  title: "Pictures",
  make: ({ runs }) => {
    const all = perRun(runs, (run) => gallery(run, "pictures"));
    return all && [lastPictures(runs), all];
  },
});
