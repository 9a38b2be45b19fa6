// Elements of the page.

/** Return an element; attributes by name, `on...` functions as listeners, children as elements or text. */
export function make(name, attributes = {}, ...children) {
  return filled(document.createElement(name), attributes, children);
}

/** Return an SVG element. */
export function svg(name, attributes = {}, ...children) {
  return filled(document.createElementNS("http://www.w3.org/2000/svg", name), attributes, children);
}

function filled(element, attributes, children) {
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (value === true) element.setAttribute(key, "");
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(key, value);
  }
  element.append(...children);
  return element;
}

/** Return a <select> with a label before it; `options`: [value, text]. */
export function choice(label, options, value, onchange, attributes = {}) {
  const select = make("select", { ...attributes, "aria-label": label, onchange: () => onchange(select.value) });
  fill(select, options, value);
  return select;
}

export function fill(select, options, value) {
  select.replaceChildren(
    ...options.map(([key, text]) => make("option", { value: key, selected: key === value }, text)),
  );
  select.value = value;
}
