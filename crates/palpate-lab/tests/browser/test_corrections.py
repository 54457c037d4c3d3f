"""What is typed and chosen on the page: it is read as it was meant, changes what it names, and nothing else."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
from conftest import EXAMPLES, Lab, Opened, opened
from playwright.sync_api import Browser
from records import steps, write


def description(lab: Lab, record: str) -> dict:
    assert lab.folder is not None
    return tomllib.loads((lab.folder / f"{record}.test.toml").read_text())


def with_record(browser: Browser, lab: Lab, path: Path) -> Opened:
    found = opened(browser, lab.address)
    found.drop(path)
    found.wait("#laws .lede")
    found.settle()
    return found


def typed(found: Opened, label: str, text: str) -> None:
    found.page.get_by_label(label, exact=True).fill(text)
    found.page.get_by_label(label, exact=True).press("Tab")
    found.page.wait_for_timeout(300)
    found.settle()


def test_numbers_that_can_be_read_in_two_ways_are_none(browser: Browser, lab: Lab) -> None:
    """A thousand with a comma was read as 1."""
    found = opened(browser, lab.address)
    read = found.page.evaluate(
        "async (texts) => { const { decimal } = await import('./assets/number.js'); return texts.map((text) => decimal(text)); }",
        ["1000", "1,5", "−2.5e3", " 0,125 ", "1234,5", "1,000", "-12,345", "1234,567", "1,234.5", "1.234,5", "1,000,000", "1 000", "", "5 g"],
    )
    assert [one.get("value") for one in read[:5]] == [1000, 1.5, -2500, 0.125, 1234.5]
    assert all("value" not in one and one["wrong"] for one in read[5:]), read
    assert read[5]["wrong"] == "“1,000” can be read as 1000 and as 1: write 1000 or 1.000"
    assert found.messages == []
    found.context.close()


def test_a_mass_that_can_be_read_in_two_ways_is_refused_beside_its_field(browser: Browser, lab: Lab) -> None:
    """A thousand grams with a comma turned a No into a Yes of more than 99.9 %."""
    assert lab.folder is not None
    (lab.folder / "ball.material.toml").write_bytes((EXAMPLES / "ball-material.toml").read_bytes())
    found = opened(browser, lab.address)
    page = found.page
    page.get_by_role("button", name="ball.material.toml").click()
    found.wait(".grip-panel figure")
    typed(found, "Mass, g", "1000")
    found.wait(".verdict.no")
    verdict = page.inner_text(".verdict")
    typed(found, "Mass, g", "1,000")
    assert page.inner_text("#grip-mass-wrong") == (
        "“1,000” can be read as 1000 and as 1: write 1000 or 1.000. The answer is that of 1000 g."
    )
    assert page.inner_text(".verdict") == verdict
    assert page.get_by_label("Mass, g", exact=True).get_attribute("aria-invalid") == "true"
    assert found.accessible()
    # A decimal comma is one, and the field shows what was read.
    typed(found, "Mass, g", "150,25")
    assert page.get_by_label("Mass, g", exact=True).input_value() == "150.25"
    assert page.inner_text("#grip-mass-wrong") == ""

    # What is refused has no lines of a command: those of the squeeze before stood there.
    assert "--squeeze" in (page.text_content(".grip-panel .lines") or "")
    typed(found, "Squeeze, mm", "1000")
    found.wait(".verdict.unknown")
    assert page.locator(".grip-panel .lines").count() == 0
    typed(found, "Squeeze, mm", "5")
    found.wait(".grip-panel .lines")
    found.context.close()


def test_a_change_of_one_hold_leaves_the_others_as_they_are_written(browser: Browser, lab: Lab, tmp_path: Path) -> None:
    """A typed end took `mode` away from every hold."""
    assert lab.folder is not None
    write(lab.folder / "two.csv", steps([2.0, 4.0], 10.0, 20.0, 1))
    written = (
        '[[phases.hold]]\nfrom = "0.2 min"\nto = "21.5 s"\nmode = "neither"\n\n'
        '[[phases.hold]]\nfrom = "1.5 s"\nto = "10 s"\nmode = "displacement"\n'
    )
    (lab.folder / "two.csv.test.toml").write_text(written)
    found = opened(browser, lab.address)
    page = found.page
    found.wait("#laws .lede")
    found.settle()
    first = {"from": "1.5 s", "to": "10 s", "mode": "displacement"}
    second = {"from": "0.2 min", "to": "21.5 s", "mode": "neither"}
    typed(found, "End of hold 1, in seconds", "9,5")
    holds = description(lab, "two.csv")["phases"]["hold"]
    assert sorted(holds, key=lambda one: one["mode"]) == [{**first, "to": "9.5 s"}, second]
    typed(found, "End of hold 1, in seconds", "9,500")
    assert "can be read as 9500 and as 9.5" in page.inner_text("#holds .finding")
    assert description(lab, "two.csv")["phases"]["hold"] == holds
    page.get_by_role("button", name="Remove hold 1").click()
    page.wait_for_timeout(300)
    found.settle()
    assert description(lab, "two.csv")["phases"]["hold"] == [second]
    page.get_by_role("button", name="Add a hold").click()
    page.wait_for_timeout(300)
    found.settle()
    holds = description(lab, "two.csv")["phases"]["hold"]
    assert len(holds) == 2 and second in holds
    assert "stated" in page.inner_text("#record figcaption")
    found.context.close()


def test_a_column_that_is_not_used_is_not_guessed(browser: Browser, lab: Lab) -> None:
    """The choice was "not used" while the figures still showed the displacement."""
    found = with_record(browser, lab, EXAMPLES / "ball.csv")
    page = found.page
    page.click("#columns > summary")
    page.get_by_label("Use of column 2", exact=True).select_option("")
    page.wait_for_timeout(300)
    found.settle()
    assert len(description(lab, "ball.csv")["columns"]["unused"]) == 1
    assert page.get_by_label("Use of column 2", exact=True).input_value() == ""
    drawn = page.locator('#record .panel[data-y-name="Displacement"]')
    assert drawn.count() == 0
    # And back.
    page.get_by_label("Use of column 2", exact=True).select_option("displacement")
    page.wait_for_timeout(300)
    found.settle()
    assert "unused" not in description(lab, "ball.csv")["columns"]
    assert drawn.count() > 0
    assert found.messages == []
    found.context.close()


def test_a_creep_is_fitted_on_the_page(browser: Browser, lab: Lab, tmp_path: Path) -> None:
    """A record whose force is held had the name of a command, and no law."""
    time = np.arange(0.0, 71.0, 0.05)
    force = np.clip(5.0 * (time - 1.0), 0.0, 5.0)
    crept = np.where(time > 2.0, 1.0 + 1.5 * (1.0 - np.exp(-(time - 2.0) / 6.0)), 0.2 * force)
    noise = np.random.default_rng(1).standard_normal((2, time.size))
    record = write(tmp_path / "creep.csv", np.c_[time, crept + 1e-3 * noise[0], force + 0.005 * noise[1]])
    found = opened(browser, lab.address)
    found.drop(record)
    found.wait("#creep .takeaway")
    found.settle()
    assert "standard linear solid" in found.page.inner_text("#creep") or "prony" in found.page.inner_text("#creep")
    assert "palpate compare" not in found.page.inner_text("#laws")
    assert "--creep" in (found.page.text_content("#creep .lines") or "")
    assert found.accessible()
    found.context.close()
