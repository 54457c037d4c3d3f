"""Reports of records that are hard on a page, made by the command, and a browser to open them.

`./test report` sets PALPATE (the command) and CHROMIUM (the browser).
"""

from __future__ import annotations

import os
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from browsers import browser as browser
from playwright.sync_api import Browser, BrowserContext, Dialog, Page
from records import HOSTILE, steps, write

def command(folder: Path, *arguments: str | Path) -> subprocess.Popen[str]:
    words = [os.environ["PALPATE"], *map(str, arguments)]
    return subprocess.Popen(words, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def analyze(folder: Path, out: Path, *arguments: str | Path) -> subprocess.Popen[str]:
    return command(folder, "analyze", *arguments, "--out", out)


@dataclass
class Reports:
    """The pages under test."""

    many: Path
    long: Path
    hostile: Path
    index: Path
    paper: Path
    series: Path


@pytest.fixture(scope="session")
def reports(tmp_path_factory: pytest.TempPathFactory) -> Reports:
    folder = tmp_path_factory.mktemp("reports")
    # A million rows: a hundred times as many as a page can show.
    long = write(folder / "long.csv", steps([4.0, 2.0], 499.0, 1000.0, 2))
    works = [analyze(folder, folder / "long", long, "--no-compare", "--exponents", "5", "--intervals", "curvature")]
    levels = [3.0, 1.5, 5.0, 2.0] * 6
    many = write(folder / "many.csv", steps(levels, 12.0, 12.0, 1))
    works.append(analyze(folder, folder / "many", many))
    # A law of seven parameters.
    two = write(folder / "two.csv", steps([3.0, 1.0], 12.0, 12.0, 3))
    works.append(command(folder, "compare", two, "--laws", "prony:3", "--out", folder / "series"))
    # Names from files and descriptions reach titles, addresses, tables and legends.
    names = ["=1+1 @SUM(A1) & 'x'", "a\"onmouseover=alert(1) <b>"]
    described = folder / "hostile.toml"
    described.write_text(f"[about]\ntitle = '''{HOSTILE}'''\n")
    pads = [write(folder / f"{name}.csv", steps([3.0, 1.0], 12.0, 12.0, 3 + k)) for k, name in enumerate(names)]
    works.append(analyze(folder, folder / "set", *pads, "--test", described))
    works.append(command(folder, "reproduce", "--seeds", "2", "--out", folder / "paper"))
    for work in works:
        messages = work.communicate()[1]
        assert work.returncode == 0, messages
    hostile = sorted((folder / "set").glob("*/report.html"))
    assert len(hostile) == 2
    pages = [folder / f"{name}/report.html" for name in ("many", "long", "paper")]
    return Reports(pages[0], pages[1], hostile[0], folder / "set/index.html", pages[2], folder / "series/report.html")


@dataclass
class Opened:
    """A page with all that it requested and reported."""

    page: Page
    context: BrowserContext
    requests: list[str] = field(default_factory=list)
    messages: list[str] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)

    def is_quiet(self) -> bool:
        own = [url for url in self.requests if not url.startswith("data:")]
        assert own == [self.page.url.split("#")[0]], own
        assert self.messages == []
        return True


def opened(browser: Browser, path: Path, width: int = 1280, *, script: bool = True) -> Opened:
    context = browser.new_context(viewport={"width": width, "height": 900}, java_script_enabled=script)
    page = context.new_page()
    found = Opened(page, context)
    page.on("request", lambda request: found.requests.append(request.url))
    page.on("requestfailed", lambda request: found.failures.append(request.failure or ""))
    page.on("console", lambda message: found.messages.append(message.text))
    page.on("pageerror", lambda error: found.messages.append(str(error)))

    def refuse(dialog: Dialog) -> None:
        found.messages.append(dialog.message)
        dialog.dismiss()

    page.on("dialog", refuse)
    page.goto(path.as_uri())
    return found


def opened_whole(browser: Browser, path: Path) -> Opened:
    """A page with all of its sections open."""
    found = opened(browser, path)
    found.page.get_by_role("button", name="Open all sections").click()
    return found
