// window.funicular: the picture for programs and tests; described in README.md.

import { Quaternion, Vector3 } from "three";
import { pick } from "./picking.js";

export function hook(app) {
  const { stage, player, data } = app;
  const view = (kind, name, clip = app.clips[0]) => {
    const found = stage
      .of(kind)
      .find(
        ({ item, clip: of }) => of === clip && (item.body ?? item.cable ?? item.mark ?? item.segment).name === name,
      );
    if (!found) throw new Error(`there is no ${kind} "${name}" in the picture`);
    return found;
  };
  const absolute = (vector) => vector.toArray().map((x, k) => x + data.origin[k]);
  return {
    /** The header of the page, arrays included. */
    data,
    get clips() {
      return app.clips;
    },
    get time() {
      return player.time;
    },
    get frame() {
      return player.frame;
    },
    get playing() {
      return player.playing;
    },
    /** Go to a time; to a frame; start and stop. */
    goTo: (time) => player.go(time),
    goToFrame: (frame) => player.goFrame(frame),
    play: () => player.play(),
    pause: () => player.pause(),
    /** Show these clips (numbers). */
    show: (clips) => app.show(clips),
    look: (preset) => app.look(preset),
    follow: (name) => app.follow(name),
    /** Set quantity, map, factor, trails, reference, marks, grid. */
    set: (state) => {
      Object.assign(app.state, state);
      app.redraw();
    },
    /** The drawn frame of a body: {position in m, orientation (scalar first)}, from the scene graph. */
    body(name, clip) {
      const { object } = view("body", name, clip);
      object.updateWorldMatrix(true, false);
      const { x, y, z, w } = object.getWorldQuaternion(new Quaternion());
      return { position: absolute(object.getWorldPosition(new Vector3())), orientation: [w, x, y, z] };
    },
    /** The drawn stations of a cable, in m. */
    cable(name, clip) {
      const { centres } = view("cable", name, clip).item;
      return Array.from({ length: centres.length / 3 }, (_, p) => absolute(new Vector3().fromArray(centres, 3 * p)));
    },
    /** The drawn ends of a spring, an arrow ..., in m, the first of its name. */
    segment(name, clip) {
      const { start, end } = view("segment", name, clip).item;
      return [start, end].map(absolute);
    },
    mark: (name, clip) => absolute(view("mark", name, clip).object.position),
    /** The pixel of a point (in m). */
    pixel(point) {
      const at = new Vector3(...point.map((x, k) => x - data.origin[k])).project(stage.cameras.camera);
      return [((at.x + 1) / 2) * stage.canvas.clientWidth, ((1 - at.y) / 2) * stage.canvas.clientHeight];
    },
    /** The object at a pixel: {kind, name, lines, s, values}, or null. */
    pick(x, y) {
      const found = pick(stage, x, y);
      return found && { kind: found.kind, name: found.name, lines: found.lines, s: found.s, values: found.values };
    },
    /** The picture as a PNG in a data URL. */
    image: () => stage.image(),
    /** Draw `count` frames in turn and return the time of each in s, graphics included. */
    measure(count) {
      const gl = stage.renderer.getContext();
      const pixel = new Uint8Array(4);
      const seconds = [];
      for (let k = 0; k < count; k++) {
        const start = performance.now();
        player.goFrame(Math.floor((k * player.times.length) / count));
        stage.render();
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits until the picture is drawn
        seconds.push((performance.now() - start) / 1000);
      }
      return seconds;
    },
  };
}
