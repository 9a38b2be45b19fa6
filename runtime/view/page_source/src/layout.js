// The parts of the page: the picture with its overlays, the time line, the curves, the notes.

import { make } from "./dom.js";

/** Fill `root` and return its parts by name. */
export function layout(root, data) {
  const parts = {
    canvas: make("canvas", { tabindex: 0, role: "img" }),
    clip: make("div", { class: "clips" }),
    views: make("div", { class: "views", role: "group", "aria-label": "View" }),
    options: make("div", { class: "options" }),
    legend: make("div", { class: "colours", role: "note" }),
    badge: make("div", { class: "badge", role: "status" }),
    rulers: make("div", { class: "rulers" }),
    tip: make("div", { class: "tip", role: "tooltip", hidden: true }),
    timeline: make("div", { class: "timeline", role: "group", "aria-label": data.time_label }),
    curves: make("div", { class: "curves" }),
    notes: make("div", { class: "notes" }),
    theme: make("button", { type: "button", class: "theme", title: "Dark or light (d)" }),
    help: make("button", { type: "button", title: "Keys (?)", "aria-label": "Keys" }, "?"),
    dialog: make("dialog", { "aria-label": "Keys" }),
  };
  parts.aside = make("aside", { "aria-label": "Curves and notes" }, parts.curves, parts.notes);
  const settings = make("details", { class: "settings" }, make("summary", {}, "Display"), parts.options);
  parts.picture = make(
    "div",
    { class: "picture" },
    parts.canvas,
    make("div", { class: "over left" }, settings),
    make("div", { class: "over right" }, parts.legend),
    parts.badge,
    parts.rulers,
    parts.tip,
  );
  root.replaceChildren(
    make(
      "header",
      {},
      make("h1", {}, data.title),
      parts.clip,
      parts.views,
      make("div", { class: "buttons" }, parts.theme, parts.help),
    ),
    make("main", {}, make("div", { class: "stage" }, parts.picture, parts.timeline), parts.aside),
    parts.dialog,
  );
  return parts;
}
