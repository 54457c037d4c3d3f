"""Reports as people open them: in a browser of four widths, without a script, and on paper."""

from __future__ import annotations

import json
import math
import re
import time
from io import BytesIO
from pathlib import Path

import pytest
from conftest import Opened, Reports, opened, opened_whole
from playwright.sync_api import Browser, Locator
from pypdf import PdfReader
from records import HOSTILE

WIDTHS = [420, 768, 1280, 1920]
PAGES = ["many", "long", "hostile", "index", "paper"]
# A4 less its margins at 96 picture elements to an inch.
PAPER = (178 / 25.4 * 96, 267 / 25.4 * 96)


@pytest.mark.parametrize("name", PAGES)
@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_is_cut_or_fetched(browser: Browser, reports: Reports, name: str, width: int) -> None:
    found = opened(browser, getattr(reports, name), width)
    found.page.evaluate("document.querySelectorAll('details').forEach((one) => (one.open = true))")
    assert found.page.evaluate("document.documentElement.scrollWidth") <= width
    # What is wider than the page scrolls in a box of its own; figures never are.
    beyond = """() => [...document.querySelectorAll("svg, h1, h2, h3, p, li, dd, figcaption")]
        .filter((one) => !one.closest(".scroll, .reading") && one.getBoundingClientRect().right > innerWidth + 0.5)
        .map((one) => one.outerHTML.slice(0, 200))"""
    assert found.page.evaluate(beyond) == []
    # Labels of figures are never smaller than can be read.
    smallest = """() => Math.min(99, ...[...document.querySelectorAll("figure .ticks text")]
        .filter((one) => one.getClientRects().length)
        .map((one) => 7 * one.ownerSVGElement.getBoundingClientRect().width / one.ownerSVGElement.viewBox.baseVal.width))"""
    assert found.page.evaluate(smallest) >= 8.5
    assert found.is_quiet()
    found.context.close()


@pytest.mark.parametrize("name", ["many", "series"])
def test_the_table_of_the_first_page_never_scrolls_sideways(browser: Browser, reports: Reports, name: str) -> None:
    """At 900 picture elements the last columns were beside the page."""
    found = opened(browser, getattr(reports, name), 900)
    table = found.page.locator(".first .scroll")
    assert table.count() == 1
    width = table.evaluate("(one) => [one.scrollWidth, one.clientWidth]")
    assert width[0] <= width[1], width
    found.context.close()


def test_the_policy_forbids_what_a_name_could_bring(browser: Browser, reports: Reports) -> None:
    found = opened(browser, reports.many)
    forbidden = found.page.evaluate("""async () => {
        const kinds = [];
        document.addEventListener("securitypolicyviolation", (event) => kinds.push(event.effectiveDirective));
        const add = (name, values) => document.body.append(Object.assign(document.createElement(name), values));
        add("script", { textContent: "window.owned = 1" });
        add("img", { src: "http://127.0.0.1:9/x.png" });
        add("iframe", { src: "http://127.0.0.1:9/" });
        document.body.insertAdjacentHTML("beforeend", "<p style='color: red' onclick='0'></p>");
        document.body.lastElementChild.click();
        await fetch("http://127.0.0.1:9/").catch(() => 0);
        await new Promise((resolve) => setTimeout(resolve, 200));
        return [kinds.sort(), window.owned ?? null];
    }""")
    assert forbidden[1] is None
    kinds = {"connect-src", "frame-src", "img-src", "script-src-attr", "script-src-elem", "style-src-attr"}
    assert set(forbidden[0]) == kinds
    # The browser refused each of them itself.
    assert found.failures and set(found.failures) == {"csp"}, found.failures
    found.context.close()


@pytest.mark.parametrize("name", ["hostile", "index"])
def test_names_are_text(browser: Browser, reports: Reports, name: str) -> None:
    found = opened(browser, getattr(reports, name))
    page = found.page
    assert page.locator("script").count() == 1 and page.locator("img, iframe, [onerror], [onmouseover]").count() == 0
    assert HOSTILE in (page.locator("h1" if name == "hostile" else "h3 >> nth=0").text_content() or "")
    if name == "index":
        for link in page.locator(".cards a").all():
            target = page.evaluate("(one) => one.href", link.element_handle())
            assert target.startswith("file:") and target.endswith("/report.html")
        page.locator(".cards a").first.click()
        assert page.url.endswith("/report.html") and page.locator(".first .lede").count() == 1
        assert found.messages == []
    else:
        assert found.is_quiet()
    found.context.close()


def test_pages_stay_small_and_open_at_once(browser: Browser, reports: Reports) -> None:
    for path, most in [(reports.many, 1_500_000), (reports.long, 700_000), (reports.index, 300_000)]:
        assert path.stat().st_size < most, path
        begin = time.monotonic()
        found = opened(browser, path)
        assert time.monotonic() - begin < 3.0
        found.context.close()


