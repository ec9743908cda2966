// The page of a report: it holds all that it shows.

const data = JSON.parse(held("report"));
load({
  report: data,
  cloth: joined(readGlb(bytesOf(held("garment")))),
  body: held("body").trim() ? joined(readGlb(bytesOf(held("body")))) : null,
});
find("about").textContent = `${data.garment} on ${data.mannequin}, ${data.fabric}, ` +
  `${data.spacing} mm between particles, toile ${data.toile}`;
fillTables(find("tables"), data, show);
document.documentElement.dataset.ready = "true";
