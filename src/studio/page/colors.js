// Colours of the fabrics, chosen in the page alone: neither the file nor any picture has them.

const chosenColors = new Map();

/** `#rrggbb` as linear light 0 … 1, as glTF has it. */
const linearOf = (text) => [1, 3, 5].map((k) => (parseInt(text.slice(k, k + 2), 16) / 255) ** 2.2);

/** Linear light as `#rrggbb`. */
const hexOf = (color) => `#${color.slice(0, 3).map((x) => displayed(x).toString(16).padStart(2, "0")).join("")}`;

/** Gives the pieces of a shape the colours that were chosen. */
function colored(shape) {
  for (const piece of shape.pieces) {
    const chosen = chosenColors.get(piece.extras.fabric);
    if (chosen) piece.color = [...linearOf(chosen), 1];
  }
  return shape;
}

/** The colour in which a fabric is shown. */
function colorOf(name) {
  const shown = cloth && cloth.pieces.find((piece) => piece.extras.fabric === name);
  return chosenColors.get(name) || (shown ? hexOf(shown.color) : "#bccbe0");
}

/** Lets the fields have the colours of the garment that is shown. */
function showColors(names) {
  for (const name of names) {
    const field = find(`color ${name}`);
    if (field) field.value = colorOf(name);
  }
}

/** A field for the colour of a fabric. */
function colorField(name) {
  const field = element("input", { type: "color", id: `color ${name}`, "aria-label": `Colour of ${name} in this page`,
    value: colorOf(name) });
  field.addEventListener("input", () => {
    chosenColors.set(name, field.value);
    if (cloth) {
      colored(cloth);
      take(map.id);
    }
  });
  return field;
}
