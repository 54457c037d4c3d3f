"""Labs that were started by the command, and pages of them in a browser.

`./test lab` sets PALPATE (the command) and CHROMIUM (the browser). With LAB_PICTURES=FOLDER the tests leave pictures of the page there,
which the guide shows.
"""

from __future__ import annotations

import base64
import os
import signal
import subprocess
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import axe_playwright_python
import pytest
from browsers import browser as browser
from playwright.sync_api import Browser, BrowserContext, Dialog, Page

EXAMPLES = Path(__file__).parents[4] / "examples/records"
AXE = (Path(axe_playwright_python.__file__).parent / "axe.min.js").read_text()
# Times on a machine that does other things too.
PATIENCE = float(os.environ.get("PALPATE_PATIENCE", "3"))


@dataclass
class Lab:
    """A lab in a process of its own."""

    process: subprocess.Popen[str]
    address: str
    folder: Path | None

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()

    def end(self) -> None:
        self.process.send_signal(signal.SIGINT)
        self.process.wait(10)


def started(folder: Path | None, *options: str, under: Sequence[str] = ()) -> Lab:
    """A lab, started by the command `under` where that is given."""
    words = [*under, os.environ["PALPATE"], "lab", *([str(folder)] if folder else []), "--no-open", *options]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    address = process.stdout.readline().strip()
    assert address.startswith("http://127.0.0.1:"), address
    return Lab(process, address, folder)


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[Lab]:
    folder = tmp_path / "records"
    folder.mkdir()
    lab = started(folder)
    yield lab
    lab.end()


@dataclass
class Opened:
    """A page of a lab, with all that went wrong on it."""

    page: Page
    context: BrowserContext
    messages: list[str] = field(default_factory=list)
    foreign: list[str] = field(default_factory=list)

    def drop(self, *files: Path) -> None:
        """Drops files onto the page, as from a file manager."""
        sent = [{"name": file.name, "text": base64.b64encode(file.read_bytes()).decode()} for file in files]
        self.page.evaluate(
            """(files) => {
                const data = new DataTransfer();
                for (const { name, text } of files)
                    data.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
                document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
            }""",
            sent,
        )

    def wait(self, selector: str, seconds: float = 20.0) -> None:
        self.page.wait_for_selector(selector, timeout=1000 * seconds * PATIENCE)

    def click(self, selector: str) -> None:
        """Scrolls there first: a click in the frame of the scroll goes to where a frame of another process was before."""
        self.page.locator(selector).scroll_into_view_if_needed()
        self.page.wait_for_timeout(200)
        self.page.click(selector)

    def settle(self, seconds: float = 40.0) -> None:
        """Waits until no task of the page runs."""
        end, quiet = time.monotonic() + seconds * PATIENCE, 0
        while time.monotonic() < end:
            quiet = quiet + 1 if self.page.locator(".progress").count() == 0 else 0
            if quiet >= 4:
                return
            self.page.wait_for_timeout(60)
        raise AssertionError("the page does not come to rest")

    def accessible(self) -> bool:
        """No violation of WCAG 2.2 AA or of best practice that axe-core finds, and nothing wider than the page."""
        self.page.evaluate(AXE)
        tags = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
        found = self.page.evaluate("(tags) => axe.run(document, { runOnly: tags, iframes: false })", tags)
        violations = [(one["id"], [node["html"][:160] for node in one["nodes"][:3]]) for one in found["violations"]]
        assert violations == []
        width = self.page.evaluate("[document.documentElement.scrollWidth, innerWidth]")
        assert width[0] <= width[1], width
        return True

    def picture(self, name: str, selector: str | None = None) -> None:
        if folder := os.environ.get("LAB_PICTURES"):
            path = str(Path(folder) / f"lab-{name}.png")
            self.page.evaluate("document.querySelector('#place').textContent = 'measurements'; document.activeElement.blur()")
            self.page.wait_for_timeout(300)
            if selector:
                self.page.locator(selector).screenshot(path=path)
            else:
                self.page.screenshot(path=path)


def opened(browser: Browser, address: str, width: int = 1280) -> Opened:
    context = browser.new_context(viewport={"width": width, "height": 900}, accept_downloads=True)
    page = context.new_page()
    found = Opened(page, context)
    own = address.split("/")[2]
    page.on("request", lambda request: found.foreign.append(request.url) if own not in request.url else None)
    page.on("console", lambda message: found.messages.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: found.messages.append(str(error)))

    def refuse(dialog: Dialog) -> None:
        found.messages.append(f"dialog {dialog.message}")
        dialog.dismiss()

    page.on("dialog", refuse)
    page.goto(address)
    found.wait("#list li, .welcome")
    return found
