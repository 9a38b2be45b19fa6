// Lines with a width in pixels: springs, lever arms, loads, trails, reference shapes.

import { ConeGeometry, Group, Matrix4, Mesh, MeshBasicMaterial, Vector3 } from "three";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { frameAt, pointAt } from "./sampling.js";

const COILS = 9;
const WIDTHS = { spring: 2, hanger: 1.5, lever: 4, joint: 2.5, load: 2.5 };
const ARROW_PIXELS = 14;
const MAX_HEAD = 0.4; // largest length of an arrow head over the arrow

/** Return a line through points (flat list of coordinates), `width` pixels wide. */
export function line(points, width) {
  const geometry = new LineGeometry();
  geometry.setPositions(points.length < 6 ? [...points, ...points] : points);
  const made = new Line2(geometry, new LineMaterial({ linewidth: width }));
  made.frustumCulled = false;
  return made;
}

/** A straight connection of two points: a coil for a spring, an arrow for a load, else a bar or a line. */
export class SegmentView {
  constructor(segment) {
    this.segment = segment;
    const spring = segment.kind === "spring";
    this.line = line(spring ? coil() : [0, 0, 0, 1, 0, 0], WIDTHS[segment.kind] ?? 2);
    this.group = new Group().add(this.line);
    this.group.matrixAutoUpdate = false;
    this.drawn = new Group().add(this.group);
    this.drawn.name = segment.name;
    if (segment.kind === "load") {
      this.head = new Mesh(new ConeGeometry(0.35, 1, 16).translate(0, -0.5, 0), new MeshBasicMaterial());
      this.drawn.add(this.head);
    }
    this.radius = spring ? this.coilRadius() : 1;
    this.start = new Vector3();
    this.end = new Vector3();
  }

  /** The coil keeps its radius while the spring changes its length. */
  coilRadius() {
    const sample = { i: 0, j: 0, w: 0 };
    const [a, b] = ["start", "end"].map((key) => frameAt(this.segment[key], sample, [0, 0, 0]));
    return 0.06 * Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) || 1e-9;
  }

  update(sample, factor) {
    const { segment } = this;
    const point = [0, 0, 0];
    this.start.fromArray(pointAt(segment.start, segment.references[0], sample, factor, point));
    this.end.fromArray(pointAt(segment.end, segment.references[1], sample, factor, point));
    const along = this.end.clone().sub(this.start);
    const length = along.length();
    const x = length > 0 ? along.clone().divideScalar(length) : new Vector3(1, 0, 0);
    const helper = Math.abs(x.z) < 0.9 ? new Vector3(0, 0, 1) : new Vector3(0, 1, 0);
    const y = helper.cross(x).normalize();
    const z = x.clone().cross(y);
    this.group.matrix.copy(
      new Matrix4()
        .makeBasis(along, y.clone().multiplyScalar(this.radius), z.multiplyScalar(this.radius))
        .setPosition(this.start),
    );
    this.group.matrixWorldNeedsUpdate = true;
    if (this.head) {
      this.head.position.copy(this.end);
      this.head.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), x);
    }
    this.drawn.children.forEach((part) => (part.visible = length > 0));
  }

  enlarge(pixel) {
    this.head?.scale.setScalar(
      Math.max(Math.min(ARROW_PIXELS * pixel, MAX_HEAD * this.start.distanceTo(this.end)), 1e-9),
    );
  }

  colour(colour) {
    this.line.material.color.set(colour);
    this.head?.material.color.set(colour);
  }

  dispose() {
    this.line.geometry.dispose();
    this.line.material.dispose();
    this.head?.geometry.dispose();
    this.head?.material.dispose();
  }
}

/** A coil of radius 1 along x from 0 to 1, with straight ends. */
function coil() {
  const points = [0, 0, 0, 0.1, 0, 0];
  const steps = COILS * 16;
  for (let i = 0; i <= steps; i++) {
    const angle = (2 * Math.PI * COILS * i) / steps;
    points.push(0.1 + (0.8 * i) / steps, Math.sin(angle), -Math.cos(angle));
  }
  points.push(0.9, 0, 0, 1, 0, 0);
  return points;
}

/** The path of a body up to the current time. */
export class TrailView {
  constructor(body, frames) {
    this.body = body;
    this.frames = frames;
    this.factor = NaN;
    this.line = line([0, 0, 0, 0, 0, 0], 1.5);
  }

  update(sample, factor) {
    if (this.factor !== factor) this.build(factor);
    this.line.geometry.instanceCount = Math.max(0, sample.i + (sample.w > 0 ? 1 : 0));
  }

  build(factor) {
    this.factor = factor;
    const point = [0, 0, 0];
    const points = [];
    let last = [0, 0, 0];
    for (let i = 0; i < this.frames; i++) {
      pointAt(this.body.position, this.body.reference, { i, j: i, w: 0 }, factor, point);
      if (!point.some(Number.isNaN)) last = [...point]; // the trail stops at missing values
      points.push(...last);
    }
    this.line.geometry.dispose();
    this.line.geometry = new LineGeometry();
    this.line.geometry.setPositions(points);
  }

  colour(colour) {
    this.line.material.color.set(colour);
  }

  dispose() {
    this.line.geometry.dispose();
    this.line.material.dispose();
  }
}
