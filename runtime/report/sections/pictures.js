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

const figure = (picture) =>
  h("figure", {},
    h("button", { type: "button", class: "picture", "aria-label": `Enlarge ${captionOf(picture)}`, click: () => zoomPicture(picture) },
      h("img", { src: picture.uri, alt: captionOf(picture), width: picture.width, height: picture.height })),
    h("figcaption", {}, captionOf(picture)));

// The pictures of one folder of each run; null if there are none.
const gallery = (runs, folder) => {
  const parts = runs.map((run) => {
    const pictures = run.pictures.filter((p) => p.folder === folder);
    if (pictures.length === 0) return null;
    const out = pictures.find((p) => p.left_out)?.left_out;
    return [
      runs.length > 1 && h("h3", {}, swatch(run.colour), " ", run.label),
      h("div", { class: "gallery" }, pictures.filter((p) => p.uri).map(figure)),
      out && note(`${grouped(out)} more in `, h("a", { href: `${run.link}/${folder}/` }, `${folder}/`), "."),
    ];
  }).filter(Boolean);
  return parts.length > 0 ? parts : null;
};

addSection({ id: "pictures", title: "Pictures", make: ({ runs }) => gallery(runs, "pictures") });
