// Dark or light: the setting of the system, or the choice of the reader.

const SYSTEM = matchMedia("(prefers-color-scheme: dark)");

export class Theme {
  constructor(button, changed) {
    this.chosen = null;
    this.button = button;
    this.changed = changed;
    button.addEventListener("click", () => this.toggle());
    SYSTEM.addEventListener("change", () => this.apply());
  }

  get dark() {
    return this.chosen === null ? SYSTEM.matches : this.chosen === "dark";
  }

  toggle() {
    this.chosen = this.dark ? "light" : "dark";
    this.apply();
  }

  apply() {
    document.documentElement.dataset.theme = this.dark ? "dark" : "light";
    this.button.textContent = this.dark ? "\u2600" : "\u263e";
    this.button.setAttribute("aria-label", this.dark ? "Light colours" : "Dark colours");
    this.changed();
  }

  /** Return a colour of style.css by its name. */
  colour(name) {
    return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  }
}
