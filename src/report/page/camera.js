// The camera: it turns round a point, straight ahead without perspective, as patterns are drawn.

const VIEWS = { front: 0, left: Math.PI / 2, back: Math.PI, right: -Math.PI / 2 };

/** A camera round a box of space. */
function cameraFor(low, high) {
  let center = [0, 0, 0];
  let size = 1;
  const camera = {
    turn: 0, tilt: 0, zoom: 1, target: center.slice(),
    /** Takes another box. What is looked at stays, unless it was the middle of the box. */
    frame(low, high) {
      const isMiddle = camera.target.every((x, k) => x === center[k]);
      center = low.map((x, k) => 0.5 * (x + high[k]));
      size = Math.max(...high.map((x, k) => x - low[k]));
      if (isMiddle) camera.target = center.slice();
    },
    /** Looks from a side. */
    view(name) {
      [camera.turn, camera.tilt, camera.zoom, camera.target] = [VIEWS[name], 0, 1, center.slice()];
    },
    /** Turns by angles. */
    spin(turn, tilt) {
      camera.turn += turn;
      camera.tilt = Math.min(Math.max(camera.tilt + tilt, -1.55), 1.55);
    },
    /** Zooms by a factor. */
    scale(factor) {
      camera.zoom = Math.min(Math.max(camera.zoom * factor, 0.3), 40);
    },
    /** Moves what is seen by shares of the picture's height. */
    move(x, y) {
      const [right, up] = camera.axes();
      const step = size * 1.1 / camera.zoom;
      camera.target = camera.target.map((t, k) => t - step * (x * right[k] + y * up[k]));
    },
    /** Directions to the right, up, and towards the eye. */
    axes() {
      const [s, c, t, u] = [Math.sin(camera.turn), Math.cos(camera.turn), Math.sin(camera.tilt), Math.cos(camera.tilt)];
      return [[c, 0, -s], [-s * t, u, -c * t], [s * u, t, c * u]];
    },
    /** The matrix (columns first) from space to the picture, for its width over its height. */
    matrix(aspect) {
      const [right, up, back] = camera.axes();
      const half = 0.55 * size / camera.zoom;
      const rows = [right.map((x) => x / (half * aspect)), up.map((x) => x / half), back.map((x) => -x / (4 * size))];
      const at = (row) => -row.reduce((sum, x, k) => sum + x * camera.target[k], 0);
      const out = [];
      for (let column = 0; column < 3; column++) out.push(rows[0][column], rows[1][column], rows[2][column], 0);
      return out.concat([at(rows[0]), at(rows[1]), at(rows[2]), 1]);
    },
    /** The ray through a place of the picture (−1 … 1 each way): a point far in front, and the direction. */
    ray(x, y, aspect) {
      const [right, up, back] = camera.axes();
      const half = 0.55 * size / camera.zoom;
      const from = camera.target.map((t, k) => t + half * (x * aspect * right[k] + y * up[k]) + 4 * size * back[k]);
      return { from, way: back.map((b) => -b) };
    },
  };
  camera.frame(low, high);
  return camera;
}

/** Lets a pointer, fingers, the wheel and keys move the camera. */
function steer(canvas, camera, changed, view) {
  const fingers = new Map();
  let apart = 0;
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (fingers.size === 2) apart = spread();
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId);
    if (!last) return;
    const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const height = canvas.clientHeight;
    if (fingers.size === 2) {
      const now = spread();
      if (apart > 0) camera.scale(now / apart);
      apart = now;
      camera.move(0.5 * dx / height, -0.5 * dy / height);
    } else if (event.shiftKey || event.buttons & 2) {
      camera.move(dx / height, -dy / height);
    } else {
      camera.spin(-4 * dx / height, 3 * dy / height);
    }
    changed();
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (event) => fingers.delete(event.pointerId));
  }
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.scale(Math.exp(-0.0015 * event.deltaY));
    changed();
  }, { passive: false });
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const sides = { f: "front", b: "back", l: "left", r: "right" };
  canvas.addEventListener("keydown", (event) => {
    const arrow = arrows[event.key];
    if (arrow && event.shiftKey) camera.move(0.05 * arrow[0], 0.05 * arrow[1]);
    else if (arrow) camera.spin(-0.12 * arrow[0], -0.12 * arrow[1]);
    else if (event.key === "+" || event.key === "=") camera.scale(1.15);
    else if (event.key === "-") camera.scale(1 / 1.15);
    else if (sides[event.key.toLowerCase()] && !event.ctrlKey && !event.metaKey) view(sides[event.key.toLowerCase()]);
    else return;
    event.preventDefault();
    changed();
  });
}
