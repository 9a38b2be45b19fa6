"""A headless browser for the tests and the benchmark of the page."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
OPTIONS = ["--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
           "--disable-component-update", "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
PATIENCE = 120_000  # ms: machines may be busy


@contextmanager
def browser() -> Iterator:
    """Yield a browser with software rendering. Raises RuntimeError without one."""
    from playwright.sync_api import sync_playwright

    path = next(filter(None, map(shutil.which, NAMES)), None)
    if path is None:
        raise RuntimeError(f"no browser: none of {', '.join(NAMES)} is installed (Debian: apt-get install chromium)")
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=path, args=OPTIONS)
        try:
            yield started
        finally:
            started.close()


class Opened:
    """A page in a browser, with its messages and requests."""

    def __init__(self, browser, path: Path, **settings) -> None:
        """settings: of a browser context, such as viewport and color_scheme. There is no network; modes do not move."""
        self.context = browser.new_context(**({"offline": True, "reduced_motion": "reduce"} | settings))
        self.page = self.context.new_page()
        self.page.set_default_timeout(PATIENCE)
        self.said: list[str] = []
        self.asked: list[str] = []
        self.page.on("console", lambda message: self.said.append(message.text))
        self.page.on("pageerror", lambda error: self.said.append(str(error)))
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.goto(path.as_uri())
        self.page.evaluate("""() => new Promise((done) => {
            if (window.funicular) done();
            window.addEventListener("funicular-ready", () => done());
        })""")

    def __call__(self, script: str, argument=None):
        """Return the value of a script; ``f`` in it is window.funicular, ``a`` the argument."""
        return self.page.evaluate(f"(a) => {{ const f = window.funicular; return {script}; }}", argument)

    def wait(self, condition: str) -> None:
        """Wait until a condition of ``f`` holds; the content policy of the page forbids playwright's way."""
        self.page.evaluate(f"""() => new Promise((done) => {{
            const look = () => {{
                const f = window.funicular;
                if ({condition}) done();
                else setTimeout(look, 20);
            }};
            look();
        }})""")

    def drawn(self) -> None:
        """Wait until the picture is drawn."""
        self.page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
