// Settings of the picture: colours, exaggeration, shown parts.

import { MAP_NAMES } from "./colours.js";
import { choice, fill, make } from "./dom.js";

const FACTORS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 10000];

export class Panel {
  /** `state` has quantity, map, factor, trails, reference, marks, grid; `changed()` is called after a change. */
  constructor(element, state, changed, savePicture) {
    this.state = state;
    const set = (key, value) => {
      state[key] = value;
      changed();
    };
    this.quantity = choice("Colour by", [], state.quantity, (value) => set("quantity", value));
    this.map = choice(
      "Colour map",
      MAP_NAMES.map((name) => [name, name]),
      state.map,
      (value) => set("map", value),
    );
    this.factor = choice(
      "Displacements",
      FACTORS.map((factor) => [String(factor), factor === 1 ? "true scale" : `\u00d7 ${factor}`]),
      "1",
      (value) => set("factor", Number(value)),
    );
    this.boxes = Object.fromEntries(
      [
        ["trails", "trails"],
        ["reference", "reference shape"],
        ["marks", "supports, joints"],
        ["grid", "grid"],
      ].map(([key, text]) => [key, this.box(key, text, set)]),
    );
    this.mapRow = this.row("Colour map", this.map);
    element.append(
      this.mapRow,
      this.row("Displacement", this.factor),
      ...Object.values(this.boxes).map(({ label }) => label),
      make("button", { type: "button", onclick: savePicture }, "Save picture (PNG)"),
    );
  }

  row(text, control) {
    return make("div", { class: "row" }, make("span", {}, text), control);
  }

  box(key, text, set) {
    const input = make("input", { type: "checkbox", onchange: () => set(key, input.checked) });
    return { input, label: make("label", {}, input, ` ${text}`) };
  }

  /** Draw the state; `quantities`: [key, label] to select; `has`: the available boxes.
   *  `exaggerable`: whether displacements can be exaggerated. */
  show(quantities, plain, has, exaggerable) {
    fill(this.quantity, [...quantities.map(([key, label]) => [key, label]), ["", plain]], this.state.quantity);
    this.quantity.hidden = quantities.length === 0;
    this.mapRow.hidden = this.state.quantity === "";
    this.factor.value = String(this.state.factor);
    this.factor.disabled = !exaggerable;
    this.factor.title = exaggerable ? "" : "What slides along a cable would leave it";
    for (const [key, { input, label }] of Object.entries(this.boxes)) {
      input.checked = this.state[key];
      label.hidden = has[key] === false;
    }
  }
}
