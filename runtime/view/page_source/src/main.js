// The page: reads its content, makes its parts and connects them.

import { Charts } from "./charts.js";
import { SERIES } from "./colours.js";
import { read } from "./data.js";
import { choice, make } from "./dom.js";
import { hook } from "./hook.js";
import { listen } from "./keyboard.js";
import { layout } from "./layout.js";
import { help, Notes } from "./notes.js";
import { Panel } from "./panel.js";
import { Player } from "./player.js";
import { Pointer } from "./pointer.js";
import { Legend, Rulers } from "./rulers.js";
import { Stage } from "./stage.js";
import { Theme } from "./theme.js";
import { Timeline } from "./timeline.js";

const MAX_TIMES = 2000; // largest number of times of clips drawn together
const RIM = { dark: 0.35, light: -0.1 }; // over the range of brightness
const MIN_COLOUR_RANGE = 1e-3; // of colours, over the largest value; MIN_COLOUR_RANGE of decimation.py

class App {
  constructor(data) {
    this.data = data;
    this.parts = layout(document.getElementById("viewer"), data);
    const { parts } = this;
    this.overlay = data.arrangement === "overlay";
    this.rulers = new Rulers(parts.rulers);
    this.stage = new Stage(data, parts.canvas, (stage) => this.rulers.update(stage));
    this.player = new Player(
      (time) => this.timeChanged(time),
      () => this.timeline.playing(),
    );
    this.timeline = new Timeline(parts.timeline, this.player, data);
    this.charts = new Charts(parts.curves, this.player, data);
    this.state = {
      quantity: null,
      map: "viridis",
      factor: 1,
      trails: true,
      reference: data.clips.some((clip) => clip.period),
      marks: true,
      grid: true,
    };
    this.panel = new Panel(
      parts.options,
      this.state,
      () => this.redraw(),
      () => this.savePicture(),
    );
    this.legend = new Legend(parts.legend, this.panel.quantity);
    this.theme = new Theme(parts.theme, () => this.redraw());
    this.chooseViews();
    this.chooseClip();
    this.notes = new Notes(parts.notes, data);
    this.pointer = new Pointer(parts, this.stage, () => this.clips.length > 1);
    help(parts.dialog, parts.help);
    listen(document, this.actions());
    new ResizeObserver(() => this.stage.resize()).observe(parts.picture);
    document.documentElement.dataset.theme = this.theme.dark ? "dark" : "light";
    this.show(this.overlay ? data.clips.map((_, k) => k) : [0]);
    this.look(data.planar ? this.planarView() : "3d");
    this.theme.apply();
  }

  /** Planar motion is in a plane normal to z. */
  planarView() {
    return "z";
  }

  show(clips) {
    const { data, player, stage } = this;
    const times = clips.map((clip) => data.clips[clip].time);
    const period = clips.length === 1 ? data.clips[clips[0]].period : null;
    player.pause();
    player.load(together(times), period);
    this.clips = clips;
    stage.show(clips);
    if (this.state.quantity === null) this.state.quantity = clips.length > 1 ? "" : (this.quantities()[0]?.[0] ?? "");
    this.timeline.show(clips);
    if (this.clipSelect) this.clipSelect.value = String(clips[0]);
    this.notes.show(clips, clips.length > 1 || Boolean(this.clipSelect));
    this.redraw();
    player.go(player.time);
    if (period && !matchMedia("(prefers-reduced-motion: reduce)").matches) player.play();
  }

  quantities() {
    const all = this.clips.flatMap((clip) => this.data.clips[clip].cables.flatMap(({ quantities }) => quantities));
    return [...new Map(all.map(({ key, label }) => [key, label]))];
  }

  /** The range of a quantity over all shown clips and times. */
  range(key) {
    let low = Infinity;
    let high = -Infinity;
    let found = null;
    for (const clip of this.clips) {
      for (const { quantities } of this.data.clips[clip].cables) {
        const quantity = quantities.find((one) => one.key === key);
        if (!quantity) continue;
        found = quantity;
        for (const value of quantity.values.values) {
          if (value < low) low = value;
          if (value > high) high = value;
        }
      }
    }
    if (!(low <= high)) return { quantity: found, range: [0, 1] };
    const least = MIN_COLOUR_RANGE * Math.max(Math.abs(low), Math.abs(high)); // rounding does not change colours
    const more = Math.max(0, (least - (high - low)) / 2);
    return { quantity: found, range: [low - more, high + more], uniform: more > 0 };
  }

