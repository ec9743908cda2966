// Triangles of the pattern as pixels.

/** Places of all vertices in the picture, in its pixels. `offsets` are those of `layout`, `scale` is pixels per mm. */
function placesOf(cloth, offsets, margin, scale) {
  const out = new Float64Array(2 * cloth.count);
  for (let v = 0; v < cloth.count; v++) {
    const offset = offsets[cloth.pieceOf[v]];
    out[2 * v] = margin + (cloth.flat[2 * v] + offset[0]) * scale;
    out[2 * v + 1] = margin + (cloth.flat[2 * v + 1] + offset[1]) * scale;
  }
  return out;
}

/**
 * Fills the pixels whose middles lie within a triangle. Colours of the corners (four bytes a vertex) go over into one
 * another.
 */
function fillTriangles(image, places, colors, triangles) {
  const { width, height, data } = image;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [triangles[t], triangles[t + 1], triangles[t + 2]];
    const ax = places[2 * a], ay = places[2 * a + 1], bx = places[2 * b] - ax, by = places[2 * b + 1] - ay;
    const cx = places[2 * c] - ax, cy = places[2 * c + 1] - ay;
    const whole = bx * cy - by * cx;
    if (whole === 0) continue;
    const top = Math.max(Math.ceil(ay + Math.min(0, by, cy) - 0.5), 0);
    const bottom = Math.min(Math.floor(ay + Math.max(0, by, cy) - 0.5), height - 1);
    const left = Math.max(Math.ceil(ax + Math.min(0, bx, cx) - 0.5), 0);
    const right = Math.min(Math.floor(ax + Math.max(0, bx, cx) - 0.5), width - 1);
    for (let row = top; row <= bottom; row++) for (let column = left; column <= right; column++) {
      const x = column + 0.5 - ax, y = row + 0.5 - ay;
      const second = (x * cy - y * cx) / whole, third = (bx * y - by * x) / whole;
      // Neighbours share the pixels of their edge: none is left out.
      if (second < -1e-9 || third < -1e-9 || second + third > 1 + 1e-9) continue;
      const at = 4 * (row * width + column);
      for (let k = 0; k < 3; k++) {
        const first = colors[4 * a + k];
        data[at + k] = first + second * (colors[4 * b + k] - first) + third * (colors[4 * c + k] - first);
      }
      data[at + 3] = 255;
    }
  }
}
