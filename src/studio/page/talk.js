// Talking with the program: what is new, what there is, and acts.

/** An address below that of the page. */
const fetched = async (name, as) => {
  const answer = await fetch(name, { cache: "no-store", credentials: "omit" });
  if (!answer.ok) throw new Error(`${name}: ${answer.status}`);
  return answer[as]();
};

/** Tells `heard` whatever is new. The browser asks again by itself when the connection is lost. */
function listen(heard, lost) {
  const events = new EventSource("events");
  events.addEventListener("message", (event) => heard(JSON.parse(event.data)));
  events.addEventListener("error", lost);
}

/** Does an act. Gives a text where it was refused. */
async function ask(base, act) {
  try {
    const answer = await fetch("act", {
      method: "POST",
      credentials: "omit",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify({ base, act }),
    });
    return answer.ok ? "" : answer.text();
  } catch {
    return "The program does not answer. Start toile studio again and open its new address.";
  }
}

/** An element of a drawing. */
function drawn(tag, attributes, ...children) {
  const out = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (typeof value === "function") out.addEventListener(name, value);
    else if (value !== null && value !== undefined) out.setAttribute(name, value);
  }
  out.append(...children.filter((child) => child !== null && child !== undefined));
  return out;
}

/** Makes something a button for keys: Enter and the space bar click it. */
function pressable(out, click) {
  out.setAttribute("tabindex", "0");
  out.setAttribute("role", "button");
  out.addEventListener("click", click);
  out.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    click(event);
  });
  return out;
}

/** Draws anew, and leaves the focus, and what is being typed, where it was. */
function keepingFocus(draw) {
  const { id, value, tagName } = document.activeElement || {};
  draw();
  const again = id && document.getElementById(id);
  if (!again) return;
  if (tagName === "INPUT") again.value = value;
  again.focus({ preventScroll: true });
}