  /** Colour the picture, cables by the quantity over its range; return the shades of the clips. */
  colourViews(range) {
    const { state, stage, theme, clips } = this;
    const several = clips.length > 1;
    const series = SERIES[theme.dark ? "dark" : "light"];
    const shades = clips.map((_, k) => series[k % series.length]);
    const ground = theme.colour("canvas");
    const rim = theme.dark ? RIM.dark : RIM.light;
    const colourOfPiece = (make) => (make === null ? theme.colour("cable") : series[make % series.length]);
    let bodies = 0;
    stage.scene.background.set(ground);
    for (const { kind, item, clip } of stage.views) {
      const shade = shades[clips.indexOf(clip)];
      const body = several ? shade : series[(1 + bodies) % series.length];
      if (kind === "cable")
        item.colour({
          key: state.quantity,
          range,
          map: state.map,
          rim,
          plain: several ? shade : colourOfPiece(item.cable.make),
        });
      if (kind === "body" && item.sheet) item.colour(...["", "-edge"].map((part) => theme.colour(item.sheet + part)), 0);
      else if (kind === "body") {
        item.colour(body, theme.colour("edge"), rim);
        this.lastBody = body;
        bodies += 1;
      }
      if (kind === "trail") item.colour(this.lastBody);
      if (kind === "segment")
        item.colour(several ? shade : theme.colour(item.segment.kind === "load" ? "load" : "segment"));
      if (kind === "mark") item.colour(several ? shade : theme.colour("ink"), ground);
      if (kind === "reference") item.colour(theme.colour("ghost"));
    }
    return shades;
  }

  /** Redraw after a change of settings. */
  redraw() {
    const { state, stage, theme, data, clips } = this;
    const keys = this.quantities();
    if (state.quantity && !keys.some(([key]) => key === state.quantity)) state.quantity = keys[0]?.[0] ?? "";
    const several = clips.length > 1;
    const exaggerable = clips.every((clip) => data.clips[clip].exaggerable);
    if (!exaggerable) state.factor = 1;
    const { quantity, range, uniform } = this.range(state.quantity);
    const shades = this.colourViews(range);
    stage.grids.forEach((grid) =>
      grid.colour(theme.colour("grid"), theme.colour("grid-strong"), theme.colour("muted")),
    );
    const named = several ? clips.map((clip, k) => ({ label: data.clips[clip].label, colour: shades[k] })) : [];
    this.legend.show({ quantity, range, uniform, map: state.map, clips: named });
    this.parts.legend.hidden = !keys.length && !several;
    this.parts.badge.textContent =
      state.factor === 1
        ? ""
        : `Displacements are drawn ${state.factor} times as large, rotations of bodies as they are`;
    this.parts.badge.hidden = state.factor === 1;
    const has = (kind) => stage.of(kind).length > 0;
    const boxes = { trails: has("trail"), reference: has("reference"), marks: has("mark") };
    this.panel.show(keys, several ? "each run its own" : "plain", boxes, exaggerable);
    stage.set({
      factor: state.factor,
      trails: state.trails,
      reference: state.reference,
      marks: state.marks,
      grid: state.grid,
    });
    this.charts.show(clips, theme.dark);
    this.parts.aside.classList.toggle("narrow", this.charts.keys.size === 0);
  }

  timeChanged(time) {
    this.stage.update(time);
    this.timeline.update();
    this.charts.update(time);
    this.parts.canvas.setAttribute(
      "aria-label",
      `${this.data.title}, ${this.data.time_label} ${this.timeline.timeText(time)}`,
    );
    this.pointer.update();
  }

  look(preset) {
    this.stage.followed = null;
    this.stage.resize();
    this.stage.cameras.look(preset);
    this.markView(preset);
  }

