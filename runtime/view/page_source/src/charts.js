// Curves beside the picture: any result over time, a cursor at the current time, a click to go to a time.

import { SERIES } from "./colours.js";
import { choice, fill, make, svg } from "./dom.js";
import { number, scaled, tick, ticks } from "./format.js";
import { isOutside, sampleAt } from "./sampling.js";

const HEIGHT = 150;
const FRAME = { left: 46, right: 10, top: 8, bottom: 20 };
const DASHES = ["", "6 3", "2 2", "8 3 2 3"];

/** Return the results of a clip: its curves and the quantities of its bodies. */
export function curvesOf(clip) {
  const single = clip.curves.map((curve) => ({
    key: curve.key,
    label: curve.label,
    unit: curve.unit,
    columns: columnsOf(curve.values, curve.columns, curve.time),
  }));
  for (const body of clip.time.length > 1 ? clip.bodies : []) {
    for (const { label, unit, values } of body.quantities) {
      single.push({
        key: `body:${body.name}:${label}`,
        label: `${body.name}: ${label}`,
        unit,
        columns: columnsOf(values, [], clip.time),
      });
    }
  }
  return single;
}

function columnsOf(array, names, time) {
  const count = names.length || 1;
  return Array.from({ length: count }, (_, c) => ({
    name: names[c] ?? "",
    time,
    at: (row) => array.values[row * count + c],
  }));
}

export class Charts {
  /** `element`: for the charts; `player`: receives clicks; `data`: the header. */
  constructor(element, player, data) {
    this.element = element;
    this.player = player;
    this.data = data;
    this.list = make("div", { class: "charts" });
    this.add = make("button", { type: "button", class: "add", onclick: () => this.open() }, "+ curve");
    element.append(this.list, this.add);
    this.charts = [];
    new ResizeObserver(() => this.draw()).observe(this.list);
  }

  /** Set the shown clips (numbers); `dark`: whether to use the colours of dark pages. */
  show(clips, dark) {
    this.clips = clips;
    this.series = SERIES[dark ? "dark" : "light"];
    this.curves = clips.map((clip) => curvesOf(this.data.clips[clip]));
    this.keys = new Map(this.curves.flat().map((curve) => [curve.key, curve.label]));
    this.element.hidden = this.keys.size === 0;
    if (!this.charts.length) this.initial().forEach((key) => this.open(key, false));
    else this.charts.forEach((chart) => chart.options());
    this.draw();
  }

  /** The initial choice: two results and the energies. */
  initial() {
    const keys = [...this.keys.keys()];
    const energy = keys.filter((key) => key === "energy");
    const others = keys.filter((key) => !key.startsWith("energy"));
    return [...others.slice(0, 3 - energy.length), ...energy];
  }

  open(key = null, draw = true) {
    const shown = new Set(this.charts.map((chart) => chart.key));
    const next = key ?? [...this.keys.keys()].find((one) => !shown.has(one)) ?? this.keys.keys().next().value;
    const chart = new Chart(this, next);
    this.charts.push(chart);
    this.list.append(chart.element);
    if (draw) chart.draw();
  }

  close(chart) {
    this.charts = this.charts.filter((one) => one !== chart);
    chart.element.remove();
  }

  draw() {
    this.charts.forEach((chart) => chart.draw());
  }

  /** Move the cursors to a time. */
  update(time) {
    this.charts.forEach((chart) => chart.update(time));
  }
}

class Chart {
  constructor(charts, key) {
    this.charts = charts;
    this.key = key;
    this.select = choice("Curve", [], key, (chosen) => {
      this.key = chosen;
      this.draw();
    });
    const close = make(
      "button",
      {
        type: "button",
        class: "close",
        "aria-label": "Remove this curve",
        title: "Remove",
        onclick: () => charts.close(this),
      },
      "\u00d7",
    );
    this.unit = make("span", { class: "unit" });
    this.plot = svg("svg", { class: "plot", role: "img", height: HEIGHT });
    this.legend = make("div", { class: "legend" });
    this.element = make(
      "section",
      { class: "chart" },
      make("div", { class: "head" }, this.select, this.unit, close),
      this.plot,
      this.legend,
    );
    const go = (event) => {
      const { left } = this.plot.getBoundingClientRect();
      const { first, duration } = charts.player;
      const at = (event.clientX - left - FRAME.left) / (this.width - FRAME.left - FRAME.right);
      charts.player.pause();
      charts.player.go(first + Math.min(1, Math.max(0, at)) * duration);
      charts.player.goFrame(charts.player.frame);
    };
    this.plot.addEventListener("pointerdown", (event) => {
      this.plot.setPointerCapture(event.pointerId);
      go(event);
    });
    this.plot.addEventListener("pointermove", (event) => {
      if (event.buttons & 1) go(event);
    });
    this.options();
  }

  options() {
    if (!this.charts.keys.has(this.key)) this.key = this.charts.keys.keys().next().value;
    fill(this.select, [...this.charts.keys], this.key);
  }

  /** The lines of this chart: columns of the curve in each clip. */
  lines() {
    const { charts } = this;
    const several = charts.clips.length > 1;
    return charts.clips.flatMap((clip, k) => {
      const curve = charts.curves[k].find(({ key }) => key === this.key);
      return (curve?.columns ?? []).map((column, c) => ({
        ...column,
        unit: curve.unit,
        colour: charts.series[(several ? k : c) % charts.series.length],
        dash: DASHES[(several ? c : Math.floor(c / charts.series.length)) % DASHES.length],
        name: [several ? charts.data.clips[clip].label : "", column.name].filter(Boolean).join(" "),
        period: charts.data.clips[clip].period,
      }));
    });
  }

