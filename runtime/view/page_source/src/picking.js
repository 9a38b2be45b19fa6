// The object under the pointer: its name, the arc-length on a cable, and the values there.

import { Raycaster, Vector2, Vector3 } from "three";
import { withUnit } from "./format.js";
import { frameAt, sampleAt, valueAt } from "./sampling.js";

const PICK_PIXELS = 12; // pixels

/** Return the object at a pixel of the picture: {kind, name, clip, lines, point, s, values}, or null. */
export function pick(stage, x, y) {
  return nearestMark(stage, x, y) ?? bodyAt(stage, x, y) ?? nearestOnCable(stage, x, y);
}

function screen(stage, point) {
  const { clientWidth, clientHeight } = stage.canvas;
  const p = point.clone().project(stage.cameras.camera);
  if (p.z > 1) return [Infinity, Infinity];
  return [((p.x + 1) / 2) * clientWidth, ((1 - p.y) / 2) * clientHeight];
}

function nearestMark(stage, x, y) {
  if (!stage.options.marks) return null;
  let best = null;
  for (const { clip, item, object } of stage.of("mark")) {
    const [u, v] = screen(stage, object.position);
    const distance = Math.hypot(u - x, v - y);
    if (distance < PICK_PIXELS && distance < (best?.distance ?? Infinity)) best = { distance, clip, item, object };
  }
  if (!best) return null;
  const { mark } = best.item;
  const lines = [mark.detail || mark.kind];
  const given = ownCurves(stage, mark.name, best.clip);
  const cable = onCable(stage, best.object.position, best.clip, given.keys);
  return {
    kind: mark.kind,
    name: mark.name,
    clip: best.clip,
    point: best.object.position.clone(),
    lines: [...lines, ...(cable?.lines ?? []), ...given.lines],
    s: cable?.s,
    values: { ...cable?.values, ...given.values },
  };
}

/** Return the current values of a mark's curves, such as "rope.tension@trolley", exact at jumps of a cable's values. */
function ownCurves(stage, name, clip) {
  const found = { keys: new Set(), lines: [], values: {} };
  for (const curve of stage.data.clips[clip].curves.filter(({ key }) => key.endsWith(`@${name}`))) {
    const quantity = curve.key
      .slice(0, -name.length - 1)
      .split(".")
      .at(-1);
    const sample = sampleAt(curve.time, stage.time, stage.data.clips[clip].period);
    found.keys.add(quantity);
    (curve.columns.length ? curve.columns : [""]).forEach((column, k) => {
      const text = [quantity, column].filter(Boolean).join(" ");
      found.values[text] = valueAt(curve.values, sample, k);
      found.lines.push(`${text} ${withUnit(found.values[text], curve.unit)}`);
    });
  }
  return found;
}

/** The values of a cable of the clip at a point on it, without the quantities `but`. */
function onCable(stage, point, clip, but) {
  let best = null;
  for (const view of stage.of("cable").filter((one) => one.clip === clip)) {
    const near = nearestStation(view.item, (a, b) => {
      const along = b.clone().sub(a);
      const square = along.lengthSq();
      const w = square > 0 ? Math.min(1, Math.max(0, point.clone().sub(a).dot(along) / square)) : 0;
      return [a.clone().addScaledVector(along, w).distanceTo(point), w];
    });
    if (near.distance < (best?.near.distance ?? Infinity)) best = { near, view };
  }
  if (!best || best.near.distance > Math.max(2 * best.view.item.size, stage.size * 1e-3)) return null;
  const values = along(stage, best.view, best.near, but);
  return { ...values, lines: [`on ${best.view.item.cable.name}`, ...values.lines] };
}

function bodyAt(stage, x, y) {
  const { clientWidth, clientHeight } = stage.canvas;
  const caster = new Raycaster();
  caster.setFromCamera(new Vector2((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight), stage.cameras.camera);
  const views = stage.of("body").filter(({ item }) => !item.isWater);
  const hits = caster.intersectObjects(
    views.map(({ item }) => item.mesh),
    false,
  );
  if (!hits.length) return null;
  const { clip, item, object } = views.find((view) => view.item.mesh === hits[0].object);
  const sample = stage.sample(clip);
  const position = [0, 1, 2].map((k) => valueAt(item.body.position, sample, k) + stage.data.origin[k]);
  const values = { position };
  const lines = [`at (${position.map((p) => withUnit(p, "m", item.body.position.step)).join(", ")})`];
  for (const { label, unit, values: array } of item.body.quantities) {
    values[label] = valueAt(array, sample, 0);
    lines.push(`${label} ${withUnit(values[label], unit)}`);
  }
  return { kind: "body", name: item.body.name, clip, lines, point: object.position.clone(), values };
}

function nearestOnCable(stage, x, y) {
  let best = null;
  for (const view of stage.of("cable")) {
    const reach =
      PICK_PIXELS +
      view.item.size / 2 / stage.cameras.pixelAt(new Vector3(...view.item.centres.slice(0, 3)), stage.height);
    const near = nearestStation(view.item, (a, b) => {
      const [ax, ay] = screen(stage, a);
      const [bx, by] = screen(stage, b);
      const square = (bx - ax) ** 2 + (by - ay) ** 2;
      const w = square > 0 ? Math.min(1, Math.max(0, ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / square)) : 0;
      return [Math.hypot(ax + w * (bx - ax) - x, ay + w * (by - ay) - y), w];
    });
    if (near.distance < reach && near.distance < (best?.near.distance ?? Infinity)) best = { near, view };
  }
  if (!best) return null;
  return {
    kind: "cable",
    name: best.view.item.cable.name,
    clip: best.view.clip,
    ...along(stage, best.view, best.near),
  };
}

/** Return the nearest segment of a cable: {p, w, distance}; `distance(a, b)`: distance of a segment, and the place. */
function nearestStation({ centres, count }, distance) {
  let best = { p: 0, w: 0, distance: Infinity };
  let a = new Vector3().fromArray(centres, 0);
  for (let p = 0; p + 1 < count; p++) {
    const b = new Vector3().fromArray(centres, 3 * (p + 1));
    const [far, w] = distance(a, b);
    if (far < best.distance) best = { p, w, distance: far };
    a = b;
  }
  return best;
}

function along(stage, { clip, item }, { p, w }, but = new Set()) {
  const { cable, centres } = item;
  const between = (array) => array[p] + w * (array[p + 1] - array[p]);
  const sample = stage.sample(clip);
  const s = between(
    cable.material_s ? frameAt(cable.material_s, sample, new Float32Array(cable.s.values.length)) : cable.s.values,
  );
  const values = {};
  const lines = [`s = ${withUnit(s, "m")}`];
  for (const quantity of cable.quantities.filter(({ key }) => !but.has(key))) {
    const frame = frameAt(quantity.values, sample, new Float32Array(cable.s.values.length));
    values[quantity.key] = between(frame);
    lines.push(`${quantity.label} ${withUnit(values[quantity.key], quantity.unit, quantity.values.step)}`);
  }
  const point = new Vector3().fromArray(centres, 3 * p).lerp(new Vector3().fromArray(centres, 3 * (p + 1)), w);
  return { s, values, lines, point };
}
