// The pattern: the pieces as cut, side by side.

/** Runs of edges of every piece, each with its seam and its vertices among all. */
function runsOf(cloth) {
  return cloth.pieces.flatMap((piece, k) => (piece.extras.edges || []).map((run) => ({
    piece: k, edge: run.edge, seam: run.seam, along: run.along.map((v) => v + cloth.first[k]),
  })));
}

/** Lines of the runs for drawing in space: those of one seam in one colour. */
function linesOf(cloth, runs) {
  const seams = [...new Set(runs.map((run) => run.seam).filter(Boolean))];
  const colors = new Uint8Array(4 * cloth.count);
  const indices = [];
  for (const run of runs) {
    const rgb = run.seam ? rgbOf(seams.indexOf(run.seam)) : [70, 70, 70];
    for (const v of run.along) colors.set([...rgb, 255], 4 * v);
    for (let i = 1; i < run.along.length; i++) indices.push(run.along[i - 1], run.along[i]);
  }
  return { seams, colors, indices: new Uint32Array(indices) };
}

/** A colour per number, well apart from its neighbours': red, green, blue. */
function rgbOf(number, light = 0.5, rich = 0.65) {
  const h = (number * 137.508) % 360;
  const part = (n) => {
    const k = (n + h / 30) % 12;
    return Math.round(255 * (light - rich * Math.min(light, 1 - light) * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
  };
  return [part(0), part(8), part(4)];
}

/** Places for the pieces: rows of about the canvas's shape. Offsets in mm, and the size of all. */
function layout(cloth, aspect) {
  const GAP = 30;
  const boxes = cloth.pieces.map(() => ({ low: [Infinity, Infinity], high: [-Infinity, -Infinity] }));
  for (let v = 0; v < cloth.count; v++) {
    const box = boxes[cloth.pieceOf[v]];
    for (const k of [0, 1]) {
      box.low[k] = Math.min(box.low[k], cloth.flat[2 * v + k]);
      box.high[k] = Math.max(box.high[k], cloth.flat[2 * v + k]);
    }
  }
  const size = (box, k) => box.high[k] - box.low[k];
  const area = boxes.reduce((sum, box) => sum + (size(box, 0) + GAP) * (size(box, 1) + GAP), 0);
  const width = Math.max(Math.sqrt(area * aspect * 1.25), ...boxes.map((box) => size(box, 0) + GAP));
  const order = boxes.map((_, k) => k).sort((a, b) => size(boxes[b], 1) - size(boxes[a], 1) || a - b);
  const offsets = [];
  let [x, y, row, right] = [0, 0, 0, 0];
  for (const k of order) {
    const box = boxes[k];
    if (x > 0 && x + size(box, 0) > width) [x, y, row] = [0, y + row + GAP, 0];
    offsets[k] = [x - box.low[0], y - box.low[1]];
    x += size(box, 0) + GAP;
    right = Math.max(right, x - GAP);
    row = Math.max(row, size(box, 1));
  }
  return { offsets, width: Math.max(right, 1), height: Math.max(y + row, 1) };
}

/**
 * The pen of a canvas that the processor draws. Where a program stands in for the graphics card, as in browsers without
 * a screen, that program would take seconds for it.
 */
const penOf = (canvas) => canvas.getContext("2d", { willReadFrequently: true });

/** The view of the pattern. */
function flatView(canvas, cloth, runs, seams) {
  const picture = document.createElement("canvas");
  const state = { colors: null, plan: null, scale: 1, mark: null, chosen: [] };
  const MARGIN = 14;

  const place = (v) => toScreen(cloth.pieceOf[v], cloth.flat[2 * v], cloth.flat[2 * v + 1]);
  function toScreen(piece, x, y) {
    const [dx, dy] = state.plan.offsets[piece];
    return [MARGIN + (x + dx) * state.scale, MARGIN + (y + dy) * state.scale];
  }

  /** Paints cloth and edges once. Marks come on top of it. */
  function render() {
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    for (const c of [canvas, picture]) [c.width, c.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    state.plan = layout(cloth, width / Math.max(height, 1));
    state.scale = Math.min((width - 2 * MARGIN) / state.plan.width, (height - 2 * MARGIN) / state.plan.height);
    const pen = penOf(picture);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    const places = placesOf(cloth, state.plan.offsets, MARGIN * ratio, state.scale * ratio);
    const image = pen.createImageData(picture.width, picture.height);
    fillTriangles(image, places, state.colors, cloth.triangles);
    pen.putImageData(image, 0, 0);
    const { color: ink, backgroundColor: paper } = getComputedStyle(document.body);
    for (const run of runs) {
      pen.strokeStyle = run.seam ? `rgb(${rgbOf(seams.indexOf(run.seam)).join(" ")})` : ink;
      pen.lineWidth = run.seam ? 2.2 : 1;
      stroke(pen, run.along);
    }
    pen.fillStyle = ink;
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "center";
    cloth.pieces.forEach((piece, k) => {
      const end = k + 1 < cloth.first.length ? cloth.first[k + 1] : cloth.count;
      let [x, y, n] = [0, 0, end - cloth.first[k]];
      for (let v = cloth.first[k]; v < end; v++) {
        x += cloth.flat[2 * v] / n;
        y += cloth.flat[2 * v + 1] / n;
      }
      pen.strokeStyle = paper;
      pen.lineWidth = 3;
      pen.strokeText(piece.name, ...toScreen(k, x, y));
      pen.fillText(piece.name, ...toScreen(k, x, y));
    });
    draw();
  }

  function stroke(pen, along) {
    pen.beginPath();
    along.forEach((v, k) => pen[k ? "lineTo" : "moveTo"](...place(v)));
    pen.stroke();
  }

  function draw() {
    const ratio = window.devicePixelRatio || 1;
    const pen = penOf(canvas);
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(picture, 0, 0);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.strokeStyle = "rgb(255 40 160)";
    pen.lineWidth = 4;
    state.chosen.forEach((along) => stroke(pen, along));
    if (state.mark) {
      pen.fillStyle = "rgb(255 40 160)";
      pen.beginPath();
      pen.arc(...toScreen(state.mark.piece, state.mark.x, state.mark.y), 6, 0, 2 * Math.PI);
      pen.fill();
    }
  }

  /** The triangle under a place of the picture, and the weights of its corners. */
  function pick(x, y) {
    for (let t = 0; t < cloth.triangles.length; t += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => place(cloth.triangles[t + k]));
      const cross = (p, q, r) => (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
      const whole = cross(a, b, c);
      const weights = [cross([x, y], b, c), cross(a, [x, y], c), cross(a, b, [x, y])].map((w) => w / whole);
      if (whole !== 0 && weights.every((w) => w >= -1e-6)) return { triangle: t / 3, weights };
    }
    return null;
  }

  return {
    pick, render,
    /** Shows another pattern once it is painted. */
    load(...shown) {
      [cloth, runs, seams] = shown;
      [state.mark, state.chosen] = [null, []];
    },
    /** Paints the cloth in these colours. */
    paint(colors) {
      state.colors = colors;
      render();
    },
    /** Marks a place of a piece, or none. */
    point(mark) {
      state.mark = mark;
      draw();
    },
    /** Shows lines in the accent colour. */
    choose(along) {
      state.chosen = along;
      draw();
    },
    /** Where a vertex is in the picture, in CSS pixels. */
    onScreen: place,
  };
}
