// The garment on its body, drawn with WebGL 2.

const VERTEX = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 color;
uniform mat4 matrix;
out vec3 direction;
out vec3 place;
out vec4 tint;
void main() {
  gl_Position = matrix * vec4(position, 1.0);
  gl_PointSize = 13.0;
  direction = normal;
  place = position;
  tint = color;
}`;

// Light comes from the eye, a little from above. In a map the right side of the cloth has the legend's colour. The wrong
// side is darker in any case.
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 direction;
in vec3 place;
in vec4 tint;
uniform vec3 eye;
uniform vec4 cut;
uniform float lit;
uniform float wrong;
out vec4 color;
void main() {
  if (dot(cut.xyz, place) > cut.w) discard;
  float side = gl_FrontFacing ? 1.0 : wrong;
  vec3 light = normalize(eye + vec3(0.0, 0.35, 0.0));
  float bright = mix(1.0, 0.42 + 0.58 * abs(dot(normalize(direction), light)), lit);
  color = vec4(tint.rgb * bright * side, 1.0);
}`;

function program(gl) {
  const shader = (kind, text) => {
    const made = gl.createShader(kind);
    gl.shaderSource(made, text);
    gl.compileShader(made);
    return made;
  };
  const made = gl.createProgram();
  const shaders = [shader(gl.VERTEX_SHADER, VERTEX), shader(gl.FRAGMENT_SHADER, FRAGMENT)];
  shaders.forEach((each) => gl.attachShader(made, each));
  gl.linkProgram(made);
  // One question waits for all three.
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) {
    throw new Error([gl.getProgramInfoLog(made), ...shaders.map((each) => gl.getShaderInfoLog(each))].join("\n"));
  }
  return made;
}

/** Buffers of a shape: places, directions, colours per vertex, and the triangles or lines between them. */
function shape(gl, positions, normals, colors, indices) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  const buffers = [];
  const attribute = (location, data, size, type, normalized) => {
    const buffer = gl.createBuffer();
    buffers.push(buffer);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(location);
    gl.vertexAttribPointer(location, size, type, normalized, 0, 0);
    return buffer;
  };
  attribute(0, positions, 3, gl.FLOAT, false);
  attribute(1, normals, 3, gl.FLOAT, false);
  const tint = attribute(2, colors, 4, gl.UNSIGNED_BYTE, true);
  const elements = gl.createBuffer();
  buffers.push(elements);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, elements);
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
  gl.bindVertexArray(null);
  return { array, tint, count: indices.length, buffers };
}

/** Gives back the memory of a shape. */
function release(gl, what) {
  if (!what) return;
  what.buffers.forEach((buffer) => gl.deleteBuffer(buffer));
  gl.deleteVertexArray(what.array);
}

/** Normals of a mesh that has none: the sums of its triangles', by area. */
function normalsOf(positions, triangles) {
  const out = new Float32Array(positions.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1];
    const uz = positions[b + 2] - positions[a + 2], vx = positions[c] - positions[a];
    const vy = positions[c + 1] - positions[a + 1], vz = positions[c + 2] - positions[a + 2];
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    for (let k = 0; k < 3; k++) {
      const o = 3 * triangles[t + k];
      out[o] += nx;
      out[o + 1] += ny;
      out[o + 2] += nz;
    }
  }
  return out;
}

const filled = (count, rgb) => {
  const out = new Uint8Array(4 * count);
  for (let v = 0; v < count; v++) out.set([...rgb, 255], 4 * v);
  return out;
};

/**
 * Smooth edges: the picture is drawn with several samples a pixel into buffers beside the canvas, and copied. Not so at
 * first: where a program stands in for the graphics card, the buffers take it a third of a second.
 */
