// The page of a report: it holds all that it shows.

const data = JSON.parse(held("report"));
find("about").textContent = `${data.garment} on ${data.mannequin}, ${data.fabric}, ` +
  `${data.spacing} mm between particles, toile ${data.toile}`;
// The tables come first: with them the page has its width, and the views are drawn once.
fillTables(find("tables"), data, show);
load({
  report: data,
  cloth: joined(readGlb(bytesOf(held("garment")))),
  body: held("body").trim() ? joined(readGlb(bytesOf(held("body")))) : null,
});
document.documentElement.dataset.ready = "true";
