// The picture: renderer, scene graph, and the objects of each clip.

import { Color, ColorManagement, LinearSRGBColorSpace, Scene, Vector3, WebGLRenderer } from "three";
import { BodyView } from "./bodies.js";
import { CableView } from "./cables.js";
import { Cameras } from "./cameras.js";
import { GridView } from "./grid.js";
import { line, SegmentView, TrailView } from "./lines.js";
import { sampleAt, timeOf } from "./sampling.js";
import { MarkView } from "./symbols.js";
import { WaterView } from "./water.js";

ColorManagement.enabled = false; // no conversion of colours

export class Stage {
  /** `data`: the header; `canvas`: where to draw; `drawn`: called after each picture. */
  constructor(data, canvas, drawn) {
    this.data = data;
    this.canvas = canvas;
    this.drawn = drawn;
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.scene = new Scene();
    this.scene.background = new Color();
    this.grids = this.makeGrids();
    this.cameras = new Cameras(canvas, this.box(), () => this.invalidate());
    this.views = [];
    this.shown = []; // numbers of clips
    this.time = 0;
    this.options = { factor: 1, trails: true, reference: false, marks: true, grid: true };
    this.followed = null;
    this.waiting = false;
  }

  makeGrids() {
    const { low, high, origin, up } = this.data;
    const vertical = up.map(Math.abs).reduce((best, x, k, all) => (x > all[best] ? k : best), 0);
    const size = Math.hypot(...high.map((x, k) => x - low[k])) || 1;
    const grids = [0, 1, 2].map((normal) => {
      const level = normal === vertical ? (up[vertical] > 0 ? low[vertical] : high[vertical]) : 0;
      return new GridView({ low, high, origin, normal, level });
    });
    grids.forEach((grid) => this.scene.add(grid.group));
    this.vertical = vertical;
    this.size = size;
    return grids;
  }

  /** The objects of the clips, and the grid below them. */
  box() {
    const { low, high, up } = this.data;
    const box = { low: [...low], high: [...high], up };
    for (const [axis, [first, last]] of Object.entries(this.grids[this.vertical].extent())) {
      box.low[axis] = Math.min(low[axis], first);
      box.high[axis] = Math.max(high[axis], last);
    }
    return box;
  }

  /** Show these clips (numbers). */
  show(clips) {
    for (const view of this.views) {
      this.scene.remove(view.object);
      view.item.dispose();
    }
    this.views = [];
    this.shown = clips;
    for (const clip of clips) {
      const { cables, bodies, marks, segments, time, period } = this.data.clips[clip];
      const add = (kind, item, object) => {
        this.views.push({ clip, kind, item, object });
        this.scene.add(object);
      };
      for (const cable of cables) {
        add("reference", ...twice(line([...cable.reference.values], 1.2)));
        const view = new CableView(cable);
        add("cable", view, view.mesh);
      }
      for (const body of bodies) {
        const isWater = body.shape.kind === "water";
        const view = isWater ? new WaterView(body) : new BodyView(body);
        add("body", view, view.group);
        if (time.length > 1 && !period && !isWater) {
          const trail = new TrailView(body, time.length);
          add("trail", trail, trail.line);
        }
      }
      for (const segment of segments) {
        const view = new SegmentView(segment);
        add("segment", view, view.drawn);
      }
      for (const mark of marks) {
        const view = new MarkView(mark);
        add("mark", view, view.sprite);
      }
    }
    this.resize();
  }

  of(kind) {
    return this.views.filter((view) => view.kind === kind);
  }

  sample(clip) {
    const { time, period } = this.data.clips[clip];
    const sample = sampleAt(time, this.time, period);
    return { ...sample, time: timeOf(time, sample) };
  }

  /** Move everything to a time. */
  update(time = this.time) {
    const before = this.followedPoint();
    this.time = time;
    const { factor } = this.options;
    const samples = new Map(this.shown.map((clip) => [clip, this.sample(clip)]));
    for (const { kind, item, clip } of this.views) {
      if (kind !== "reference") item.update(samples.get(clip), factor, this.data.up);
    }
    const after = this.followedPoint();
    if (before && after) this.cameras.shift(after.sub(before));
    this.invalidate();
  }

  followedPoint() {
    const view = this.of("body").find(({ item }) => item.body.name === this.followed);
    return view ? view.object.position.clone() : null;
  }

  /** Follow a body (its name), or none (null). */
  follow(name) {
    this.followed = name;
    const view = this.of("body").find(({ item }) => item.body.name === name);
    if (view) this.cameras.approach(view.object.position.clone(), Math.max(view.item.radius * 25, this.size * 0.06));
    this.invalidate();
  }

  set(options) {
    Object.assign(this.options, options);
    const visible = { trail: this.options.trails, reference: this.options.reference, mark: this.options.marks };
    for (const { kind, object } of this.views) object.visible = visible[kind] ?? true;
    this.update();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.height = height;
    this.cameras.resize(width, height);
    for (const { item } of this.of("cable")) item.resize(height);
    this.invalidate();
  }

  invalidate() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      if (this.waiting) this.render();
    });
  }

  render() {
    this.waiting = false;
    const { camera } = this.cameras;
    camera.updateMatrixWorld();
    const pixelAt = (point) => this.cameras.pixelAt(point, this.height);
    for (const { kind, item, object } of this.views) {
      if (kind === "body" || kind === "mark") item.enlarge(pixelAt(object.position));
      if (kind === "segment") item.enlarge(pixelAt(item.end));
      if (kind === "cable") item.simplify(pixelAt);
    }
    const facing = this.cameras.axisInSight() ?? this.vertical;
    this.grids.forEach((grid, normal) => {
      grid.group.visible = this.options.grid && normal === facing;
      if (grid.group.visible) grid.enlarge(pixelAt);
    });
    this.placeBackGrid(facing);
    this.renderer.render(this.scene, camera);
    this.drawn(this);
  }

  /** Return the picture as a PNG in a data URL. */
  image() {
    this.render(); // the drawing buffer lasts until the browser shows it
    return this.canvas.toDataURL("image/png");
  }

  /** Put a grid that faces the view behind everything. */
  placeBackGrid(facing) {
    const grid = this.grids[facing];
    const flat = this.cameras.axisInSight() !== null;
    const forward = this.cameras.camera.getWorldDirection(new Vector3());
    const { low, high } = this.data;
    const middle = grid.bounds.level;
    const behind = forward.getComponent(facing) > 0 ? high[facing] : low[facing];
    grid.group.position.setComponent(
      facing,
      flat ? behind + Math.sign(forward.getComponent(facing)) * this.size * 0.02 - middle : 0,
    );
  }
}

function twice(object) {
  return [
    {
      dispose: () => (object.geometry.dispose(), object.material.dispose()),
      colour: (c) => object.material.color.set(c),
    },
    object,
  ];
}
