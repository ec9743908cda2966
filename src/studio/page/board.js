// The board: the pieces as drawn, with edges that can be chosen.

/** Draws the pieces of a state. `choose` is told of edges, `pick` of pieces. */
function drawBoard(state, selection, choose, pick) {
  const svg = find("board");
  const seams = state.seams.map((seam) => seam.name);
  const boxes = state.pieces.map(boxOf);
  const { width, height } = svg.getBoundingClientRect();
  const plan = rows(boxes, width / Math.max(height, 1));
  // Millimetres of a pixel, for letters of one size.
  const scale = Math.max(plan.width / Math.max(width, 1), plan.height / Math.max(height, 1));
  svg.setAttribute("viewBox", `-20 -20 ${plan.width + 40} ${plan.height + 40}`);
  svg.replaceChildren(...state.pieces.map((piece, k) => {
    const [x, y] = plan.offsets[k];
    const outline = piece.edges.map((edge, k) => (k ? edge.path.replace(/^M[^A-Za-z]*/, "") : edge.path)).join(" ");
    const cloth = pressable(drawn("path", { class: "cloth", d: outline, id: `piece ${piece.name}`,
      "aria-label": `piece ${piece.name}, cut ${piece.cut}${piece.place ? `, at ${piece.place}` : ""}` }),
    (event) => pick(piece.name, heightOf(event)));
    const name = drawn("text", { class: "name", x: boxes[k].middle[0], y: boxes[k].middle[1], "font-size": 15 * scale });
    name.textContent = piece.name;
    return drawn("g", { class: "piece", transform: `translate(${x} ${y})`,
      "aria-current": String(piece.name === selection.piece) }, cloth,
    ...piece.lines.map((d) => drawn("path", { class: "inner", d })), ...slash(piece, boxes[k], state, selection), name,
    ...piece.edges.map((edge) => drawnEdge(piece, edge, seams, selection, choose, scale)));
  }));
}

/** Where on its piece a click was, mm down the drawing. Keys say none. */
function heightOf(event) {
  if (typeof event.clientY !== "number" || event.type !== "click") return null;
  return new DOMPoint(event.clientX, event.clientY).matrixTransform(event.target.getScreenCTM().inverse()).y;
}

/** The line across a piece where the form for an alteration slashes it. */
function slash(piece, box, state, selection) {
  const form = formFor(selection.alter, state, selection);
  const y = parseFloat(form.at);
  if (!asksHeight(form) || !form.pieces.includes(piece.name) || !(y >= box.low[1] && y <= box.high[1])) return [];
  return [drawn("path", { class: "slash", d: `M ${box.low[0] - 15} ${y} L ${box.high[0] + 15} ${y}` })];
}

/** The words of an edge's state. */
function edgeSaid(edge) {
  if (edge.fold) return "on the fold";
  if (edge.seams.length) return `sewn in ${edge.seams.join(", ")}`;
  return edge.free ? "free" : "neither sewn nor free";
}

function drawnEdge(piece, edge, seams, selection, choose, scale) {
  const full = `${piece.name}.${edge.name}`;
  const side = selection.sides.findIndex((chain) => chain.includes(full));
  const kind = edge.fold ? "fold" : edge.seams.length ? "sewn" : edge.free ? "free" : "open";
  const line = drawn("path", { class: "line", d: edge.path });
  if (kind === "sewn") line.style.stroke = `rgb(${rgbOf(seams.indexOf(edge.seams[0])).join(" ")})`;
  if (side >= 0) line.style.stroke = "";
  const [x, y] = edge.middle;
  const name = drawn("text", { x, y, "font-size": 11 * scale });
  name.textContent = edge.name;
  const group = drawn("g", { class: `edge ${kind} ${["first", "second"][side] || ""}`, id: `edge ${full}`,
    "aria-pressed": String(side >= 0),
    "aria-label": `edge ${full}, ${edge.length.toFixed(0)} mm, ${edgeSaid(edge)}` },
  line, drawn("path", { class: "hit", d: edge.path }), name);
  return pressable(group, (event) => choose(full, event.shiftKey));
}

/** The box round a piece, from points along its edges. */
function boxOf(piece) {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  const probe = drawn("path");
  for (const edge of piece.edges) {
    probe.setAttribute("d", edge.path);
    const length = probe.getTotalLength();
    for (let k = 0; k <= 12; k++) {
      const { x, y } = probe.getPointAtLength(length * k / 12);
      [low[0], low[1]] = [Math.min(low[0], x), Math.min(low[1], y)];
      [high[0], high[1]] = [Math.max(high[0], x), Math.max(high[1], y)];
    }
  }
  if (!piece.edges.length) [low[0], low[1], high[0], high[1]] = [0, 0, 1, 1];
  return { low, high, middle: [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])] };
}

/** Places for boxes in rows of about the board's shape, in their order. */
function rows(boxes, aspect) {
  const GAP = 60;
  const size = (box, k) => box.high[k] - box.low[k];
  const area = boxes.reduce((sum, box) => sum + (size(box, 0) + GAP) * (size(box, 1) + GAP), 0);
  const wide = Math.max(Math.sqrt(area * aspect * 1.2), ...boxes.map((box) => size(box, 0)), 1);
  const offsets = [];
  let [x, y, row, right] = [0, 0, 0, 1];
  for (const box of boxes) {
    if (x > 0 && x + size(box, 0) > wide) [x, y, row] = [0, y + row + GAP, 0];
    offsets.push([x - box.low[0], y - box.low[1]]);
    x += size(box, 0) + GAP;
    right = Math.max(right, x - GAP);
    row = Math.max(row, size(box, 1));
  }
  return { offsets, width: right, height: Math.max(y + row, 1) };
}
