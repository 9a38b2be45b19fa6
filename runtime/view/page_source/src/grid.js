// Grids with a scale in metres: on the ground, and behind the picture in views along an axis.

import {
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  Group,
  LineBasicMaterial,
  LineSegments,
  Sprite,
  SpriteMaterial,
  Vector3,
} from "three";
import { niceStep, scaled, tick } from "./format.js";

const LABEL_PIXELS = 13;
const LINES = 10; // approximate number along the longer side

/** A grid in the plane across axis `normal` (0, 1, 2), over the box [low, high]; labels count from the true origin. */
export class GridView {
  constructor({ low, high, origin, normal, level }) {
    this.group = new Group();
    this.labels = [];
    this.material = new LineBasicMaterial({ transparent: true });
    this.strong = new LineBasicMaterial({ transparent: true });
    const [u, v] = [0, 1, 2].filter((axis) => axis !== normal);
    const longest = Math.max(high[u] - low[u], high[v] - low[v], 1e-12);
    const step = niceStep(longest / LINES);
    const range = (axis) => {
      const first = Math.floor((low[axis] + origin[axis]) / step + 0.02);
      const last = Math.ceil((high[axis] + origin[axis]) / step - 0.02);
      return [first, Math.max(last, first + 1)];
    };
    const at = { normal, level, origin, step, u, v, ranges: { [u]: range(u), [v]: range(v) } };
    this.addLines(at, u, v);
    this.addLines(at, v, u);
    this.addLabels(at, longest);
    this.bounds = at;
  }

  /** Return {axis: [from, to]} of the grid's two axes. */
  extent() {
    const { ranges, step, origin, u, v } = this.bounds;
    return Object.fromEntries([u, v].map((axis) => [axis, ranges[axis].map((end) => end * step - origin[axis])]));
  }

  addLines({ normal, level, origin, step, ranges }, along, across) {
    for (const [material, chosen] of [
      [this.material, (k) => k !== 0],
      [this.strong, (k) => k === 0],
    ]) {
      const points = [];
      for (let k = ranges[across][0]; k <= ranges[across][1]; k++) {
        if (!chosen(k)) continue;
        for (const end of ranges[along]) {
          const point = [0, 0, 0];
          point[normal] = level;
          point[along] = end * step - origin[along];
          point[across] = k * step - origin[across];
          points.push(...point);
        }
      }
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
      this.group.add(new LineSegments(geometry, material));
    }
  }

  addLabels({ normal, level, origin, step, ranges, u, v }, longest) {
    const { scale, unit } = scaled("m", longest);
    for (const [along, across] of [
      [u, v],
      [v, u],
    ]) {
      const [first, last] = ranges[along];
      const every = Math.max(1, Math.ceil((last - first) / 6));
      for (let k = first; k <= last; k++) {
        if (k !== last && (k % every !== 0 || last - k < every * 0.6)) continue;
        const value = tick((k * step) / scale, step / scale);
        const label = new Label(k === last ? `${"xyz"[along]} = ${value} ${unit}` : value);
        const point = [0, 0, 0];
        point[normal] = level;
        point[along] = k * step - origin[along];
        point[across] = ranges[across][0] * step - origin[across];
        label.outward = [0, 0, 0];
        label.outward[across] = -1;
        label.base = new Vector3(...point);
        this.labels.push(label);
        this.group.add(label.sprite);
      }
    }
  }

  colour(weak, strong, text) {
    this.material.color.set(weak);
    this.strong.color.set(strong);
    this.labels.forEach((label) => label.draw(text));
  }

  /** Set the size of the labels on the screen and their distance from the grid. */
  enlarge(pixelAt) {
    for (const label of this.labels) {
      const pixel = pixelAt(label.base);
      label.sprite.scale.set(label.aspect * LABEL_PIXELS * pixel, LABEL_PIXELS * pixel, 1);
      const away = 14 * pixel;
      label.sprite.position.set(...label.base.toArray().map((x, k) => x + away * label.outward[k]));
    }
  }

  dispose() {
    this.group.children.forEach((child) => child.geometry?.dispose());
    this.labels.forEach((label) => label.dispose());
    this.material.dispose();
    this.strong.dispose();
  }
}

class Label {
  constructor(text) {
    this.text = text;
    this.sprite = new Sprite(new SpriteMaterial({ transparent: true }));
    this.aspect = 1;
  }

  draw(colour) {
    const scale = 3;
    const canvas = document.createElement("canvas");
    const font = `${10.5 * scale}px system-ui, sans-serif`;
    let c = canvas.getContext("2d");
    c.font = font;
    canvas.width = Math.ceil(c.measureText(this.text).width) + 4;
    canvas.height = LABEL_PIXELS * scale;
    c = canvas.getContext("2d");
    Object.assign(c, { font, fillStyle: colour, textBaseline: "middle", textAlign: "center" });
    c.fillText(this.text, canvas.width / 2, canvas.height / 2);
    this.aspect = canvas.width / canvas.height;
    this.sprite.material.map?.dispose();
    this.sprite.material.map = new CanvasTexture(canvas);
    this.sprite.material.needsUpdate = true;
  }

  dispose() {
    this.sprite.material.map?.dispose();
    this.sprite.material.dispose();
  }
}
