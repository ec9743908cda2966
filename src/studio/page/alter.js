// Alterations: those of the file, and a form for the next one.

/** Kinds of alterations that the form knows, in words. */
const KINDS = [
  ["take_in", "take in"], ["let_out", "let out"], ["lengthen", "lengthen"], ["shorten", "shorten"],
  ["fullness", "give fullness"], ["other", "in the file's words"],
];
/** Where along its edge a seam is altered: words, and positions. What lies between goes over smoothly. */
const WHERE = [["all along", ["0 %", "100 %"]], ["in the middle", ["50 %"]], ["at the start", ["0 %"]],
  ["at the end", ["100 %"]]];

/** A form that has not been filled in. Empty fields follow what is chosen on the board. */
const emptyForm = () => ({ kind: "take_in", seam: "", where: "0", by: "10 mm", pieces: null, at: "", edge: "", to: "",
  text: "" });

/** Whether a click on a piece says at which height the piece is made longer or shorter. */
const asksHeight = (form) => ["lengthen", "shorten"].includes(form.kind);

/** Seams and single edges that can be taken in, each as the file names it. */
function alterable(state) {
  const edges = state.pieces.flatMap((piece) => piece.edges.filter((edge) => !edge.fold && !edge.seams.length)
    .map((edge) => `${piece.name}.${edge.name}`));
  return [...state.seams.map((seam) => seam.name), ...edges];
}

/** The form with its empty fields filled in from what is chosen on the board. */
function formFor(form, state, selection) {
  const [first, second] = [selection.sides[0], selection.sides[1]].map((chain) => (chain || [])[0]);
  const all = state.pieces.flatMap((piece) => piece.edges.map((edge) => ({ name: `${piece.name}.${edge.name}`, edge })));
  const chosen = all.find(({ name }) => name === first);
  const seam = chosen && (chosen.edge.seams[0] || (chosen.edge.fold ? "" : first));
  const named = (name) => state.pieces.some((piece) => piece.name === name);
  const piece = selection.piece || (first || "").split(".")[0];
  const pieces = (form.pieces || [piece]).filter(named);
  const drawn = state.pieces.find((own) => own.name === pieces[0]);
  const middle = drawn && drawn.edges.length ? boxOf(drawn).middle[1].toFixed(0) : "";
  const options = alterable(state);
  const known = (name) => (all.some((own) => own.name === name) ? name : "");
  return { ...form, seam: [form.seam, seam, options[0]].find((name) => options.includes(name)) || "", pieces,
    at: form.at || middle, edge: known(form.edge) || first || "", to: known(form.to) || second || "" };
}

/** The alteration of a form, as the program reads it. */
function alterationOf(form) {
  if (form.kind === "other") return form.text;
  if (asksHeight(form)) return JSON.stringify({ [form.kind]: form.pieces, at: form.at, by: form.by });
  if (form.kind === "fullness") return JSON.stringify({ fullness: form.edge, to: form.to, by: form.by });
  const at = Object.fromEntries(WHERE[Number(form.where)][1].map((position) => [position, form.by]));
  return JSON.stringify({ [form.kind]: form.seam, at });
}

/** Fields of the form. `change` takes new values of them. */
function alterFields(form, state, change) {
  const pick = (id, words, values, key) => {
    const list = element("select", { id, change: () => change({ [key]: list.value }) },
      ...values.map(([value, text]) => element("option", { value }, text)));
    list.value = form[key];
    return element("label", {}, words, list);
  };
  const type = (id, words, key, holder = "") => {
    const field = element("input", { id, value: form[key], maxlength: "400", placeholder: holder });
    field.addEventListener("input", () => change({ [key]: field.value }, true));
    return element("label", {}, words, field);
  };
  const same = (names) => names.map((name) => [name, name]);
  const kind = pick("alter kind", "Kind", KINDS, "kind");
  if (form.kind === "other") {
    return [kind, type("alter text", "Alteration", "text", "{pivot: front.bust, to: front.shoulder@50 %}")];
  }
  const by = type("alter by", "By", "by");
  if (asksHeight(form)) {
    const box = (name) => {
      const field = element("input", { type: "checkbox", id: `alter piece ${name}` });
      field.checked = form.pieces.includes(name);
      field.addEventListener("change", () => change({ pieces: field.checked ? [...form.pieces, name]
        : form.pieces.filter((own) => own !== name) }));
      return element("label", { class: "tick" }, field, name);
    };
    return [kind, element("div", { class: "row", role: "group", "aria-label": "Pieces" },
      ...state.pieces.map((piece) => box(piece.name))),
    type("alter at", "At height y", "at"), by,
    element("p", { class: "soft" }, "Click each piece at the height of the slash. Pieces that are sewn to its sides need one, too.")];
  }
  if (form.kind === "fullness") {
    const edges = state.pieces.flatMap((piece) => piece.edges.map((edge) => `${piece.name}.${edge.name}`));
    const named = [["", "click an edge"], ...same(edges)];
    return [kind, pick("alter edge", "Edge", named, "edge"), pick("alter to", "Slashed to the edge", named, "to"), by];
  }
  return [kind, pick("alter seam", "Seam or edge", same(alterable(state)), "seam"),
    pick("alter where", "Where", WHERE.map(([words], k) => [String(k), words]), "where"), by];
}

/** Alterations of the file, each with its lengths, and the form. */
function alterGroup(state, selection, act, change) {
  const form = formFor(selection.alter, state, selection);
  const lengths = (k) => state.lengths.filter(({ path }) => path[0] === "alter" && path[1] === String(k));
  const row = (words, k) => element("li", {}, element("div", {}, `${k + 1}. ${words}`),
    element("div", { class: "row" }, ...lengths(k).flatMap(({ path, label, value }) => [
      element("span", { class: "soft" }, path.slice(2).join(" ")),
      typing(`length ${path.join("/")}`, label, value, (value) => act({ do: "length", path, value }))]),
    element("button", { type: "button", id: `unalter ${k}`, "aria-label": `Take back alteration ${k + 1}, ${words}`,
      click: () => act({ do: "unalter", number: k }) }, "Take back")));
  const list = state.alterations.length ? [element("ul", {}, ...state.alterations.map(row))] : [];
  const go = element("button", { type: "button", id: "alter",
    click: () => act({ do: "alter", alteration: alterationOf(formFor(selection.alter, state, selection)) }) }, "Alter");
  return group("Alterations", ...list, ...alterFields(form, state, change), go);
}