function smoothing(gl) {
  const SAMPLES = 4;
  const held = { on: false, buffer: null, parts: [], size: [0, 0] };
  function make() {
    const size = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    if (held.buffer && size.every((x, k) => x === held.size[k])) return;
    if (!held.buffer) [held.buffer, held.parts] = [gl.createFramebuffer(), [0, 1].map(() => gl.createRenderbuffer())];
    held.size = size;
    gl.bindFramebuffer(gl.FRAMEBUFFER, held.buffer);
    const places = [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]];
    places.forEach(([format, place], k) => {
      gl.bindRenderbuffer(gl.RENDERBUFFER, held.parts[k]);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, SAMPLES, format, ...size);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, held.parts[k]);
    });
  }
  return {
    /** Turns it on. */
    start() {
      held.on = true;
    },
    /** Before a picture. */
    begin() {
      if (held.on) make();
      gl.bindFramebuffer(gl.FRAMEBUFFER, held.on ? held.buffer : null);
    },
    /** After it. */
    end() {
      if (!held.on) return;
      const [width, height] = held.size;
      gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
      gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    },
  };
}

/** The view in space. `cloth` and `body` as of `joined`, `lines` as of `linesOf`. */
function spaceView(canvas, cloth, body, lines) {
  // Its size is right before it has a picture, which would be made twice.
  fitted();
  const gl = canvas.getContext("webgl2", { antialias: false, preserveDrawingBuffer: true });
  if (!gl) return null;
  const painted = program(gl);
  const uniform = (name) => gl.getUniformLocation(painted, name);
  const [matrix, eye, cut, lit, wrong] = ["matrix", "eye", "cut", "lit", "wrong"].map(uniform);
  // What is pointed at: one point, and a chosen piece's or seam's lines.
  const mark = { at: null, shape: shape(gl, new Float32Array(3), new Float32Array([0, 0, 1]),
    new Uint8Array([255, 40, 160, 255]), new Uint32Array([0])) };
  const chosen = { shape: null };
  let [garment, skin, seams, middle] = [null, null, null, 0];
  const camera = cameraFor([0, 0, 0], [1, 1, 1]);
  const state = { flat: false, skin: true, section: false };

  /** Takes what is to be shown, and frees what was shown before. */
  function fill() {
    [garment, skin, seams, chosen.shape].forEach((what) => release(gl, what));
    chosen.shape = null;
    garment = shape(gl, cloth.positions, cloth.normals, filled(cloth.count, [200, 200, 200]), cloth.triangles);
    skin = body && shape(gl, body.positions, normalsOf(body.positions, body.triangles),
      filled(body.count, [188, 180, 172]), body.triangles);
    seams = shape(gl, cloth.positions, cloth.normals, lines.colors, lines.indices);
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (const { positions } of body ? [cloth, body] : [cloth]) for (let i = 0; i < positions.length; i++) {
      low[i % 3] = Math.min(low[i % 3], positions[i]);
      high[i % 3] = Math.max(high[i % 3], positions[i]);
    }
    camera.frame(low, high);
    middle = 0.5 * (low[0] + high[0]);
  }
  fill();
  const aspect = () => canvas.clientWidth / Math.max(canvas.clientHeight, 1);

  /** Gives the canvas the pixels that it has on the screen. */
  function fitted() {
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio].map(Math.round);
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
  }

  const smooth = smoothing(gl);

  function draw() {
    cancelAnimationFrame(waiting);
    waiting = 0;
    fitted();
    smooth.begin();
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(painted);
    gl.uniformMatrix4fv(matrix, false, camera.matrix(aspect()));
    gl.uniform3fv(eye, camera.axes()[2]);
    gl.uniform4fv(cut, state.section ? [1, 0, 0, middle] : [0, 0, 0, 1]);
    const paint = (what, mode, light, side) => {
      gl.uniform1f(lit, light);
      gl.uniform1f(wrong, side);
      gl.bindVertexArray(what.array);
      gl.drawElements(mode, what.count, gl.UNSIGNED_INT, 0);
    };
    // Lines and cloth are drawn a little nearer than what they lie on.
    gl.enable(gl.POLYGON_OFFSET_FILL);
    if (skin && state.skin) {
      // Seen from within, the skin is in front of the cloth.
      gl.polygonOffset(state.section ? 1 : 2, state.section ? 1 : 2);
      paint(skin, gl.TRIANGLES, 1, 1);
    }
    gl.polygonOffset(1, 1);
    paint(garment, gl.TRIANGLES, state.flat ? 0 : 1, 0.55);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    paint(seams, gl.LINES, 0, 1);
    if (chosen.shape) paint(chosen.shape, gl.LINES, 0, 1);
    if (mark.at) {
      gl.disable(gl.DEPTH_TEST);
      paint(mark.shape, gl.POINTS, 0, 1);
    }
    gl.bindVertexArray(null);
    smooth.end();
  }

  /** The number of the frame in which it is drawn next, or 0. */
  let waiting = 0;
  const redraw = () => {
    if (!waiting) waiting = requestAnimationFrame(draw);
  };

  /** What lies under a place of the picture, in CSS pixels: the triangle and the weights of its corners. */
  function pick(x, y) {
    const place = [2 * x / canvas.clientWidth - 1, 1 - 2 * y / canvas.clientHeight];
    const ray = camera.ray(place[0], place[1], aspect());
    const keep = state.section ? middle : Infinity;
    const hit = nearestHit(ray, cloth, keep);
    const skinHit = body && state.skin ? nearestHit(ray, body, keep) : null;
    return hit && (!skinHit || hit.far <= skinHit.far + 1e-3) ? hit : null;
  }

  return {
    camera, state, draw, redraw, pick,
    /** Draws it with smooth edges from the next frame on. */
    smooth() {
      smooth.start();
      redraw();
    },
    /** Shows another garment. The camera stays where it is, as far as the new one is about as large. */
    load(...shown) {
      [cloth, body, lines] = shown;
      mark.at = null;
      fill();
    },
    /** Paints the cloth in these colours, those of a legend or lit ones. */
    paint(colors, isMap) {
      state.flat = isMap;
      gl.bindBuffer(gl.ARRAY_BUFFER, garment.tint);
      gl.bufferData(gl.ARRAY_BUFFER, colors, gl.DYNAMIC_DRAW);
      redraw();
    },
    /** Marks a point, or none. */
    point(at) {
      mark.at = at;
      if (at) {
        release(gl, mark.shape);
        mark.shape = shape(gl, new Float32Array(at), new Float32Array([0, 0, 1]),
          new Uint8Array([255, 40, 160, 255]), new Uint32Array([0]));
      }
      redraw();
    },
    /** Shows lines in the accent colour, or none. */
    choose(indices) {
      release(gl, chosen.shape);
      chosen.shape = indices && shape(gl, cloth.positions, cloth.normals, filled(cloth.count, [255, 40, 160]),
        new Uint32Array(indices));
      redraw();
    },
    /** Where a point of space is in the picture, in CSS pixels. */
    onScreen(at) {
      const m = camera.matrix(aspect());
      const [x, y] = [0, 1].map((row) => m[row] * at[0] + m[row + 4] * at[1] + m[row + 8] * at[2] + m[row + 12]);
      return [0.5 * (x + 1) * canvas.clientWidth, 0.5 * (1 - y) * canvas.clientHeight];
    },
  };
}

