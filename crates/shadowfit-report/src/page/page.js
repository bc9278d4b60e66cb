"use strict";
(() => {
  const section = document.getElementById("pictures");
  if (!section) return;

  // Shows one frame and one kind of picture at a time.
  const frames = [...section.querySelectorAll(".frame")];
  const kinds = ["overlay", "heat", "picture"];
  const names = { overlay: "Errors", heat: "Sampling", picture: "Picture" };
  const chosen = { frame: 0, kind: "overlay" };
  const controls = document.createElement("div");
  controls.className = "controls";
  const buttons = [];
  const group = (label, entries, key) => {
    const box = document.createElement("div");
    box.setAttribute("role", "group");
    box.setAttribute("aria-label", label);
    for (const [value, text] of entries) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = text;
      button.addEventListener("click", () => { chosen[key] = value; show(); });
      buttons.push([button, key, value]);
      box.append(button);
    }
    controls.append(box);
  };
  const show = () => {
    frames.forEach((frame, place) => { frame.hidden = place !== chosen.frame; });
    section.querySelectorAll(".kind").forEach((kind) => { kind.hidden = kind.dataset.kind !== chosen.kind; });
    buttons.forEach(([button, key, value]) => button.setAttribute("aria-pressed", String(chosen[key] === value)));
  };
  group("Frame", frames.map((frame, place) => [place, frame.querySelector("h3").textContent]), "frame");
  group("Kind", kinds.map((kind) => [kind, names[kind]]), "kind");
  frames[0].before(controls);
  section.querySelector(".lead").append(" Choose a picture to see it large.");
  show();

  // Shows one picture large. The arrow keys replace it with its neighbours at the same position, so that
  // differences show.
  const dialog = document.createElement("dialog");
  const large = document.createElement("img");
  const caption = document.createElement("p");
  const name = document.createElement("b");
  const hint = document.createElement("span");
  hint.textContent = "\u2190 \u2192 technique, Esc closes";
  caption.append(name, hint);
  dialog.append(large, caption);
  document.body.append(dialog);
  let row = [];
  let place = 0;
  const enlarge = () => {
    const image = row[place];
    large.src = image.src;
    large.alt = image.alt;
    name.textContent = image.parentElement.querySelector("figcaption").textContent;
  };
  section.querySelectorAll(".row img").forEach((image) => {
    image.classList.add("large");
    image.tabIndex = 0;
    const open = () => {
      row = [...image.closest(".row").querySelectorAll("img")];
      place = row.indexOf(image);
      enlarge();
      dialog.showModal();
    };
    image.addEventListener("click", open);
    image.addEventListener("keydown", (event) => { if (event.key === "Enter") open(); });
  });
  dialog.addEventListener("click", () => dialog.close());
  dialog.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    place = (place + step + row.length) % row.length;
    enlarge();
  });
})();
