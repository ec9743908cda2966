// The chosen edges: two sides of a seam to come, and what can be done with them.

/** An edge chosen: it begins a side, or goes on with the last one. Chosen again, it is left out. */
function choosing(sides, edge, onward) {
  const held = sides.map((chain) => chain.filter((own) => own !== edge)).filter((chain) => chain.length);
  if (held.flat().length < sides.flat().length) return held;
  if (onward && sides.length) return [...sides.slice(0, -1), [...sides[sides.length - 1], edge]];
  return sides.length < 2 ? [...sides, [edge]] : [[edge]];
}

/** Shows the chosen edges and the acts that they allow. */
function drawChosen(state, selection, act, clear) {
  const box = find("chosen");
  const { sides } = selection;
  const all = sides.flat();
  const edges = new Map(state.pieces.flatMap((piece) => piece.edges.map((edge) => [`${piece.name}.${edge.name}`, edge])));
  const long = (chain) => chain.reduce((sum, edge) => sum + (edges.get(edge) || { length: 0 }).length, 0);
  const said = (chain) => `${chain.join(" + ")} (${long(chain).toFixed(0)} mm)`;
  const button = (id, words, on, click) => {
    const out = element("button", { type: "button", id, click }, words);
    out.disabled = !on;
    return out;
  };
  const piece = all.length ? state.pieces.find((piece) => all[0].startsWith(`${piece.name}.`)) : null;
  const known = all.map((edge) => edges.get(edge)).filter(Boolean);
  const name = element("input", { id: "edge-name", "aria-label": `New name of ${all[0] || "the edge"}`, maxlength: "60",
    placeholder: "new name" });
  const naming = () => act({ do: "name", edge: all[0], name: name.value });
  name.addEventListener("keydown", (event) => event.key === "Enter" && naming());
  const isOpen = known.length && known.every((edge) => !edge.seams.length && !edge.fold);
  box.replaceChildren(
    element("span", {}, sides.length ? sides.map(said).join("  to  ") : "No edge is chosen."),
    button("sew", "Sew", sides.length === 2, () => act({ do: "sew", sew: sides[0], to: sides[1] })),
    ...(piece && sides.length === 1 && piece.cut === "as a pair"
      ? [button("mirror", "Sew to the other half", isOpen, () => act({ do: "sew", sew: sides[0], to: ["mirror"] }))] : []),
    button("free", "Set free", isOpen && known.some((edge) => !edge.free), () => act({ do: "free", edges: all })),
    button("unfree", "Not free", isOpen && known.every((edge) => edge.free), () => act({ do: "unfree", edges: all })),
    ...(all.length === 1 ? [name, button("name", "Name it", true, naming)] : []),
    button("clear", "Choose none", all.length > 0, clear));
}
