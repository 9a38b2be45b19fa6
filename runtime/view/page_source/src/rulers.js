// Scale, triad of axes, and the legend of colours.

import { Vector3 } from "three";
import { gradient } from "./colours.js";
import { make, svg } from "./dom.js";
import { niceStep, number, scaled, tick } from "./format.js";

const SCALE_PIXELS = 60; // smallest length
const ARM = 24;

export class Rulers {
  constructor(element) {
    this.arms = [0, 1, 2].map((axis) => ({
      axis,
      line: svg("line", { x1: 0, y1: 0, class: `axis${axis}` }),
      text: svg("text", { class: `axis${axis}` }, "xyz"[axis]),
    }));
    this.triad = svg("svg", { class: "triad", viewBox: "-36 -36 72 72", width: 72, height: 72, "aria-hidden": "true" });
    this.bar = make("div", { class: "bar" });
    this.length = make("span");
    element.append(this.triad, make("div", { class: "scale", "aria-hidden": "true" }, this.bar, this.length));
  }

  /** Draw scale and triad for a picture of the stage. */
  update({ cameras, height }) {
    const { camera, controls } = cameras;
    const nearFirst = this.arms
      .map((arm) => {
        const end = new Vector3().setComponent(arm.axis, 1).transformDirection(camera.matrixWorldInverse);
        arm.line.setAttribute("x2", ARM * end.x);
        arm.line.setAttribute("y2", -ARM * end.y);
        arm.text.setAttribute("x", (ARM + 7) * end.x);
        arm.text.setAttribute("y", -(ARM + 7) * end.y);
        const visible = Math.hypot(end.x, end.y) > 0.12 ? "visible" : "hidden";
        arm.text.setAttribute("visibility", visible);
        return [end.z, arm];
      })
      .sort((a, b) => a[0] - b[0]);
    this.triad.replaceChildren(...nearFirst.flatMap(([, { line, text }]) => [line, text]));
    const pixel = cameras.pixelAt(controls.target, height);
    const length = niceStep(SCALE_PIXELS * pixel);
    const { scale, unit } = scaled("m", length);
    this.bar.style.width = `${length / pixel}px`;
    this.length.textContent = `${Number((length / scale).toPrecision(2))} ${unit}`;
  }
}

export class Legend {
  /** `select`: the choice of the quantity, above its colours. */
  constructor(element, select) {
    this.select = select;
    this.content = make("div");
    this.unit = make("span", { class: "unit" });
    element.append(make("div", { class: "head" }, select, this.unit), this.content);
  }

  /** Show the colours of a quantity with its range, or the names of clips, or nothing. */
  show({ quantity, range, uniform, map, clips }) {
    const parts = [];
    this.unit.textContent = "";
    if (quantity) {
      const { scale, unit } = scaled(quantity.unit, Math.max(Math.abs(range[0]), Math.abs(range[1])));
      const step = (range[1] - range[0]) / 2 / scale;
      const digits = step > 0 ? 10 ** Math.floor(Math.log10(step) - 1) : 1;
      const middle = (range[0] + range[1]) / 2;
      const ends = uniform
        ? [`${number(middle / scale)} everywhere`]
        : [range[0], middle, range[1]].map((value) => tick(value / scale, digits));
      parts.push(
        make("div", { class: "ramp", style: `background:${gradient(map)}` }),
        make("div", { class: "ends" }, ...ends.map((text) => make("span", {}, text))),
      );
      this.unit.textContent = unit;
    }
    for (const { label, colour } of clips) {
      parts.push(make("div", { class: "clip" }, make("i", { style: `background:${colour}` }), label));
    }
    this.content.replaceChildren(...parts);
  }
}
