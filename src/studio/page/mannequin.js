// The body's outline: a click on a part of it places the chosen piece there.

/** Parts of the body as seen from in front, where the wearer's left is at the right: words, and a shape. */
const AREAS = [
  ["neck", "M92 44 L108 44 L110 58 L90 58 Z"],
  ["torso", "M90 58 L110 58 L134 66 L128 128 L72 128 L66 66 Z"],
  ["waist", "M72 128 L128 128 L127 150 L73 150 Z"],
  ["hip", "M73 150 L127 150 L134 196 L66 196 Z"],
  ["right arm", "M66 66 L56 72 L40 150 L54 154 L70 96 Z"],
  ["right wrist", "M40 150 L54 154 L44 190 L32 186 Z"],
  ["left arm", "M134 66 L144 72 L160 150 L146 154 L130 96 Z"],
  ["left wrist", "M160 150 L146 154 L156 190 L168 186 Z"],
  ["right leg", "M66 196 L99 196 L92 290 L72 290 Z"],
  ["right ankle", "M72 290 L92 290 L90 370 L76 370 Z"],
  ["left leg", "M134 196 L101 196 L108 290 L128 290 Z"],
  ["left ankle", "M128 290 L108 290 L110 370 L124 370 Z"],
];
/** Which side of the body a piece covers, by the words that say so. */
const COVERS = [["all round", ""], ["front", "front"], ["back", "back"]];

/** The figure for a piece: what it covers is chosen first, then where. */
function drawFigure(piece, cover, covers, act) {
  const place = (words) => act({ do: "place", piece: piece.name, words: [words, cover].join(" ").split(" ").filter(Boolean) });
  const now = (piece.place || "").split(" ");
  const is = (words) => piece.place !== null && words.split(" ").every((word) => now.includes(word));
  const areas = AREAS.map(([words, d]) => pressable(drawn("path", { class: "area", d, id: `area ${words}`,
    "aria-label": `${words}${cover ? `, ${cover}` : ""}`, "aria-pressed": String(is(words)) }, drawn("title", {}, words)),
  () => place(words)));
  const figure = drawn("svg", { id: "figure", viewBox: "20 0 160 376", role: "group",
    "aria-label": "The body from in front. Every part is a button that places the piece there." },
  drawn("ellipse", { class: "head", cx: 100, cy: 24, rx: 15, ry: 20 }), ...areas);
  const sides = COVERS.map(([words, value]) => element("button", { type: "button", id: `cover ${words}`,
    "aria-pressed": String(cover === value), click: () => covers(value) }, words));
  const none = element("button", { type: "button", id: "place-none",
    click: () => act({ do: "place", piece: piece.name, words: [] }) }, "By its seams");
  none.disabled = piece.place === null;
  return [element("p", { class: "soft" }, piece.place === null
    ? `Where ${piece.name} goes is worked out from its seams.` : `${piece.name} goes to: ${piece.place}.`),
  element("div", { class: "row", role: "group", "aria-label": "What the piece covers" }, ...sides, none), figure];
}
