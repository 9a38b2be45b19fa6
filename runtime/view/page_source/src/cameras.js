// Views of the picture: perspective, along an axis, following a body.

import { OrthographicCamera, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const FIELD_OF_VIEW = 35; // field of view of the perspective, degrees
const MARGIN = 1.14;
const LABEL_WIDTH = 90; // width of the labels of grids, pixels

export class Cameras {
  /** Cameras for the box [low, high] with its grids; `up` is against gravity.
   *  `changed` is called after a change of the view. */
  constructor(canvas, { low, high, up }, changed) {
    this.box = { low: new Vector3(...low), high: new Vector3(...high) };
    this.up = new Vector3(...up).normalize();
    this.size = Math.max(this.box.high.distanceTo(this.box.low), 1e-9);
    this.perspective = new PerspectiveCamera(FIELD_OF_VIEW, 1, this.size * 1e-4, this.size * 50);
    this.flat = new OrthographicCamera(-1, 1, 1, -1, -this.size * 20, this.size * 40);
    this.camera = this.perspective;
    this.aspect = 1;
    for (const camera of [this.perspective, this.flat]) camera.up.copy(this.up);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", changed);
    this.controls.addEventListener("start", () => (this.fits = false)); // moved by the reader
    this.preset = "3d";
    this.fits = false; // whether the view shows everything: until the reader moves the camera
  }

  resize(width, height) {
    const aspect = width / height;
    this.aspect = aspect;
    this.usable = Math.max(0.5, 1 - LABEL_WIDTH / width) * aspect * MARGIN; // usable width at height 1
    this.perspective.aspect = aspect;
    this.perspective.updateProjectionMatrix();
    this.flat.left = -this.flat.top * aspect;
    this.flat.right = this.flat.top * aspect;
    this.flat.updateProjectionMatrix();
    if (this.fits) this.look(this.preset);
  }

  /** Set the view "3d", "x", "y" or "z", with all moving parts in the picture. */
  look(preset) {
    this.preset = preset;
    const flat = preset !== "3d";
    this.camera = flat ? this.flat : this.perspective;
    const { forward, up } = flat ? this.alongAxis("xyz".indexOf(preset)) : this.oblique();
    const right = forward.clone().cross(up).normalize();
    const screenUp = right.clone().cross(forward).normalize();
    const centre = this.box.low.clone().add(this.box.high).multiplyScalar(0.5);
    const corners = this.corners(centre).map((corner) => [
      corner.dot(right),
      corner.dot(screenUp),
      -corner.dot(forward),
    ]);
    this.controls.object = this.camera;
    this.controls.target.copy(centre);
    if (flat) {
      const half =
        MARGIN *
        Math.max(...corners.map(([x, y]) => Math.max(Math.abs(y), Math.abs(x) / this.usable)), this.size * 1e-3);
      Object.assign(this.flat, { top: half, bottom: -half, zoom: 1 });
      this.flat.left = -half * this.aspect;
      this.flat.right = half * this.aspect;
      this.camera.position.copy(centre).addScaledVector(forward, -this.size * 2);
    } else {
      const tangent = Math.tan((FIELD_OF_VIEW / 2) * (Math.PI / 180)) / MARGIN;
      const needed = corners.map(([x, y, near]) => near + Math.max(Math.abs(y), Math.abs(x) / this.usable) / tangent);
      this.camera.position.copy(centre).addScaledVector(forward, -Math.max(...needed, this.size * 0.05));
    }
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.fits = true;
  }

  /** Two horizontal directions (positive axes if these are horizontal) and up. */
  horizontal() {
    const axes = [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)];
    const level = axes
      .filter((axis) => Math.abs(axis.dot(this.up)) < 0.9)
      .map((axis) => axis.clone().addScaledVector(this.up, -axis.dot(this.up)).normalize());
    return level[0];
  }

  oblique() {
    const right = this.horizontal();
    const back = right.clone().cross(this.up); // the observer looks along -back
    const from = back.multiplyScalar(0.82).addScaledVector(right, 0.42).addScaledVector(this.up, 0.4);
    return { forward: from.normalize().negate(), up: this.up };
  }

  /** Look along an axis with the other horizontal axis to the right, from above with the first one. */
  alongAxis(axis) {
    const direction = new Vector3().setComponent(axis, 1);
    const vertical = direction.dot(this.up);
    if (Math.abs(vertical) > 0.9) {
      const right = this.horizontal();
      const forward = this.up.clone().negate();
      // not exactly from above: the controls need an upward direction
      const up = right.clone().cross(forward).normalize();
      return { forward: forward.addScaledVector(up, 1e-4).normalize(), up: this.up };
    }
    const forward = direction.addScaledVector(this.up, -vertical).normalize();
    const right = forward.clone().cross(this.up);
    const largest = right.toArray().reduce((best, x) => (Math.abs(x) > Math.abs(best) ? x : best), 0);
    return { forward: largest < 0 ? forward.negate() : forward, up: this.up };
  }

  /** Corners of the box of the picture, from its middle. */
  corners(centre) {
    const { low, high } = this.box;
    return Array.from({ length: 8 }, (_, k) =>
      new Vector3(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z).sub(centre),
    );
  }

  /** Move the view with the followed body. */
  shift(by) {
    this.camera.position.add(by);
    this.controls.target.add(by);
    this.controls.update();
  }

  /** Look at a point from `distance`, in the current direction. */
  approach(point, distance) {
    this.fits = false;
    const forward = this.camera.getWorldDirection(new Vector3());
    this.controls.target.copy(point);
    if (this.camera === this.flat) {
      this.flat.zoom = this.flat.top / (distance * Math.tan((FIELD_OF_VIEW / 2) * (Math.PI / 180)));
      this.flat.updateProjectionMatrix();
      distance = this.size * 2;
    }
    this.camera.position.copy(point).addScaledVector(forward, -distance);
    this.controls.update();
  }

  /** Return the axis (0, 1, 2) of the view, or null. */
  axisInSight() {
    if (this.camera !== this.flat) return null;
    const forward = this.camera.getWorldDirection(new Vector3()).toArray();
    const axis = forward.findIndex((x) => Math.abs(x) > 0.999);
    return axis < 0 ? null : axis;
  }

  /** Return the size of a pixel in m at a point; `height`: of the picture in pixels. */
  pixelAt(point, height) {
    if (this.camera === this.flat) return (2 * this.flat.top) / this.flat.zoom / height;
    const depth = point.clone().applyMatrix4(this.camera.matrixWorldInverse).z;
    return (2 * Math.abs(depth) * Math.tan((FIELD_OF_VIEW / 2) * (Math.PI / 180))) / height;
  }
}
