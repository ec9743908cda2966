// The panel beside the garment: what it is made of, seams, lengths.

const group = (title, ...children) => element("fieldset", {}, element("legend", {}, title), ...children);

/** A list to choose from. */
function choice(id, words, values, now, chosen) {
  const known = values.includes(now) ? values : [now || "", ...values];
  const list = element("select", { id }, ...known.map((value) => element("option", { value }, value || "–")));
  list.value = now || "";
  list.addEventListener("change", () => chosen(list.value));
  return element("label", {}, words, list);
}

/** A length to type. It is taken at Enter, or when the field is left. */
function typing(id, words, value, taken) {
  const field = element("input", { id, value, maxlength: "30", "aria-label": words });
  field.addEventListener("change", () => field.value !== value && taken(field.value));
  return field;
}

/** Size, fabrics and spacing. */
function garmentGroup(state, act) {
  const asDrawn = "as drawn";
  const size = state.sizes.length ? [choice("size", "Size", [asDrawn, ...state.sizes], state.size || asDrawn,
    (name) => act({ do: "size", name: name === asDrawn ? null : name }))] : [];
  const cloths = state.fabrics.map((fabric) => element("div", { class: "cloth-row" }, fabric.cloth === null
    ? element("span", {}, `Fabric ${fabric.name}: values of its own`)
    : choice(`fabric ${fabric.name}`, `Fabric ${fabric.name}`, state.cloths, fabric.cloth,
      (cloth) => act({ do: "fabric", name: fabric.name, cloth })), colorField(fabric.name)));
  const spacing = choice("spacing", "Mesh, mm (finer is slower)", state.spacings.map(String), String(state.spacing),
    (mm) => act({ do: "spacing", mm: Number(mm) }));
  const anew = element("button", { type: "button", id: "anew", click: () => act({ do: "anew" }),
    title: "From nothing, and not from where the garment before hung" }, "Sew anew");
  return group("Garment", ...size, ...cloths, spacing, anew);
}

/** Seams that may be meant. */
function offerGroup(state, act) {
  const row = (offer, k) => element("li", {}, element("div", {}, `${offer.sew.join(" + ")}  to  ${offer.to.join(" + ")}`),
    element("div", { class: "soft" }, offer.reason),
    element("button", { type: "button", id: `offer ${k}`, "data-offer": offer.name,
      "aria-label": `Sew ${offer.sew.join(" and ")} to ${offer.to.join(" and ")}`,
      click: () => act({ do: "accept", sew: offer.sew, to: offer.to }) }, "Sew this"));
  return state.suggestions.length ? group("Suggested seams", element("ul", {}, ...state.suggestions.map(row))) : null;
}

/** The seams of the file. */
function seamGroup(state, act) {
  const ease = (seam) => {
    const own = state.lengths.find(({ path }) => path.join("/") === `seams/${seam.name}/ease`);
    return typing(`ease ${seam.name}`, `Ease of seam ${seam.name}`, own ? own.value : "",
      (value) => act({ do: "ease", seam: seam.name, value }));
  };
  const row = (seam) => element("li", {}, element("div", {}, `${seam.name}: ${seam.sew.join(" + ")}  to  ${seam.to.join(" + ")}`),
    element("div", { class: "row" }, element("span", { class: "soft" }, "ease"), ease(seam),
      element("button", { type: "button", id: `unpick ${seam.name}`, "aria-label": `Unpick seam ${seam.name}`,
        click: () => act({ do: "unpick", seam: seam.name }) }, "Unpick")));
  return state.seams.length ? group("Seams", element("ul", {}, ...state.seams.map(row))) : null;
}

/** Lengths that the file has. */
function lengthGroup(state, act) {
  const elsewhere = (path) => ["alter", "body"].includes(path[0]) || (path[0] === "seams" && path[2] === "ease");
  const own = state.lengths.filter(({ path }) => !elsewhere(path));
  const row = ({ path, label, value }) => element("label", {}, label,
    typing(`length ${path.join("/")}`, label, value, (value) => act({ do: "length", path, value })));
  return own.length ? group("Lengths", ...own.map(row)) : null;
}

/** The whole panel. */
function drawPanel(state, selection, act, covers, change) {
  const piece = state.pieces.find((piece) => piece.name === selection.piece);
  const place = piece ? group(`Place of ${piece.name}`, ...drawFigure(piece, selection.cover, covers, act))
    : group("Place", element("p", { class: "soft" }, "Click a piece to place it on the body."));
  const groups = [wearerGroup(state, act), garmentGroup(state, act), offerGroup(state, act),
    alterGroup(state, selection, act, change), place, seamGroup(state, act), lengthGroup(state, act)];
  find("panel").replaceChildren(...groups.filter(Boolean));
}
