"""The lab in a browser: how fast the page follows a hand, and whether it stays responsive under large files.

    CHROMIUM=/usr/bin/chromium python validation/lab.py PALPATE [--only NAME] [--write]

PALPATE is the command, built for release; the Python that runs this needs NumPy and Playwright, as the environment of `./test lab` has them.
Files are handed to the page by its file field, which takes the same way as a drop. A frame gap is the time between two calls of
requestAnimationFrame. Times run from the moment at which the files are handed over. With --write the table goes to docs/validation/lab.md.
Exit code 1 if a figure is not as required. The limits are those of an otherwise idle machine; the load before each part is stated.
"""

import argparse
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import tempfile
import time
import zipfile
from dataclasses import dataclass

import numpy as np
from playwright.sync_api import sync_playwright

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "crates/palpate-report/tests/browser"))
from records import steps, write  # noqa: E402

PAGE = ROOT / "docs" / "validation" / "lab.md"
RECORDS = ROOT / "examples" / "records"
DRAG_S = 2.0
LARGE_BYTES = 200e6
CURVES = 500
FILES = 20
# What a page may keep a person waiting for between two frames.
LONGEST_GAP_MS = 200
PATIENCE_MS = 300_000

# Frames of the page from the last call of `begin` on.
FRAMES = """
window.frames = { begin() { this.worst = this.count = 0; this.from = this.last = performance.now(); } };
frames.begin();
const tick = () => {
    const now = performance.now();
    frames.worst = Math.max(frames.worst, now - frames.last);
    frames.last = now;
    frames.count += 1;
    requestAnimationFrame(tick);
};
requestAnimationFrame(tick);
"""


@dataclass
class Figure:
    """A figure, and what it has to be: at most, or at least."""

    part: str
    what: str
    value: float
    unit: str
    most: float | None = None
    least: float | None = None

    def is_good(self):
        return (self.most is None or self.value <= self.most) and (self.least is None or self.value >= self.least)

    def row(self):
        shown = lambda value: f"{value:.3g}" if value < 1000 else f"{value:.0f}"
        required = f"at most {shown(self.most)}" if self.most is not None else f"at least {shown(self.least)}" if self.least is not None else ""
        return f"| {self.part} | {self.what} | {shown(self.value)} {self.unit} | {required} |"


class Opened:
    """A lab in a folder of its own, and its page."""

    def __init__(self, palpate, browser, scratch, *files):
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=scratch))
        for file, name in files:
            shutil.copy(file, self.folder / name)
        self.process = subprocess.Popen([palpate, "lab", self.folder, "--no-open"], stdout=subprocess.PIPE, text=True)
        self.browser = browser
        self.context = browser.new_context(viewport={"width": 1280, "height": 900})
        self.page = self.context.new_page()
        self.page.add_init_script(FRAMES)
        self.page.goto(self.process.stdout.readline().strip())
        self.wait("#list li, .welcome")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.context.close()
        self.process.kill()
        self.process.wait()
        shutil.rmtree(self.folder)

    def wait(self, selector):
        """The time at which it is there."""
        self.page.wait_for_selector(selector, timeout=PATIENCE_MS)
        return time.monotonic()

    def hand(self, *files):
        """Hands files over, and returns when."""
        self.page.evaluate("frames.begin()")
        began = time.monotonic()
        self.page.set_input_files("#choose", files)
        return began

    def worst_gap_ms(self):
        return self.page.evaluate("Math.max(frames.worst, performance.now() - frames.last)")

    def server_mb(self):
        """The most memory that the lab has used."""
        return peak_mb(self.process.pid)

    def page_mb(self):
        """The most memory that the process of the page has used."""
        session = self.browser.new_browser_cdp_session()
        processes = session.send("SystemInfo.getProcessInfo")["processInfo"]
        session.detach()
        return max(peak_mb(one["id"]) for one in processes if one["type"] == "renderer")