/** The first triangle that a ray meets, where x is no more than `keep`. Plain numbers: it runs at every motion. */
function nearestHit(ray, mesh, keep) {
  const { positions, triangles } = mesh;
  const ox = ray.from[0], oy = ray.from[1], oz = ray.from[2];
  const dx = ray.way[0], dy = ray.way[1], dz = ray.way[2];
  let best = null;
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ax = positions[a], ay = positions[a + 1], az = positions[a + 2];
    const ux = positions[b] - ax, uy = positions[b + 1] - ay, uz = positions[b + 2] - az;
    const vx = positions[c] - ax, vy = positions[c + 1] - ay, vz = positions[c + 2] - az;
    const px = dy * vz - dz * vy, py = dz * vx - dx * vz, pz = dx * vy - dy * vx;
    const volume = ux * px + uy * py + uz * pz;
    if (volume === 0) continue;
    const sx = ox - ax, sy = oy - ay, sz = oz - az;
    const second = (sx * px + sy * py + sz * pz) / volume;
    if (second < 0 || second > 1) continue;
    const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
    const third = (dx * qx + dy * qy + dz * qz) / volume;
    if (third < 0 || second + third > 1) continue;
    const far = (vx * qx + vy * qy + vz * qz) / volume;
    if (far > 0 && (!best || far < best.far) && ox + far * dx <= keep) {
      best = { far, triangle: t / 3, weights: [1 - second - third, second, third] };
    }
  }
  return best;
}
