// Keys. A focused control keeps its own keys.

export const KEYS = [
  ["space", "play, pause"],
  ["\u2190 \u2192", "one frame back, on (with shift: ten)"],
  ["Home, End", "start, end"],
  ["1 2 3 4", "view: 3D, along x, y, z"],
  ["5", "follow a body, the next one, none"],
  ["0", "all in the picture"],
  ["[ ]", "clip before, clip after"],
  ["l", "loop"],
  ["t", "trails"],
  ["d", "dark or light"],
  ["?", "this list"],
];

/** Listen for keys; `actions` has a function for each name used here. */
export function listen(document, actions) {
  // A clicked button loses the focus, so that the space bar plays and does not press it again.
  const release = ({ detail, target }) => detail > 0 && target.closest?.("button, summary")?.blur();
  document.addEventListener("click", release, true);
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { target } = event;
    if (target.closest?.("dialog")) return;
    if (
      target.tagName === "SELECT" ||
      (target.tagName === "INPUT" && target.type !== "range" && target.type !== "checkbox")
    )
      return;
    const onButton = target.tagName === "BUTTON" || target.tagName === "SUMMARY" || target.type === "checkbox";
    if (onButton && (event.key === " " || event.key === "Enter")) return;
    const by = event.shiftKey ? 10 : 1;
    const bound = {
      " ": actions.toggle,
      ArrowLeft: () => actions.step(-by),
      ArrowRight: () => actions.step(by),
      Home: actions.home,
      End: actions.end,
      0: actions.fit,
      1: () => actions.look("3d"),
      2: () => actions.look("x"),
      3: () => actions.look("y"),
      4: () => actions.look("z"),
      5: actions.followNext,
      "[": () => actions.clip(-1),
      "]": () => actions.clip(1),
      l: actions.loop,
      t: actions.trails,
      d: actions.theme,
      "?": actions.help,
    }[event.key];
    if (!bound) return;
    event.preventDefault();
    bound();
  });
}