def test_all_holds_have_a_panel(browser: Browser, reports: Reports) -> None:
    holds = json.loads((reports.many.parent / "analysis.json").read_text())["holds"]
    assert len(holds) == 24
    found = opened(browser, reports.many)
    titles = " ".join(found.page.locator(".panels > svg").evaluate_all("(all) => all.map((one) => one.ariaLabel)"))
    for number in range(1, 25):
        assert len(re.findall(rf"\bHold {number}\b", titles)) >= 5, number
    # Every logarithmic axis has two labels at least.
    labels = """() => [...document.querySelectorAll("figure .panel")].filter((one) => one.dataset.x.startsWith("log"))
        .map((one) => one.querySelectorAll(".ticks > g:first-of-type text").length)"""
    assert min(found.page.evaluate(labels)) >= 2
    found.context.close()


def panel_of(found: Opened, figure: str, index: int = 0) -> tuple[Locator, dict[str, float]]:
    """An SVG element of a figure, and where its axes lie on the screen."""
    svg = found.page.locator(f"{figure} .panels:visible > svg").nth(index)
    svg.scroll_into_view_if_needed()
    box = svg.evaluate("""(one) => {
        const panel = one.querySelector(".panel"), [x, y, w, h] = panel.dataset.area.split(" ").map(Number);
        const at = (px, py) => new DOMPoint(px, py).matrixTransform(one.getScreenCTM());
        const [from, to] = [at(x, y), at(x + w, y + h)];
        const [, low, high] = panel.dataset.x.split(" ").map(Number);
        return { left: from.x, top: from.y, right: to.x, bottom: to.y, low, high };
    }""")
    return svg, box


def test_hover_reads_the_law_where_the_pointer_is(browser: Browser, reports: Reports) -> None:
    found = opened(browser, reports.many)
    document = json.loads((reports.many.parent / "analysis.json").read_text())
    _, box = panel_of(found, "#figure-1", 1)
    # Beyond the last sample, where nothing is snapped to.
    share = 0.95
    found.page.mouse.move(box["left"] + share * (box["right"] - box["left"]), box["top"] + 20)
    rows = found.page.locator(".reading div").all_inner_texts()
    values = {name.strip(): float(value.split()[0].replace("−", "-")) for name, value in (row.split("\n") for row in rows)}
    # A logarithmic axis: the place is a share of the decades.
    assert math.isclose(values["Time"], box["low"] * (box["high"] / box["low"]) ** share, rel_tol=5e-3)
    title = found.page.locator("#figure-1 .panels > svg >> nth=1").get_attribute("aria-label") or ""
    hold = next(one for one in document["holds"] if title.startswith(f"Hold {one['index']},"))
    # The law of the record, which another may beat on this hold.
    law = document["answer"]["law"]
    exponent = float(law.removeprefix("latency:"))
    fitted = next(one for one in hold["comparison"]["laws"] if one["law"] == law)
    named = {name: parameter["value"] for name, parameter in fitted["parameters"].items()}
    decay = (1 + (exponent - 1) * named["relative_rate_per_s"] * values["Time"]) ** (-1 / (exponent - 1))
    expected = named["equilibrium"] + named["amplitude"] * decay
    assert math.isclose(values[law], expected, rel_tol=2e-3)
    found.page.mouse.move(2, 2)
    assert found.page.locator(".reading").is_hidden()
    assert found.is_quiet()
    found.context.close()


def test_arrow_keys_read_and_escape_resets(browser: Browser, reports: Reports) -> None:
    found = opened(browser, reports.many)
    svg, _ = panel_of(found, "#figure-1", 1)
    svg.focus()
    readings = []
    for key in ["ArrowRight", "Shift+ArrowRight", "+", "ArrowLeft"]:
        svg.press(key)
        readings.append(found.page.locator(".reading").text_content())
    assert len(set(readings[:2])) == 2
    assert svg.locator(".panel.zoomed").count() == 1
    svg.press("Escape")
    assert svg.locator(".panel.zoomed").count() == 0
    assert found.is_quiet()
    found.context.close()


