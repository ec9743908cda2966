// Two views of one garment, linked. What they show can be replaced.

/** Milliseconds after which edges become smooth, so that the page has loaded before. */
const SMOOTH_AFTER = 50;

const find = (id) => document.getElementById(id);
let [report, cloth, body, runs, lines, maps, map] = [null, null, null, [], null, [], null];
let [space, flat] = [null, null];
/** The map that was chosen, which the next garment may have again. */
let wanted = "fabric";

/** The piece, positions and values at a place of a triangle. */
function placeAt(hit) {
  const corners = [0, 1, 2].map((k) => cloth.triangles[3 * hit.triangle + k]);
  const mean = (values, size, k) => corners.reduce((sum, v, i) => sum + hit.weights[i] * values[size * v + k], 0);
  const piece = cloth.pieceOf[corners[0]];
  const at = [0, 1].map((k) => mean(cloth.flat, 2, k));
  let near = { far: Infinity };
  for (const run of runs) {
    if (run.piece !== piece) continue;
    for (let i = 1; i < run.along.length; i++) {
      const [p, q] = [run.along[i - 1], run.along[i]].map((v) => [cloth.flat[2 * v], cloth.flat[2 * v + 1]]);
      const [dx, dy] = [q[0] - p[0], q[1] - p[1]];
      const long = dx * dx + dy * dy || 1;
      const share = Math.min(Math.max(((at[0] - p[0]) * dx + (at[1] - p[1]) * dy) / long, 0), 1);
      const far = Math.hypot(at[0] - p[0] - share * dx, at[1] - p[1] - share * dy);
      if (far < near.far) near = { far, run };
    }
  }
  return {
    piece, flat: at, near, vertex: corners[hit.weights.indexOf(Math.max(...hit.weights))],
    space: [0, 1, 2].map((k) => mean(cloth.positions, 3, k)),
    value: (name) => mean(cloth.values[name], 1, 0),
  };
}

/** Says and marks in both views what is pointed at. */
function point(hit) {
  if (!hit) {
    if (space) space.point(null);
    flat.point(null);
    return;
  }
  const place = placeAt(hit);
  const words = [`piece ${cloth.pieces[place.piece].name}`, `at ${place.flat.map((x) => x.toFixed(0)).join(", ")} mm`];
  if (place.near.run) {
    const { edge, seam } = place.near.run;
    words.push(`${place.near.far.toFixed(0)} mm from its edge ${edge}${seam ? ` (seam ${seam})` : " (not sewn)"}`);
  }
  for (const each of maps) if (!each.flat) words.push(each.words(place.value(each.id), place.vertex));
  find("pointed").textContent = words.join(" · ");
  if (space) space.point(place.space);
  flat.point({ piece: place.piece, x: place.flat[0], y: place.flat[1] });
}

/** Shows a piece, a seam or a height. */
function show(what) {
  const wanted = runs.filter((run) => (what.piece ? cloth.pieces[run.piece].name === what.piece : false) ||
    (what.seam ? run.seam === what.seam : false));
  const indices = wanted.flatMap((run) => run.along.slice(1).flatMap((v, i) => [run.along[i], v]));
  flat.choose(wanted.map((run) => run.along));
  if (space) {
    space.choose(indices.length ? indices : null);
    if (typeof what.height === "number") {
      space.camera.target[1] = what.height / 1000;
      space.camera.zoom = Math.max(space.camera.zoom, 3);
      space.redraw();
    }
  }
  find("views").scrollIntoView({ behavior: "smooth", block: "start" });
}

/** The legend of a map. */
function legend() {
  const box = find("legend");
  box.replaceChildren();
  if (map.flat) {
    const seen = new Set();
    for (const piece of cloth.pieces) {
      const rgb = piece.color.slice(0, 3).map(displayed).join(" ");
      if (seen.has(rgb)) continue;
      seen.add(rgb);
      const chip = element("span", { class: "chip" });
      chip.style.background = `rgb(${rgb})`;
      box.append(chip, element("span", {}, piece.extras.fabric || "cloth"));
    }
    return;
  }
  const label = `${map.name}: ${map.low} to ${map.high}`;
  const scale = element("span", { class: "scale", role: "img", "aria-label": label });
  scale.style.background = `linear-gradient(to right, ${map.stops.map((c) => `rgb(${c.join(" ")})`).join(", ")})`;
  const words = [map.name, map.low, map.high].map((text) => element("span", {}, text));
  box.append(words[0], words[1], scale, words[2]);
}

/** Takes a map by its name. */
function take(id) {
  map = maps.find((each) => each.id === id) || maps[0];
  find("map").value = map.id;
  const colors = colorsOf(map, cloth);
  if (space) space.paint(colors, !map.flat);
  flat.paint(colors);
  legend();
}

/** Reports what is under a pointer in a view. */
function follow(canvas, view) {
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons) return;
    const box = canvas.getBoundingClientRect();
    point(view.pick(event.clientX - box.left - canvas.clientLeft, event.clientY - box.top - canvas.clientTop));
  });
  canvas.addEventListener("pointerleave", () => point(null));
}

find("theme").addEventListener("click", () => {
  const dark = document.documentElement.dataset.theme === "dark" ||
    (!document.documentElement.dataset.theme && matchMedia("(prefers-color-scheme: dark)").matches);
  document.documentElement.dataset.theme = dark ? "light" : "dark";
  if (flat) flat.render();
});

/** Lets pointers, keys and buttons move the views. Once for a page. */
function install() {
  find("map").addEventListener("change", (event) => {
    wanted = event.target.value;
    take(wanted);
  });
  if (space) {
    const view = (name) => {
      space.camera.view(name);
      space.redraw();
    };
    steer(find("space"), space.camera, space.redraw, view);
    for (const button of document.querySelectorAll("[data-view]")) {
      button.addEventListener("click", () => view(button.dataset.view));
    }
    for (const [id, key] of [["cut", "section"], ["skin", "skin"]]) {
      find(id).addEventListener("click", (event) => {
        space.state[key] = !space.state[key];
        event.currentTarget.setAttribute("aria-pressed", String(space.state[key]));
        space.redraw();
      });
    }
    follow(find("space"), space);
  } else {
    find("space").replaceWith(element("p", {}, "This browser has no WebGL 2: the garment cannot be shown in space."));
  }
  follow(find("flat"), flat);
  addEventListener("resize", () => {
    flat.render();
    if (space) space.redraw();
  });
}

/**
 * Shows a garment, in the place of the one before: its report, or null while that is not known, its cloth and its body
 * as of `joined`.
 */
function load(shown) {
  ({ report, cloth, body } = shown);
  runs = runsOf(cloth);
  lines = linesOf(cloth, runs);
  maps = mapsOf(cloth, report || {});
  if (flat) {
    if (space) space.load(cloth, body, lines);
    flat.load(cloth, runs, lines.seams);
  } else {
    space = spaceView(find("space"), cloth, body, lines);
    flat = flatView(find("flat"), cloth, runs, lines.seams);
    install();
  }
  find("map").replaceChildren(...maps.map((each) => element("option", { value: each.id }, each.name)));
  take(wanted);
  if (space) {
    space.draw();
    // A frame later the page is there, and edges become smooth.
    requestAnimationFrame(() => setTimeout(space.smooth, SMOOTH_AFTER));
  }
}

// For tests of the page: what it shows, and where.
window.toile = {
  get cloth() { return cloth; },
  get body() { return body; },
  get maps() { return maps; },
  get space() { return space; },
  get flat() { return flat; },
  take, show, colorsOf,
};
