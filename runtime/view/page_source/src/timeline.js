// The time line below the picture: play, a slider with events, rate, loop.

import { choice, fill, make } from "./dom.js";
import { number, scaled } from "./format.js";

const MAX_BUTTONS = 40; // largest number of events with keyboard focus

const plain = (value) => String(Number(value.toPrecision(3)));

export class Timeline {
  constructor(element, player, data) {
    this.player = player;
    this.data = data;
    this.play = make("button", {
      type: "button",
      class: "play",
      "aria-label": "Play",
      title: "Play (space)",
      onclick: () => player.toggle(),
    });
    this.slider = make("input", {
      type: "range",
      min: 0,
      step: 1,
      value: 0,
      "aria-label": data.time_label,
      oninput: () => {
        player.pause();
        player.goFrame(Number(this.slider.value));
      },
    });
    this.events = make("div", { class: "events" });
    this.readout = make("output", { class: "time", "aria-live": "off" });
    this.rate = choice("Speed of playing", [], "", (value) => (player.rate = Number(value)));
    this.rate.title = "Speed of playing";
    this.loop = make(
      "button",
      {
        type: "button",
        "aria-pressed": "true",
        "aria-label": "Loop",
        title: "Loop (l)",
        class: "toggle",
        onclick: () => this.toggleLoop(),
      },
      "\u21bb",
    );
    this.element = element;
    element.append(
      this.play,
      make("div", { class: "track" }, this.slider, this.events),
      this.readout,
      this.rate,
      this.loop,
    );
  }

  toggleLoop() {
    this.player.loop = !this.player.loop;
    this.loop.setAttribute("aria-pressed", this.player.loop);
  }

  /** Set the shown clips (numbers). A single frame has no time. */
  show(clips) {
    const { player, data } = this;
    this.element.hidden = player.times.length < 2;
    this.slider.max = player.times.length - 1;
    const suits = player.suitableRate();
    player.rate = suits;
    fill(
      this.rate,
      player.rates(suits).map((rate) => [String(rate), this.rateText(rate)]),
      String(suits),
    );
    const events = clips
      .flatMap((clip) => data.clips[clip].events.map((event) => ({ ...event, clip })))
      .sort((a, b) => a.time - b.time);
    this.events.replaceChildren(...events.map((event) => this.event(event, clips.length > 1, events.length)));
    this.happened = events;
    this.playing();
    this.update();
  }

  rateText(rate) {
    if (this.data.time_unit !== "s")
      return `${plain(rate)}${this.data.time_unit ? " " + this.data.time_unit : ""} per second`;
    if (rate === 1) return "real time";
    return rate < 1 ? `1/${plain(1 / rate)} of real time` : `${plain(rate)} \u00d7 real time`;
  }

  event({ time, label, clip }, several, count) {
    const { player, data } = this;
    const text = `${this.timeText(time)}: ${several ? data.clips[clip].label + ": " : ""}${label}`;
    const left = `left:${(100 * (time - player.first)) / (player.duration || 1)}%`;
    return make("button", {
      type: "button",
      style: left,
      title: text,
      "aria-label": text,
      tabindex: count > MAX_BUTTONS ? -1 : 0,
      onclick: () => {
        player.pause();
        player.go(time);
        player.goFrame(player.frame);
      },
    });
  }

  timeText(time) {
    const { data, player } = this;
    if (data.time_unit !== "s") return `${number(time)} ${data.time_unit}`.trim();
    const largest = Math.max(Math.abs(player.first), Math.abs(player.first + player.duration));
    const { scale, unit } = scaled("s", largest);
    const step = player.duration / Math.max(1, player.times.length - 1) / scale;
    const decimals = Math.min(6, Math.max(0, Math.ceil(-Math.log10(step || 1) + 0.5)));
    return `${(time / scale).toFixed(decimals).replace("-", "\u2212")} ${unit}`;
  }

  /** Show whether it plays. */
  playing() {
    const { playing } = this.player;
    this.play.classList.toggle("playing", playing);
    this.play.setAttribute("aria-label", playing ? "Pause" : "Play");
  }

  update() {
    const { player, data } = this;
    this.slider.value = player.frame;
    const text = this.timeText(player.time);
    this.slider.setAttribute("aria-valuetext", `${data.time_label} ${text}`);
    this.readout.textContent = data.time_unit === "s" ? text : `${data.time_label} ${text}`;
  }
}
