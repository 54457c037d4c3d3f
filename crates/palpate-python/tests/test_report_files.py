"""The files of a report as Python asks for them: formats, widths, workbooks, languages, maps, conditions."""

import csv
import math
import zipfile
from pathlib import Path
from typing import Any

import palpate
import pytest
from conftest import ROOT

pytestmark = pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")

RECORD = ROOT / "examples/records/ball.csv"
CONDITIONS = {"conditions": {"temperature": "23 °C", "relaxation_at": ["1 s", "10 s", "1 h"]}}


def test_report_files(tmp_path: Path) -> None:
    analysis = palpate.read(RECORD).analyze(compare=False)
    analysis.report(tmp_path / "study", figures=["pdf"], column="single", holds=[1], csv_locale="de")
    figures = sorted((tmp_path / "study" / "figures").iterdir())
    assert figures and all(path.suffix == ".pdf" and path.read_bytes().startswith(b"%PDF-") for path in figures)
    header = (tmp_path / "study" / "tables" / "holds.csv").read_text(encoding="utf-8").splitlines()[0]
    assert header.startswith("hold;after;mode;start_s;")
    assert zipfile.ZipFile(tmp_path / "study" / "tables.xlsx").testzip() is None
    refused: list[dict[str, Any]] = [{"figures": ["jpg"]}, {"column": "triple"}, {"csv_locale": "xx"}]
    for wrong in refused:
        with pytest.raises(palpate.OptionError, match="is one of"):
            analysis.report(tmp_path / "other", **wrong)
    with pytest.raises(palpate.PalpateError, match="hold 99"):
        analysis.report(tmp_path / "other", holds=[99])
    assert not (tmp_path / "other").exists()


def test_convert_to_a_workbook_and_back(tmp_path: Path) -> None:
    book = palpate.convert(RECORD, tmp_path / "record.xlsx")
    comma = palpate.convert(RECORD, tmp_path / "record.csv", csv_locale="fr")
    direct, again, third = palpate.read(RECORD), palpate.read(book), palpate.read(comma)
    assert (direct.force_n == again.force_n).all() and (direct.time_s == again.time_s).all()
    assert (direct.force_n == third.force_n).all()


def curve(number: int, x: float, y: float, modulus: float) -> str:
    head = [
        f"# index: {number}", f"# xPosition: {x}", f"# yPosition: {y}", "# segmentIndex: 0", "# segment: extend",
        "# springConstant: 0.05", "# columns: measuredHeight vDeflection seriesTime", "# units: m N s", "",
    ]
    rows = []
    for i in range(200):
        depth = (i - 100) * 1e-8
        force = 4 / 3 * modulus / 0.75 * math.sqrt(5e-6) * max(depth, 0.0) ** 1.5
        rows.append(f"{-(depth + force / 0.05):.9e} {force:.9e} {0.001 * i:.4f}")
    return "\n".join(head + rows) + "\n"


def test_maps(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "map.zip", "w") as archive:
        for number in range(6):
            position = (1e-6 * (number % 3), 1e-6 * (number // 3))
            archive.writestr(f"curve-{number}.txt", curve(number, *position, 500.0 + 100.0 * number))
    test = {
        "specimen": {"shape": "spherical tip", "radius": "5 um", "poisson_ratio": 0.5},
        "contact": {"touch": "0 mm"},
    }
    records = palpate.read_all(tmp_path / "map.zip", test=test)
    assert [(record.x_m, record.y_m, record.map_index) for record in records][4] == (1e-6, 1e-6, 4)
    out = tmp_path / "holds.csv"
    found = palpate.batch([tmp_path / "map.zip"], out, test=test, map=["E", f"E={tmp_path / 'map.pdf'}"])
    assert "Loading modulus (Pa)" in found.map("E") and found.map("E") == found.map("loading_modulus_pa")
    assert (tmp_path / "holds_map_E.svg").exists() and (tmp_path / "map.pdf").read_bytes().startswith(b"%PDF-")
    with out.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    assert [float(row["x_m"]) for row in rows] == [0.0, 1e-6, 2e-6] * 2
    with pytest.raises(palpate.OptionError, match="these curves have"):
        found.map("stiffness")


def test_conditions_and_stated_relaxation() -> None:
    analysis = palpate.read(RECORD, test=CONDITIONS).analyze(compare=False)
    assert analysis.conditions["temperature_k"] == pytest.approx(296.15)
    assert analysis.conditions["conditioning"] is None
    stated = list(analysis.relaxation_at)
    document = analysis.to_dict()["holds"]
    rows = [row for hold in document for row in hold["report"]["relaxation"]]
    assert [row["relaxation"] for row in stated] == [row["relaxation"] for row in rows] and rows
    assert {row["time_s"] for row in stated} <= {1.0, 10.0}
    assert [row["hold"] for row in analysis.constraint] == [hold["index"] for hold in document]
