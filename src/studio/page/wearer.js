// The wearer: the body, and measures that change it.

/** The body, and the wearer's measures. */
function wearerGroup(state, act) {
  const known = state.bodies.includes(state.body) || !state.body ? state.bodies : [state.body, ...state.bodies];
  const body = element("div", { class: "row", role: "group", "aria-label": "Body" }, "Body",
    ...known.map((name) => element("button", { type: "button", id: `body ${name}`,
      "aria-pressed": String(name === state.body), click: () => act({ do: "body", name }) }, name)));
  if (!state.body) return group("Wearer", body);
  const own = state.lengths.filter(({ path }) => path[0] === "body" && path.length === 2);
  const measure = ({ path: [, name], value }) => element("label", {}, plainWords(name),
    typing(`measure ${name}`, `${plainWords(name)} of the wearer`, value, (value) => act({ do: "measure", name, value })));
  const left = state.measures.filter((name) => !own.some(({ path }) => path[1] === name));
  const list = element("select", { id: "measure-name", "aria-label": "Measure to add" },
    ...left.map((name) => element("option", { value: name }, plainWords(name))));
  if (left.includes(chosenMeasure)) list.value = chosenMeasure;
  list.addEventListener("change", () => { chosenMeasure = list.value; });
  const value = element("input", { id: "measure-value", maxlength: "30", "aria-label": "Its length", placeholder: "mm" });
  value.addEventListener("change", () => value.value && act({ do: "measure", name: list.value, value: value.value })
    .then((refused) => refused || (find("measure-value").value = "")));
  return group("Wearer", body, ...own.map(measure), element("label", {}, list, value),
    own.length ? element("p", { class: "soft" }, "Empty a measure to be rid of it.") : null);
}

/** The measure that is offered next. */
let chosenMeasure = "waist";

const plainWords = (name) => name.replaceAll("_", " ");