def peak_mb(process):
    status = pathlib.Path(f"/proc/{process}/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) * 1024 / 1e6


def sliders(lab, scratch):
    """A hand drags the slider of the mass to and fro."""
    with lab((RECORDS / "ball-material.toml", "ball.material.toml")) as opened:
        page = opened.page
        page.get_by_role("button", name="ball.material.toml").click()
        opened.wait(".grip-panel figure")
        page.evaluate(
            """() => {
                window.answers = [];
                const text = (selector) => document.querySelector(selector).innerHTML;
                document.addEventListener("tried", () => answers.push(text(".verdict") + text(".tried > .small") + text(".try-figure").replace(/box-[0-9]+/g, "")));
            }"""
        )
        page.locator("#grip-mass").scroll_into_view_if_needed()
        box = page.locator("#grip-mass").bounding_box()
        place = lambda share: (box["x"] + (0.1 + 0.8 * share) * box["width"], box["y"] + box["height"] / 2)
        page.mouse.move(*place(0.0))
        page.mouse.down()
        page.evaluate("frames.begin(); answers.length = 0")
        began = time.monotonic()
        while (lasted := time.monotonic() - began) < DRAG_S:
            page.mouse.move(*place(abs(2 * (lasted / DRAG_S) - 1)))
            time.sleep(0.004)
        answers = page.evaluate("answers")
        lasted = time.monotonic() - began
        worst, count = opened.worst_gap_ms(), page.evaluate("frames.count")
        page.mouse.up()
        verdicts = {answer.split(" ")[0] for answer in answers}
        yield Figure("sliders", "answers shown a second, while dragging", len(answers) / lasted, "1/s", least=30)
        yield Figure("sliders", "of these, other than the one before", sum(a != b for a, b in zip(answers, answers[1:])) / lasted, "1/s", least=25)
        yield Figure("sliders", "verdicts that occurred", len(verdicts), "", least=2)
        yield Figure("sliders", "frames a second", count / lasted, "1/s", least=30)
        yield Figure("sliders", "longest frame gap", worst, "ms", most=LONGEST_GAP_MS)


def drop(lab, scratch):
    """The first figure of a record, and its law."""
    with lab() as opened:
        began = opened.hand(RECORDS / "ball.csv")
        yield Figure("ball.csv", "figure with its holds", opened.wait("#record figure") - began, "s", most=1)
        yield Figure("ball.csv", "law and answer", opened.wait("#laws .lede") - began, "s", most=2)
    record = write(scratch / "1e5.csv", steps([4.0, 2.0], 499.0, 100.0, 2))
    with lab() as opened:
        began = opened.hand(record)
        yield Figure("10⁵ rows", "figure with its holds", opened.wait("#record figure") - began, "s", most=1)
        yield Figure("10⁵ rows", "law and answer", opened.wait("#laws .lede") - began, "s")
        yield Figure("10⁵ rows", "longest frame gap", opened.worst_gap_ms(), "ms", most=LONGEST_GAP_MS)


def large(lab, scratch):
    """One file of 200 MB: its reading ended by the button and begun again, its figure, then its laws, ended by the button too."""
    record = scratch / "large.csv"
    rows = 1_000_000
    block = steps([4.0, 2.0, 3.0, 1.0], 1249.0, rows / 5000, 3)
    lines = 0
    with record.open("w") as text:
        text.write("Time (s),Displacement (mm),Force (N)\n")
        while text.tell() < LARGE_BYTES:
            np.savetxt(text, block, delimiter=",", fmt="%.5f")
            block[:, 0] += block[-1, 0] + 0.005 - block[0, 0]
            lines += len(block)
    yield Figure("200 MB", f"size of the file, {lines / 1e6:.2g} million rows", record.stat().st_size / 1e6, "MB")
    with lab() as opened:
        page = opened.page

        def cancelled(box):
            began = time.monotonic()
            page.locator(box).get_by_role("button", name="Cancel").click()
            return opened.wait(f"{box} p:has-text('Cancelled.')") - began

        began = opened.hand(record)
        yield Figure("200 MB", "is listed", opened.wait("#list li") - began, "s")
        opened.wait("#record progress[value]")
        heard = page.evaluate(
            """async () => {
                const values = new Set();
                for (let turn = 0; turn < 20; turn++) {
                    values.add(document.querySelector("#record progress")?.value);
                    await new Promise((resolve) => setTimeout(resolve, 100));
                }
                return values.size;
            }"""
        )
        yield Figure("200 MB", "states of the progress of reading, in 2 s", heard, "", least=5)
        yield Figure("200 MB", "reading ends after its button", cancelled("#record"), "s", most=3)
        began = time.monotonic()
        page.get_by_role("button", name="large.csv", exact=True).click()
        yield Figure("200 MB", "figure with its holds, opened again", opened.wait("#record figure") - began, "s")
        opened.wait("#laws progress[value]")
        page.wait_for_timeout(1000)
        yield Figure("200 MB", "analysis ends after its button", cancelled("#laws"), "s", most=1)
        yield Figure("200 MB", "longest frame gap", opened.worst_gap_ms(), "ms", most=LONGEST_GAP_MS)
        yield Figure("200 MB", "most memory of the lab", opened.server_mb(), "MB", most=2000)
        yield Figure("200 MB", "most memory of the page", opened.page_mb(), "MB", most=1000)
    record.unlink()


def curve(number, noise):
    """A force curve as JPK exports it as text: approach, a hold in which the force relaxes, retract."""
    relaxed = 1e-9 * (1 + noise.random())
    height = np.r_[np.linspace(2e-6, -1e-6, 200), np.full(300, -1e-6), np.linspace(-1e-6, 2e-6, 100)]
    times = np.r_[np.linspace(0, 1, 200), 1 + np.linspace(0.01, 3, 300), 4.01 + np.linspace(0, 0.5, 100)]
    depth = np.maximum(0, -height) * 1e6
    force = relaxed * depth**1.5
    force[200:500] = relaxed * (0.6 + 0.4 * (1 + 8 * (times[200:500] - 1)) ** -0.25)
    force += 5e-12 * noise.standard_normal(force.size)
    x, y = number % 25, number // 25
    text = [f"# index: {number}\n# xPosition: {x * 1e-6}\n# yPosition: {y * 1e-6}\n"]
    for segment, (style, start, end) in enumerate([("extend", 0, 200), ("pause", 200, 500), ("retract", 500, 600)]):
        text.append(f"# segmentIndex: {segment}\n# segment: {style}\n# columns: measuredHeight vDeflection seriesTime\n# units: m N s\n# sensitivity: 4.0E-8\n# springConstant: 0.05\n#\n")
        text += [f"{height[i]:.6e} {force[i]:.6e} {times[i]:.6f}\n" for i in range(start, end)]
        text.append("\n")
    return "".join(text)


def curves(lab, scratch):
    """A ZIP archive of force curves with positions."""
    archive = scratch / "map.zip"
    noise = np.random.default_rng(4)
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
        for number in range(CURVES):
            packed.writestr(f"curve-{number:03}.txt", curve(number, noise))
    with lab() as opened:
        part = f"{CURVES} curves"
        page = opened.page
        began = opened.hand(archive)
        yield Figure(part, "first row", opened.wait("#each tbody tr") - began, "s", most=2)
        opened.wait("#map figure")
        yield Figure(part, "all rows and the map", time.monotonic() - began, "s", most=60)
        yield Figure(part, "rows", page.locator("#each tbody tr").count(), "", least=CURVES, most=CURVES)
        yield Figure(part, "longest frame gap", opened.worst_gap_ms(), "ms", most=LONGEST_GAP_MS)
        page.evaluate("frames.begin()")
        sorting = page.evaluate(
            """async () => {
                const began = performance.now();
                [...document.querySelectorAll("#each thead button")].find((one) => one.textContent === "n").click();
                await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
                return performance.now() - began;
            }"""
        )
        yield Figure(part, "sorted by n and shown", sorting, "ms", most=LONGEST_GAP_MS)
        column = 2 + [text.strip() for text in page.locator("#each thead th").all_inner_texts()].index("n") - 2
        shown = page.eval_on_selector_all("#each tbody tr", "(rows, column) => rows.map((row) => Number(row.children[column]?.textContent ?? NaN))", column)
        numbers = [value for value in shown if np.isfinite(value)]
        yield Figure(part, "rows out of order then", sum(a > b for a, b in zip(numbers, numbers[1:])), "", most=0)


def many(lab, scratch):
    """Twenty files of a million rows each, at once."""
    first = write(scratch / "many-00.csv", steps([4.0, 2.0], 499.0, 1000.0, 5))
    files = [first]
    for number in range(1, FILES):
        files.append(scratch / f"many-{number:02}.csv")
        os.link(first, files[-1])
    with lab() as opened:
        part = f"{FILES} files of 10⁶ rows"
        began = opened.hand(*files)
        yield Figure(part, "first figure", opened.wait("#record figure") - began, "s")
        opened.page.wait_for_function(f"document.querySelectorAll('#list li').length === {FILES} && !document.querySelector('#uploads li')", timeout=PATIENCE_MS)
        yield Figure(part, f"all {FILES * first.stat().st_size / 1e6:.0f} MB are in the folder", time.monotonic() - began, "s")
        yield Figure(part, "law and answer of the first", opened.wait("#laws .lede") - began, "s")
        yield Figure(part, "longest frame gap", opened.worst_gap_ms(), "ms", most=LONGEST_GAP_MS)
        yield Figure(part, "most memory of the lab", opened.server_mb(), "MB", most=2000)
        yield Figure(part, "most memory of the page", opened.page_mb(), "MB", most=1000)
    for file in files:
        file.unlink()


PARTS = {"sliders": sliders, "drop": drop, "large": large, "curves": curves, "many": many}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("palpate", type=pathlib.Path)
    parser.add_argument("--only", choices=PARTS, help="one part")
    parser.add_argument("--write", action="store_true", help="write the table to docs/validation/lab.md")
    requested = parser.parse_args()
    if requested.only and requested.write:
        parser.error("the page states all parts: leave out --only")
    palpate = requested.palpate.resolve()
    figures, loads = [], []
    with tempfile.TemporaryDirectory(prefix="lab-") as scratch, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=os.environ["CHROMIUM"], args=["--no-sandbox"])
        scratch = pathlib.Path(scratch)
        for name, part in PARTS.items():
            if requested.only not in {None, name}:
                continue
            loads.append(os.getloadavg()[0])
            print(f"{name}, load {loads[-1]:.2f}", file=sys.stderr, flush=True)
            for figure in part(lambda *files: Opened(palpate, browser, scratch, *files), scratch):
                figures.append(figure)
                print(figure.row(), "" if figure.is_good() else "FAILED", file=sys.stderr, flush=True)
        chromium = browser.version
        browser.close()
    version = subprocess.run([palpate, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
    failures = [figure for figure in figures if not figure.is_good()]
    page = f"""# The lab

`palpate lab` {version} in Chromium {chromium.split(".")[0]} without a window, on one machine with it. Figures that are not as required: {len(failures)} of {len(figures)}. One
command writes this page:

```sh
CHROMIUM=/usr/bin/chromium python validation/lab.py PALPATE --write
```

| what | figure | measured | required |
|---|---|--:|---|
{chr(10).join(figure.row() for figure in figures)}

{platform.system()} {platform.release().split("-")[0]}, {len(os.sched_getaffinity(0))} cores; load of the minute before a part at most {max(loads):.2f}, that of the part before included. What is required is
meant for an otherwise idle machine. *Sliders* is a mouse that
drags the mass to and fro for {DRAG_S:.0f} s, with `examples/records/ball-material.toml`. Other times run from the moment at which files are handed to
the page. A frame gap is the time between two frames of the page; the longest counts from that moment to the last line of the part.
"""
    print(page)
    if requested.write:
        PAGE.write_text(page, encoding="utf-8")
    if failures:
        sys.exit(1)


if __name__ == "__main__":
    main()
