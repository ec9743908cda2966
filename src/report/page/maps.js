// Maps: what colours mean, and the value at a place.

/** Stops of the scales: red, green, blue, 0 … 255. */
const SCALES = {
  // From compressed over unstrained to stretched.
  both: [[33, 80, 170], [150, 190, 230], [238, 238, 232], [240, 170, 120], [178, 30, 40]],
  // From nothing to much, told apart also by those who confuse red and green.
  rising: [[60, 25, 90], [50, 90, 150], [40, 150, 140], [130, 200, 80], [250, 230, 60]],
  // Comfortable, tight, too tight.
  bands: [[70, 130, 200], [120, 180, 210], [240, 225, 150], [235, 150, 60], [180, 25, 35]],
};

/** Colour of a share 0 … 1 on a scale. */
function colorOn(stops, share) {
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const k = Math.min(Math.floor(at), stops.length - 2);
  return [0, 1, 2].map((c) => Math.round(stops[k][c] + (stops[k + 1][c] - stops[k][c]) * (at - k)));
}

/** Linear light as it is stored in glTF, as a display shows it. */
const displayed = (x) => Math.round(255 * Math.min(Math.max(x, 0), 1) ** (1 / 2.2));

/** The value below which a share of all values lies. */
function quantile(values, share) {
  const sorted = Float32Array.from(values).sort();
  return sorted.length ? sorted[Math.floor(share * (sorted.length - 1))] : 0;
}

/** The maps that the data has. Each gives a share 0 … 1 for the colour, and words for the pointer. */
function mapsOf(cloth, report) {
  const values = cloth.values;
  const gives = (v, k) => (cloth.pieces[cloth.pieceOf[v]].extras.gives || [0.1, 0.1])[k];
  const fixed = (x, digits) => x.toFixed(digits).replace("-", "−");
  const maps = [{ id: "fabric", name: "Fabric", flat: true }];
  const strain = (id, name, thread, k) => ({
    id, name, stops: SCALES.both, low: "−100 %", high: "+100 % of the fabric's limit",
    share: (v) => 0.5 + 0.5 * (values[id][v] / gives(v, k)),
    words: (x, v) => `${thread} ${fixed(100 * x, 2)} % (${fixed(100 * x / gives(v, k), 0)} % of its limit)`,
  });
  if (values._STRAIN_WARP) maps.push(strain("_STRAIN_WARP", "Strain, warp", "warp", 0));
  if (values._STRAIN_WEFT) maps.push(strain("_STRAIN_WEFT", "Strain, weft", "weft", 1));
  const rising = (id, name, unit, digits, least, stops = SCALES.rising) => {
    if (!values[id]) return;
    const top = Math.max(least, quantile(values[id], 0.99));
    maps.push({
      id, name, stops, low: "0", high: `${fixed(top, digits)} ${unit} and more`,
      share: (v) => values[id][v] / top,
      words: (x) => `${name.toLowerCase()} ${fixed(x, digits)} ${unit}`,
    });
  };
  rising("_SHEAR", "Shear", "°", 1, 5);
  rising("_EASE", "Ease", "mm", 1, 20);
  if (values._PRESSURE) {
    const { tight, too_tight: most } = (report.fit && report.fit.bands) || { tight: 2.3, too_tight: 4.7 };
    maps.push({
      id: "_PRESSURE", name: "Pressure", stops: SCALES.bands,
      low: "0", high: `${most} kPa and more; tight from ${tight} kPa`,
      share: (v) => values._PRESSURE[v] / most,
      words: (x) => `pressure ${fixed(x, 2)} kPa`,
    });
  }
  rising("_SEAM_GAP", "Seam gaps", "mm", 3, 1);
  return maps;
}

/** Colour of every vertex in a map. */
function colorsOf(map, cloth) {
  const out = new Uint8Array(4 * cloth.count);
  const fabrics = cloth.pieces.map((piece) => piece.color.slice(0, 3).map(displayed));
  for (let v = 0; v < cloth.count; v++) {
    out.set(map.flat ? fabrics[cloth.pieceOf[v]] : colorOn(map.stops, map.share(v)), 4 * v);
    out[4 * v + 3] = 255;
  }
  return out;
}
