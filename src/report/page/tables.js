// The tables of the report, problems first. Names are set as text, never as markup.

/** An element with children; texts stay texts. */
function element(tag, attributes, ...children) {
  const out = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (typeof value === "function") out.addEventListener(name, value);
    else out.setAttribute(name, value);
  }
  out.append(...children.filter((child) => child !== null && child !== undefined));
  return out;
}

const digits = (x, n) => (typeof x === "number" ? x.toFixed(n).replace("-", "−") : "–");
const percent = (x) => (typeof x === "number" ? digits(100 * x, 2) : "–");

/** A table with a caption above it, or nothing without rows. */
function table(title, head, rows) {
  if (!rows.length) return [];
  const cell = (text) => {
    const isWord = typeof text !== "string" || !/^[−–]?[\d.]*$/.test(text);
    return element("td", isWord ? { class: "word" } : {}, text);
  };
  const first = element("thead", {}, element("tr", {}, ...head.map((word) => element("th", { scope: "col" }, word))));
  const body = element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map(cell))));
  return [element("h2", {}, title), element("div", { class: "wide" }, element("table", {}, first, body))];
}

/** Where the end of a part of the garment comes to, measured against the body: millimetres, and words for them. */
function lengthWorn({ value, against }) {
  const below = value < 0;
  const words = {
    floor: "above the floor",
    crotch: below ? "below the body's crotch" : "above the body's crotch",
  }[against] || (/shoulder$/.test(against) ? `${below ? "inside" : "beyond"} the ${against}`
    : `${below ? "short of" : "past"} the ${against}`);
  return [digits(Math.abs(value), 0), words];
}

/** Fills the section with everything that the report says. `show` takes what is to be shown in the views. */
function fillTables(section, report, show) {
  const jump = (name, what) => element("button", { type: "button", click: () => show(what) }, name);
  const fit = report.fit || { girths: [], lengths: [], finished: [], remarks: [] };
  const problems = report.problems || [];
  section.append(element("h2", {}, problems.length ? "Problems" : "No problems"));
  if (problems.length) {
    const named = (text) => report.pieces.filter((piece) => text.includes(piece.name));
    const row = (text) => {
      const places = named(text).map((piece) => jump(`show ${piece.name}`, { piece: piece.name }));
      return element("li", {}, text, ...places.flatMap((place) => [" ", place]));
    };
    section.append(element("ul", { class: "problems" }, ...problems.map(row)));
  }
  if (fit.remarks.length) {
    section.append(element("h2", {}, "Fit"));
    section.append(element("ul", {}, ...fit.remarks.map((text) => element("li", {}, text))));
  }
  const girth = (g) => [jump(g.name, { height: g.height }), digits(g.body, 0), digits(g.garment, 0), digits(g.flat, 0),
    digits(g.ease, 0), digits(g.pressure && g.pressure.mean, 2), digits(g.pressure && g.pressure.max, 2),
    g.band || "–", digits(100 * g.cloth, 0)];
  section.append(...table("Girths (mm, kPa)", ["girth", "body", "garment", "as cut", "ease", "mean pressure",
    "largest", "band", "cloth, % of its limit"], fit.girths.map(girth)));
  if (fit.bands) section.append(element("p", {}, `Bands of pressure: ${fit.bands.source}.`));
  section.append(...table("Lengths as worn (mm)", ["place", "mm", "", "uneven by"],
    fit.lengths.map((l) => [l.name, ...lengthWorn(l), digits(l.level, 0)])));
  section.append(...table("Finished measurements, flat (mm)", ["measurement", "mm"],
    fit.finished.map((f) => [f.name, digits(f.value, 0)])));
  const piece = (p) => [jump(p.name, { piece: p.name }), digits(p.area_flat / 100, 1), percent(p.area_error.drape),
    percent(p.area_error.round_trip), percent(p.strain.mean), percent(p.strain.p99), percent(p.strain.max),
    digits(p.shear.mean, 1), p.stretched ? `stretched ${percent(p.stretched.by)} % by ${p.stretched.why}` : ""];
  section.append(...table("Pieces (%, shear in degrees)", ["piece", "cm²", "area off, draped",
    "area off, flat again", "strain, mean", "99 % below", "largest", "shear", ""], report.pieces.map(piece)));
  section.append(...table("Seams (mm)", ["seam", "one side", "other side", "mean gap", "largest gap"],
    report.seams.map((s) => [jump(s.name, { seam: s.name }), digits(s.length_a, 1), digits(s.length_b, 1),
      digits(s.gap_mean, 3), digits(s.gap_max, 3)])));
  section.append(...table("Closures (mm)", ["closure", "on", "meets", "points", "largest gap", ""],
    report.closures.map((c) => [c.kind, c.on || "–", c.meets || "–", String(c.points), digits(c.gap_max, 1),
      c.closed ? "done up" : c.note || "OPEN"])));
  section.append(...table("Openings (mm)", ["opening", "length", "round"],
    report.worn.map((w) => [w.opening, digits(w.length, 0), w.body_part || "NOTHING"])));
  section.append(...table("Stages", ["stage", "seconds", "steps", "at rest", "drift, mm"],
    report.stages.map((s) => [s.name, digits(s.seconds, 2), String(s.iterations), s.converged ? "yes" : "NO",
      digits(s.drift && s.drift.rms, 3)])));
}
