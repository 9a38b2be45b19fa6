// Marks as the symbols of engineering drawings, of constant size on the screen.

import { CanvasTexture, Sprite, SpriteMaterial } from "three";
import { pointAt } from "./sampling.js";

const PIXELS = 24;
const CANVAS = 88;

/** Draw a symbol; its point is the middle of a square from -1 to 1, y down. */
const DRAW = {
  pin(c) {
    path(
      c,
      [
        [0, 0],
        [-0.5, 0.7],
        [0.5, 0.7],
      ],
      true,
    );
    hatch(c, 0.7);
    dot(c, 0.17);
  },
  clamp(c) {
    c.fillRect(-0.4, -0.4, 0.8, 0.8);
    c.strokeRect(-0.4, -0.4, 0.8, 0.8);
    path(c, [
      [-0.4, -0.4],
      [0.4, 0.4],
    ]);
    path(c, [
      [-0.4, 0.4],
      [0.4, -0.4],
    ]);
  },
  ground(c) {
    path(c, [
      [-0.6, 0],
      [0.6, 0],
    ]);
    hatch(c, 0);
  },
  tie(c) {
    path(
      c,
      [
        [-0.4, 0],
        [0, -0.4],
        [0.4, 0],
        [0, 0.4],
      ],
      true,
    );
  },
  joint(c) {
    dot(c, 0.3);
  },
  slide(c) {
    dot(c, 0.42);
    c.beginPath();
    c.arc(0, 0, 0.14, 0, 7);
    c.fillStyle = c.strokeStyle;
    c.fill();
  },
  point(c) {
    dot(c, 0.16);
  },
};

function path(c, points, closed = false) {
  c.beginPath();
  points.forEach(([x, y]) => c.lineTo(x, y));
  if (closed) {
    c.closePath();
    c.fill();
  }
  c.stroke();
}

function dot(c, radius) {
  c.beginPath();
  c.arc(0, 0, radius, 0, 7);
  c.fill();
  c.stroke();
}

function hatch(c, y) {
  path(c, [
    [-0.65, y],
    [0.65, y],
  ]);
  for (const x of [-0.35, 0, 0.35])
    path(c, [
      [x + 0.1, y],
      [x - 0.12, y + 0.24],
    ]);
}

export class MarkView {
  constructor(mark) {
    this.mark = mark;
    this.sprite = new Sprite(new SpriteMaterial({ depthTest: false, transparent: true }));
    this.sprite.renderOrder = 10;
    this.sprite.name = mark.name;
    this.point = [0, 0, 0];
  }

  update(sample, factor) {
    this.sprite.position.fromArray(pointAt(this.mark.position, this.mark.reference, sample, factor, this.point));
  }

  colour(stroke, fill) {
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = CANVAS;
    const c = canvas.getContext("2d");
    c.setTransform(CANVAS / 2, 0, 0, CANVAS / 2, CANVAS / 2, CANVAS / 2);
    Object.assign(c, { fillStyle: fill, lineCap: "round", lineJoin: "round" });
    const draw = DRAW[this.mark.kind] ?? DRAW.point;
    Object.assign(c, { lineWidth: 0.3, strokeStyle: fill }); // a halo for contrast on any colour
    draw(c);
    Object.assign(c, { lineWidth: 0.13, strokeStyle: stroke, fillStyle: fill });
    draw(c);
    this.sprite.material.map?.dispose();
    this.sprite.material.map = new CanvasTexture(canvas);
    this.sprite.material.needsUpdate = true;
  }

  enlarge(pixel) {
    this.sprite.scale.setScalar(PIXELS * pixel);
  }

  dispose() {
    this.sprite.material.map?.dispose();
    this.sprite.material.dispose();
  }
}