  draw() {
    const { player } = this.charts;
    this.width = this.element.clientWidth;
    if (!this.width) return;
    this.drawn = this.lines();
    const [low, high] = extremes(this.drawn);
    const { scale, unit } = scaled(this.drawn[0]?.unit ?? "", Math.max(Math.abs(low), Math.abs(high)));
    this.scale = scale;
    this.finest = ((high - low) / scale) * 1e-4; // smaller digits are below the resolution of the curve
    this.unit.textContent = unit;
    const width = this.width - FRAME.left - FRAME.right;
    const height = HEIGHT - FRAME.top - FRAME.bottom;
    const duration = player.duration || 1;
    this.x = (time) => FRAME.left + ((time - player.first) / duration) * width;
    this.y = (value) => FRAME.top + height - ((value - low) / (high - low)) * height;
    this.cursor = svg("line", { class: "cursor", y1: FRAME.top, y2: FRAME.top + height });
    this.dots = this.drawn.map(({ colour }) => svg("circle", { r: 3.5, fill: colour, class: "dot" }));
    this.plot.setAttribute("width", this.width);
    this.plot.setAttribute("viewBox", `0 0 ${this.width} ${HEIGHT}`);
    this.plot.setAttribute(
      "aria-label",
      `${this.charts.keys.get(this.key)}, from ${number(low / scale)} to ${number(high / scale)} ${unit}`,
    );
    this.plot.replaceChildren(
      ...this.axes(low, high, scale),
      ...this.drawn.map((one) => this.path(one)),
      this.cursor,
      ...this.dots,
    );
    this.values = this.drawn.map(() => make("b"));
    this.legend.replaceChildren(
      ...this.drawn.map(({ name, colour, dash }, k) =>
        make(
          "span",
          {},
          svg(
            "svg",
            { width: 18, height: 8, "aria-hidden": "true" },
            svg("line", { x1: 0, x2: 18, y1: 4, y2: 4, stroke: colour, "stroke-width": 2.2, "stroke-dasharray": dash }),
          ),
          name ? ` ${name} ` : " ",
          this.values[k],
        ),
      ),
    );
    this.update(player.time);
  }

  axes(low, high, scale) {
    const { player, data } = this.charts;
    const parts = [];
    const text = (content, attributes) => svg("text", attributes, content);
    const vertical = ticks(low / scale, high / scale, 6);
    for (const value of vertical) {
      const y = this.y(value * scale);
      parts.push(
        svg("line", {
          class: value === 0 ? "zero" : "rule",
          x1: FRAME.left,
          x2: this.width - FRAME.right,
          y1: y,
          y2: y,
        }),
        text(tick(value, vertical[1] - vertical[0] || 1), { x: FRAME.left - 5, y: y + 3.5, "text-anchor": "end" }),
      );
    }
    const end = player.first + player.duration;
    const { scale: by, unit } =
      data.time_unit === "s" ? scaled("s", Math.max(Math.abs(end), 1e-12)) : { scale: 1, unit: data.time_unit };
    const horizontal = ticks(player.first / by, end / by, Math.max(2, Math.floor(this.width / 75)));
    const name = unit ? `${data.time_label} / ${unit}` : data.time_label;
    const edge = this.width - FRAME.right - 7 * name.length;
    for (const value of horizontal) {
      const x = this.x(value * by);
      parts.push(svg("line", { class: "rule", x1: x, x2: x, y1: FRAME.top, y2: HEIGHT - FRAME.bottom }));
      if (x < edge)
        parts.push(
          text(tick(value, horizontal[1] - horizontal[0] || 1), { x, y: HEIGHT - 6, "text-anchor": "middle" }),
        );
    }
    parts.push(text(name, { x: this.width - FRAME.right, y: HEIGHT - 6, "text-anchor": "end" }));
    return parts;
  }

  path({ time, at, colour, dash }) {
    let d = "";
    let pen = "M";
    for (let row = 0; row < time.length; row++) {
      const value = at(row);
      if (Number.isFinite(value)) {
        d += `${pen}${this.x(time[row]).toFixed(1)} ${this.y(value).toFixed(1)}`;
        pen = "L";
      } else {
        pen = "M";
      }
    }
    return svg("path", { class: "curve", d, stroke: colour, "stroke-dasharray": dash });
  }

  update(time) {
    if (!this.x) return;
    this.cursor.setAttribute("x1", this.x(time));
    this.cursor.setAttribute("x2", this.x(time));
    this.drawn.forEach((one, k) => {
      const { i, j, w } = sampleAt(one.time, time, one.period);
      const value = w === 0 ? one.at(i) : one.at(i) + w * (one.at(j) - one.at(i));
      const valid = Number.isFinite(value) && !isOutside(one.time, time, one.period);
      this.values[k].textContent = valid ? number(value / this.scale, 4, this.finest) : "\u2013";
      this.dots[k].setAttribute("visibility", valid ? "visible" : "hidden");
      if (!valid) return;
      this.dots[k].setAttribute("cx", this.x(time));
      this.dots[k].setAttribute("cy", this.y(value));
    });
  }
}

/** Return the range of an axis: that of the values with a margin, never empty. */
function extremes(lines) {
  let low = Infinity;
  let high = -Infinity;
  for (const { time, at } of lines) {
    for (let row = 0; row < time.length; row++) {
      const value = at(row);
      if (!Number.isFinite(value)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  if (!(high >= low)) return [0, 1];
  const margin = 0.06 * (high - low) || 0.1 * Math.abs(high) || 1;
  return [low - margin, high + margin];
}
