// The pointer on the picture: a tip names the object, and a double click approaches it.

import { make } from "./dom.js";
import { pick } from "./picking.js";
import { isOutside } from "./sampling.js";

const APPROACH_DISTANCE = 0.08; // distance after a double click over the size of the picture

export class Pointer {
  /** `tip` is filled and placed within `picture`; `several()` says whether clips must be named. */
  constructor({ canvas, tip, picture }, stage, several) {
    Object.assign(this, { tip, picture, stage, several });
    const at = (event) => {
      const { left, top } = canvas.getBoundingClientRect();
      return [event.clientX - left, event.clientY - top];
    };
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons) this.hide();
      else this.tell(...at(event));
    });
    canvas.addEventListener("pointerleave", () => this.hide());
    canvas.addEventListener("click", (event) => this.tell(...at(event)));
    canvas.addEventListener("dblclick", (event) => {
      const found = pick(stage, ...at(event));
      if (found) stage.cameras.approach(found.point, stage.size * APPROACH_DISTANCE);
    });
  }

  /** Show the tip of a pixel. */
  tell(x, y) {
    this.at = [x, y];
    const found = pick(this.stage, x, y);
    if (!found) {
      this.hide();
      return;
    }
    const { tip, picture } = this;
    const { label, time, period } = this.stage.data.clips[found.clip];
    const ended = isOutside(time, this.stage.time, period) ? " (not at this time: its nearest state)" : "";
    const clip = this.several() ? [make("div", { class: "of" }, label + ended)] : [];
    tip.replaceChildren(make("b", {}, found.name), ...clip, ...found.lines.map((text) => make("div", {}, text)));
    tip.hidden = false;
    const { clientWidth: width, clientHeight: height } = picture;
    const below = y + 16 + tip.offsetHeight <= height;
    tip.style.left = `${Math.max(4, Math.min(x + 14, width - tip.offsetWidth - 6))}px`;
    tip.style.top = `${Math.max(4, below ? y + 16 : y - tip.offsetHeight - 12)}px`;
  }

  /** Update the tip with time. */
  update() {
    if (!this.tip.hidden) this.tell(...this.at);
  }

  hide() {
    this.tip.hidden = true;
  }
}