  markView(preset) {
    for (const [key, button] of Object.entries(this.viewButtons)) button.setAttribute("aria-pressed", key === preset);
    if (this.followSelect) this.followSelect.value = this.stage.followed ?? "";
  }

  chooseViews() {
    const { parts } = this;
    const texts = {
      "3d": ["3D", "Perspective (1)"],
      x: ["x", "Along x (2)"],
      y: ["y", "Along y (3)"],
      z: ["z", "Along z (4)"],
    };
    this.viewButtons = Object.fromEntries(
      Object.entries(texts).map(([preset, [text, title]]) => [
        preset,
        make(
          "button",
          { type: "button", title, "aria-label": title, "aria-pressed": "false", onclick: () => this.look(preset) },
          text,
        ),
      ]),
    );
    parts.views.append(...Object.values(this.viewButtons));
    const names = this.bodyNames();
    if (!names.length) return;
    this.followSelect = choice(
      "Follow a body",
      [["", "follow \u2026"], ...names.map((name) => [name, name])],
      "",
      (name) => this.follow(name || null),
      { title: "Follow a body (5)" },
    );
    parts.views.append(this.followSelect);
  }

  bodyNames() {
    return [...new Set(this.data.clips.flatMap(({ bodies }) => bodies.map(({ name }) => name)))];
  }

  follow(name) {
    if (name === null) {
      this.look(this.stage.cameras.preset);
      return;
    }
    this.stage.follow(name);
    this.markView(this.stage.cameras.preset);
  }

  chooseClip() {
    const { data, parts } = this;
    if (this.overlay || data.clips.length < 2) return;
    const texts = data.clips.map(({ label }, k) => [String(k), label]);
    this.clipSelect = choice("Clip", texts, "0", (value) => this.show([Number(value)]));
    parts.clip.append(this.clipSelect);
  }

  /** Save the picture in its size on the screen. */
  savePicture() {
    make("a", { href: this.stage.image(), download: `${this.data.title}.png` }).click();
  }

  actions() {
    const { player, data } = this;
    return {
      toggle: () => player.toggle(),
      step: (by) => player.step(by),
      home: () => (player.pause(), player.goFrame(0)),
      end: () => (player.pause(), player.goFrame(player.times.length - 1)),
      fit: () => this.look(this.stage.cameras.preset),
      look: (preset) => this.look(preset),
      followNext: () => {
        const names = [...this.bodyNames(), null];
        this.follow(names[(names.indexOf(this.stage.followed) + 1) % names.length]);
      },
      clip: (by) => {
        if (this.clipSelect) this.show([(this.clips[0] + by + data.clips.length) % data.clips.length]);
      },
      loop: () => this.timeline.toggleLoop(),
      trails: () => {
        this.state.trails = !this.state.trails;
        this.redraw();
      },
      theme: () => this.theme.toggle(),
      help: () => this.parts.dialog.showModal(),
    };
  }
}

/** Return the times of several clips in one sorted list; of the longest clip alone if they are too many. */
function together(times) {
  if (times.length === 1) return times[0];
  const sorted = times.flatMap((one) => [...one]).sort((a, b) => a - b);
  const apart = 1e-6 * (sorted.at(-1) - sorted[0]); // closer times are equal
  const all = sorted.filter((time, k) => k === 0 || time - sorted[k - 1] > apart);
  if (all.length <= MAX_TIMES) return all;
  const longest = times.reduce((best, one) => (one.at(-1) - one[0] > best.at(-1) - best[0] ? one : best));
  return longest;
}

async function start() {
  try {
    const app = new App(await read(document));
    window.funicular = hook(app);
    window.dispatchEvent(new Event("funicular-ready"));
  } catch (error) {
    document
      .getElementById("viewer")
      .replaceChildren(
        make(
          "p",
          { id: "message", role: "alert" },
          /WebGL/i.test(error.message)
            ? "The picture needs WebGL 2, which this browser does not offer or has switched off."
            : `The page cannot be drawn: ${error.message}`,
        ),
      );
    throw error;
  }
}

start();