def test_a_drag_zooms_and_a_double_click_resets(browser: Browser, reports: Reports) -> None:
    found = opened(browser, reports.many)
    mouse = found.page.mouse
    svg, box = panel_of(found, "#figure-1", 1)
    drawn = "(one) => [...one.querySelectorAll('.line path, .points path, .band path')].map((path) => path.getAttribute('d') + path.getAttribute('transform'))"
    labels = "(one) => [...one.querySelectorAll('.ticks text')].filter((text) => text.getClientRects().length).map((text) => text.textContent)"
    before, labelled = svg.evaluate(drawn), svg.evaluate(labels)
    width, height = box["right"] - box["left"], box["bottom"] - box["top"]
    mouse.move(box["left"] + 0.5 * width, box["top"] + 0.3 * height)
    mouse.down()
    mouse.move(box["left"] + 0.8 * width, box["top"] + 0.7 * height, steps=4)
    mouse.up()
    assert svg.evaluate(drawn) != before and svg.evaluate(labels) != labelled
    # What is read at a place of the zoomed axes is what the axes say there.
    mouse.move(box["left"] + 0.5 * width, box["top"] + 0.5 * height)
    reading = found.page.locator(".reading div").first.inner_text().split("\n")[1].split()[0]
    ends = [box["low"] * (box["high"] / box["low"]) ** share for share in (0.5, 0.8)]
    assert math.isclose(float(reading), math.sqrt(ends[0] * ends[1]), rel_tol=0.03)
    mouse.dblclick(box["left"] + 0.5 * width, box["top"] + 0.5 * height)
    assert svg.evaluate(drawn) == before and svg.evaluate(labels) == labelled
    assert found.is_quiet()
    found.context.close()


def test_legend_entries_switch_curves(browser: Browser, reports: Reports) -> None:
    found = opened_whole(browser, reports.many)
    figure = found.page.locator("figure:has(ul.legend)").first
    entry = figure.locator(".legend .entry").nth(1)
    name = entry.get_attribute("data-series")
    hidden = "(one, name) => [...one.querySelectorAll('.line, .points')].filter((s) => s.dataset.series === name).map((s) => getComputedStyle(s).display)"
    assert set(figure.evaluate(hidden, name)) == {"inline"}
    entry.click()
    assert set(figure.evaluate(hidden, name)) == {"none"} and entry.get_attribute("aria-pressed") == "false"
    entry.press("Enter")
    assert set(figure.evaluate(hidden, name)) == {"inline"} and entry.get_attribute("aria-pressed") == "true"
    # A legend inside the axes is clicked there.
    inside = found.page.locator("#figure-1 .panels > svg >> nth=1").locator(".entry").first
    inside.scroll_into_view_if_needed()
    inside.click()
    assert found.page.locator("#figure-1 .series-off").count() >= 1
    assert found.is_quiet()
    found.context.close()


def test_tables_sort_by_a_click(browser: Browser, reports: Reports) -> None:
    found = opened_whole(browser, reports.many)
    table = found.page.locator("table:has(th:has-text('Recommended law'))").first
    column = table.locator("th", has_text="Probability")
    index = column.evaluate("(one) => one.cellIndex")
    cells = "(one, index) => [...one.tBodies[0].rows].map((row) => row.cells[index].textContent)"
    before = table.evaluate(cells, 0)
    column.locator("button").click()
    values = [float(text) for text in table.evaluate(cells, index)]
    assert values == sorted(values) and column.get_attribute("aria-sort") == "ascending"
    column.locator("button").press("Enter")
    values = [float(text) for text in table.evaluate(cells, index)]
    assert values == sorted(values, reverse=True)
    table.locator("th", has_text="Hold").first.locator("button").click()
    assert table.evaluate(cells, 0) == before == [str(number) for number in range(1, 25)]
    # Powers of ten, intervals and missing values: by their numbers, the missing last.
    fits = found.page.locator("table:has(th:has-text('ΔAICc'))").first
    head = fits.locator("th", has_text="ΔBIC")
    head.locator("button").click()
    texts = fits.evaluate(cells, head.evaluate("(one) => one.cellIndex"))
    known = [float(text.replace("−", "-")) for text in texts if text[0] != "–"]
    assert known == sorted(known) and texts[: len(known)] == [text for text in texts if text[0] != "–"]
    assert found.is_quiet()
    found.context.close()


def test_a_power_of_ten_in_an_interval_is_not_that_of_the_value(browser: Browser, reports: Reports) -> None:
    """A cell of 0.31 whose upper bound is 6.0×10⁸ was sorted as 3.1×10⁸."""
    found = opened_whole(browser, reports.many)
    order = found.page.evaluate("""() => {
        const cells = ["0.31 [−0.12, 6.0×10⁸]", "(1.234 [1.200, 1.270])×10⁻⁵", "12 [11, 13]", "2.1×10⁻⁷", "–", "(−5.4 [−5.6, ∞))×10⁶", "< 1×10⁻⁶"];
        const raised = (text) => text.replace(/[⁻⁰¹²³⁴-⁹]+/g, (power) => `<sup>${[...power].map((c) => "−0123456789"["⁻⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(c)]).join("")}</sup>`);
        const box = document.createElement("div");
        box.innerHTML = `<table><thead><tr><th class="n">Value</th></tr></thead><tbody>${cells.map((text, i) => `<tr><td data-i="${i}">${raised(text)}</td></tr>`).join("")}</tbody></table>`;
        document.body.append(box);
        palpate.enliven(box);
        box.querySelector("th button").click();
        return [...box.querySelectorAll("td")].map((cell) => +cell.dataset.i);
    }""")
    assert order == [5, 3, 6, 1, 0, 2, 4]
    found.context.close()


