// The studio: it listens to what is new, shows it, and asks for acts.

let state = null;
const selection = { sides: [], piece: null, cover: "", alter: emptyForm() };
const seen = { state: 0, garment: 0, report: 0 };
/** The body, and its number. */
const skin = { number: 0, shape: null };
let isLost = false;

const say = (text) => find("said").textContent = text;

/** Asks for an act, and forgets what was chosen for it. Gives the words in which it was refused, or none. */
async function act(what) {
  say("");
  const refused = await ask(state.version, what);
  say(refused);
  if (!refused && ["sew", "free", "unfree", "name"].includes(what.do)) selection.sides = [];
  if (!refused && what.do === "alter") selection.alter = { ...emptyForm(), kind: selection.alter.kind };
  redrawFile();
  return refused;
}

function chooseEdge(edge, onward) {
  selection.sides = choosing(selection.sides, edge, onward);
  redrawFile();
}

/** A piece chosen; chosen again, none is. Where a height is asked for, the click says it. */
function choosePiece(name, height) {
  const again = selection.piece === name;
  const isAsked = asksHeight(selection.alter) && typeof height === "number";
  selection.piece = again && !isAsked ? null : name;
  if (isAsked) {
    const ticked = formFor(selection.alter, state, selection).pieces;
    selection.alter.pieces = [...new Set([...ticked, name])];
    selection.alter.at = height.toFixed(0);
  }
  redrawFile();
}

/** New values of the form for an alteration. While one types, the form is left as it is. */
function changeForm(values, isTyping = false) {
  Object.assign(selection.alter, values);
  if (isTyping) drawBoard(state, selection, chooseEdge, choosePiece);
  else redrawFile();
}

/** Problems, each with its line and its pieces. */
function drawProblems() {
  const box = find("problems");
  const row = (problem) => element("li", problem.error ? {} : { class: "warning" },
    `${problem.line ? `line ${problem.line}: ` : ""}${problem.message}${problem.hint ? ` (${problem.hint})` : ""}`,
    ...problem.pieces.flatMap((name) => [" ", element("button", { type: "button", click: () => {
      selection.piece = name;
      redrawFile();
      find("board").scrollIntoView({ block: "nearest" });
    } }, `show ${name}`)]));
  const title = state.problems.some((problem) => problem.error) ? "Problems of the file"
    : state.problems.length ? "Remarks on the file" : "The file has no problems";
  const rows = [...state.problems].sort((a, b) => b.error - a.error).map(row);
  box.replaceChildren(element("h2", {}, title), ...(rows.length ? [element("ul", { class: "problems" }, ...rows)] : []));
}

/** Draws all that depends on the file. */
function redrawFile() {
  if (!state) return;
  const names = new Set(state.pieces.flatMap((piece) => piece.edges.map((edge) => `${piece.name}.${edge.name}`)));
  selection.sides = selection.sides.map((chain) => chain.filter((edge) => names.has(edge))).filter((chain) => chain.length);
  keepingFocus(() => {
    find("title").textContent = state.title || state.file;
    document.title = `${state.title || state.file} – toile studio`;
    for (const name of ["undo", "redo"]) {
      find(name).disabled = !state[name];
      find(name).title = state[name] || "";
      const words = name === "undo" ? "Undo" : "Redo";
      const what = (state[name] || "").length > 40 ? `${state[name].slice(0, 39)}…` : state[name];
      find(name).textContent = what ? `${words}: ${what}` : words;
    }
    drawProblems();
    drawBoard(state, selection, chooseEdge, choosePiece);
    drawChosen(state, selection, act, () => {
      selection.sides = [];
      redrawFile();
    });
    drawPanel(state, selection, act, (cover) => {
      selection.cover = cover;
      redrawFile();
    }, changeForm);
  });
}

/** A file of which nothing can be read has no pieces. */
const whole = (said) => ({ pieces: [], seams: [], free: [], fabrics: [], suggestions: [], lengths: [],
  sizes: [], alterations: [], ...said });

async function takeFile() {
  state = whole(await fetched("state.json", "json"));
  redrawFile();
  document.documentElement.dataset.state = String(state.version);
  document.documentElement.dataset.sound = String(state.sound);
}

async function takeGarment(news) {
  if (news.body !== skin.number) {
    const bytes = new Uint8Array(await fetched("body.glb", "arrayBuffer"));
    [skin.number, skin.shape] = [news.body, joined(readGlb(bytes))];
  }
  const [about, garment] = await Promise.all([fetched("about.json", "json"), fetched("garment.glb", "arrayBuffer")]);
  const figures = news.report === news.garment ? await fetched("report.json", "json") : null;
  find("shown").hidden = false;
  find("nothing").hidden = true;
  load({ report: figures, cloth: colored(joined(readGlb(new Uint8Array(garment)))), body: skin.shape });
  showColors(state ? state.fabrics.map((fabric) => fabric.name) : []);
  find("about").textContent = `${about.garment} on ${about.mannequin}, ${about.fabric}, ` +
    `${about.spacing.toFixed(0)} mm mesh${about.done ? "" : `, on its way: ${about.reached}`}` +
    (figures && figures.from && !figures.from.anew ? ", gone on from the garment before" : "");
  find("tables").replaceChildren();
  if (figures) fillTables(find("tables"), figures, show);
  document.documentElement.dataset.garment = String(news.garment);
  document.documentElement.dataset.report = String(figures ? news.report : 0);
}

function tellProgress(news) {
  const stages = { sew: "Sewing", drape: "Draping", flatten: "Laying flat" };
  const share = `${(100 * news.share).toFixed(0)} %`;
  const words = news.failed ? `It cannot be made: ${news.failed}`
    : news.making ? `${stages[news.stage] || "Beginning"} … ${news.stage ? share : ""}`
      : state && !state.sound && !find("shown").hidden
        ? "This is the garment of the file before. The next one is made as soon as the file has no problems." : "";
  if (find("progress").textContent !== words) find("progress").textContent = words;
}

let waiting = null;
let busy = false;
/** Takes what is new, one thing after the other. Of news that come meanwhile the latest are taken afterwards. */
async function hear(news) {
  waiting = news;
  if (busy) return;
  busy = true;
  while (waiting) {
    const now = waiting;
    waiting = null;
    try {
      if (now.state !== seen.state) await takeFile();
      const isNew = now.garment !== seen.garment || now.report !== seen.report;
      if (now.garment > 0 && isNew) await takeGarment(now);
      [seen.state, seen.garment, seen.report] = [now.state, now.garment, now.report];
      tellProgress(now);
      if (isLost) say("");
      isLost = false;
    } catch (error) {
      console.warn(error);
      await new Promise((done) => setTimeout(done, 500));
      waiting = waiting || now;
    }
  }
  busy = false;
}

for (const name of ["undo", "redo"]) find(name).addEventListener("click", () => act({ do: name }));
addEventListener("keydown", (event) => {
  if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z" || event.target.tagName === "INPUT") return;
  event.preventDefault();
  act({ do: event.shiftKey ? "redo" : "undo" });
});
addEventListener("resize", redrawFile);
listen(hear, () => {
  isLost = true;
  say("The connection to the program is lost.");
});
