// Text about the picture: notes of the run, details of the clips, notes on decimation; the keys.

import { make } from "./dom.js";
import { KEYS } from "./keyboard.js";

const ABOUT =
  "Cables are drawn at least 3 pixels wide and bodies at least 9; values between frames and between stations " +
  "are interpolated.";
const MOUSE =
  "Drag turns the picture, the right button or two fingers move it, the wheel zooms. Point at something to read " +
  "its values; double-click to look at it.";

export class Notes {
  constructor(element, data) {
    this.data = data;
    this.details = make("dl");
    const notes = data.notes.map((note) => make("p", { class: "note" }, note));
    const about = [...data.about, ABOUT].map((note) => make("li", {}, note));
    element.append(
      ...notes,
      this.details,
      make("details", {}, make("summary", {}, "About this picture"), make("ul", {}, ...about)),
    );
  }

  /** Show the details of these clips (numbers), with their names if `named`. */
  show(clips, named) {
    const rows = clips.flatMap((clip) => {
      const { label, details } = this.data.clips[clip];
      const entries = Object.entries(details);
      const head = entries.length && named ? [make("dt", { class: "clip" }, label), make("dd")] : [];
      return [...head, ...entries.flatMap(([key, value]) => [make("dt", {}, key), make("dd", {}, value)])];
    });
    this.details.replaceChildren(...rows);
    this.details.hidden = rows.length === 0;
  }
}

/** Fill the dialog of the keys; `button` opens it. */
export function help(dialog, button) {
  const keys = KEYS.flatMap(([key, text]) => [make("dt", {}, key), make("dd", {}, text)]);
  const close = make("button", { type: "button", onclick: () => dialog.close() }, "Close");
  dialog.append(make("h2", {}, "Keys"), make("dl", {}, ...keys), make("p", {}, MOUSE), close);
  button.addEventListener("click", () => dialog.showModal());
}