def test_sections_fold_and_links_open_them(browser: Browser, reports: Reports) -> None:
    found = opened(browser, reports.many)
    page = found.page
    record = page.locator("details.section", has=page.locator("h2", has_text="The record"))
    assert record.get_attribute("open") is None
    record.locator("summary").first.click()
    assert record.locator("figure").first.is_visible()
    record.locator("summary").first.press("Enter")
    assert not record.locator("figure").first.is_visible()
    page.locator("nav a", has_text="Findings").click()
    assert page.locator("#findings").is_visible()
    assert found.is_quiet()
    found.context.close()


def test_the_page_is_complete_without_a_script(browser: Browser, reports: Reports) -> None:
    found = opened(browser, reports.many, script=False)
    page = found.page
    assert page.locator(".first figure svg").first.is_visible() and page.locator(".bar, th button").count() == 0
    page.locator("nav a", has_text="The record").click()
    assert page.locator("#the-record figure").is_visible()
    page.locator("summary", has_text="Findings").click()
    assert page.locator("#findings .finding").first.is_visible()
    pages = texts(page.pdf(prefer_css_page_size=True))
    assert "Provenance" in pages[-1] and sum("Hold 24" in text for text in pages) >= 5
    found.context.close()


@pytest.mark.parametrize("width", WIDTHS)
def test_a_statement_shows_its_verdict_and_what_shows_it(browser: Browser, reports: Reports, width: int) -> None:
    found = opened(browser, reports.paper, width)
    page = found.page
    verdicts = page.locator(".claims tbody > tr:first-child > td:first-of-type")
    assert verdicts.count() > 50
    # The verdict stands beside the statement, before anything is scrolled.
    box = verdicts.first.bounding_box()
    assert box is not None and box["x"] + box["width"] <= width
    gone = """() => [...document.querySelectorAll("a[href^='#']")].map((one) => one.getAttribute("href"))
        .filter((target) => !document.getElementById(target.slice(1)))"""
    assert page.evaluate(gone) == []
    page.locator(".claims a", has_text="Table S4").first.click()
    assert "laboratories" in (page.locator(":target .caption").text_content() or "")
    assert found.is_quiet()
    found.context.close()


def texts(pdf: bytes) -> list[str]:
    reader = PdfReader(BytesIO(pdf))
    for page in reader.pages:
        assert [round(float(side) / 72 * 25.4) for side in page.mediabox[2:]] == [210, 297]
    return [page.extract_text() for page in reader.pages]


@pytest.mark.parametrize("name", ["many", "long", "hostile"])
def test_the_first_page_is_one_sheet_and_figures_keep_their_captions(
    browser: Browser, reports: Reports, name: str, tmp_path: Path
) -> None:
    found = opened(browser, getattr(reports, name))
    page = found.page
    pages = texts(page.pdf(prefer_css_page_size=True))
    headings = page.locator("details.section h2").all_inner_texts()
    # All of the first page is on the first sheet, and nothing else is.
    assert headings[-1] in pages[0] and "Figure 1." in pages[0] and "Table 1." in pages[0]
    assert "Figure 2." not in pages[0] and "Provenance" not in pages[0]
    assert pages[1].strip().startswith(headings[0])
    # Every figure with its caption is lower than a sheet, and may not be parted.
    page.emulate_media(media="print")
    page.set_viewport_size({"width": round(PAPER[0]), "height": round(PAPER[1])})
    page.evaluate("document.querySelectorAll('details').forEach((one) => (one.open = true))")
    heights = page.locator("figure").evaluate_all("(all) => all.map((one) => one.getBoundingClientRect().height)")
    assert len(heights) >= 3 and max(heights) < PAPER[1], heights
    breaks = page.locator("figure").evaluate_all("(all) => all.map((one) => getComputedStyle(one).breakInside)")
    assert set(breaks) == {"avoid"}
    assert page.locator(".first").evaluate("(one) => one.getBoundingClientRect().height") < PAPER[1]
    wide = """() => [...document.querySelectorAll("table, svg")]
        .filter((one) => one.getBoundingClientRect().right > innerWidth + 1).map((one) => one.textContent.slice(0, 80))"""
    assert page.evaluate(wide) == []
    # On the sheet of each caption there are the labels of its figure.
    for number in range(1, len(heights) + 1):
        sheet = [text for text in pages if f"Figure {number}." in text]
        label = page.locator(f"#figure-{number} .panels:visible text").last.text_content() or ""
        assert len(sheet) == 1 and label.strip() in sheet[0], (number, label)
    found.context.close()
