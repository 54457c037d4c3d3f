"""Records from bytes and from objects that are read, wherever a path is taken."""

from __future__ import annotations

import asyncio
import contextlib
import io
import os
import zipfile
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
import palpate
import pytest

RECORD = "examples/records/ball.csv"


class Remote:
    """Opened on entry, as the OpenFile of fsspec is."""

    def __init__(self, content: bytes) -> None:
        self.content, self.path, self.closed = content, "bucket/remote.csv", False

    def __enter__(self) -> io.BytesIO:
        return io.BytesIO(self.content)

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self.closed = True


class Upload:
    """As web frameworks hand it over: `name` is the field of the form, `filename` the file."""

    def __init__(self, content: bytes) -> None:
        self.file, self.name, self.filename = io.BytesIO(content), "record", "uploaded.csv"

    def read(self) -> bytes:
        return self.file.read()


class AsyncUpload(Upload):
    async def read(self) -> bytes:  # type: ignore[override]
        await asyncio.sleep(0)
        return self.file.read()


def sources(content: bytes, folder: Path, opened: contextlib.ExitStack) -> list[tuple[Any, str]]:
    """Objects with a record in them, and what each is called; `opened` closes those that are files."""
    path = folder / "ball.csv"
    path.write_bytes(content)
    named = io.BytesIO(content)
    named.name = "named.csv"
    with zipfile.ZipFile(folder / "ball.zip", "w") as archive:
        archive.writestr("inside.csv", content)
    packed = opened.enter_context(zipfile.ZipFile(folder / "ball.zip"))
    return [
        (content, "bytes"),
        (bytearray(content), "bytes"),
        (memoryview(content), "bytes"),
        (io.BytesIO(content), "BytesIO"),
        (named, "named.csv"),
        (opened.enter_context(path.open("rb")), str(path)),
        (io.StringIO(content.decode()), "StringIO"),
        (opened.enter_context(packed.open("inside.csv")), "inside.csv"),
        (Remote(content), "bucket/remote.csv"),
        (Upload(content), "uploaded.csv"),
        (AsyncUpload(content), "uploaded.csv"),
    ]


def test_a_record_is_the_same_wherever_it_comes_from(root: Path, tmp_path: Path) -> None:
    expected = palpate.read(root / RECORD)
    content = (root / RECORD).read_bytes()
    with contextlib.ExitStack() as opened:
        for source, name in sources(content, tmp_path, opened):
            record = palpate.read(source)
            assert np.array_equal(record.force_n, expected.force_n), name
            assert record.title == Path(name).stem
        for source, name in sources(content, tmp_path, opened):
            assert palpate.read(source, name="mine.csv").title == "mine", name
    remote = Remote(content)
    palpate.read(remote)
    assert remote.closed


def test_errors_show_the_name() -> None:
    with pytest.raises(palpate.RecordError, match=r"^x\.csv: the file is empty"):
        palpate.read(b"", name="x.csv")
    with pytest.raises(palpate.RecordError, match=r"^BytesIO: "):
        palpate.read(io.BytesIO(b"\0\1\2\3" * 50))


def test_what_is_no_file_is_refused_by_what_it_is(root: Path) -> None:
    with pytest.raises(palpate.OptionError, match="expected a path, bytes or an object with read.*found int"):
        palpate.read(7)  # type: ignore[arg-type] # pyright: ignore[reportArgumentType]
    with pytest.raises(palpate.OptionError, match="name: expected bytes .* found a path"):
        palpate.read(root / RECORD, name="x.csv")

    class Lines:
        def read(self) -> list[str]:
            return ["a"]

    with pytest.raises(palpate.OptionError, match="expected read.. to give bytes, found list"):
        palpate.read(Lines())  # type: ignore[arg-type] # pyright: ignore[reportArgumentType]
    with pytest.raises(palpate.OptionError, match="paths: expected a list of files, found one"):
        palpate.batch(os.fspath(root / RECORD), "out.csv")


@pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")
def test_every_function_that_takes_a_path_takes_bytes(root: Path, tmp_path: Path) -> None:
    content = (root / RECORD).read_bytes()
    assert palpate.inspect(content, name="x.csv").startswith("x.csv\n")
    assert [record.title for record in palpate.read_all(io.BytesIO(content), name="x.csv")] == ["x"]
    palpate.convert(content, tmp_path / "plain.csv", name="x.csv")
    assert (tmp_path / "plain.csv").exists()
    assert palpate.watch(content, name="x.csv") == palpate.watch(io.BytesIO(content), name="x.csv")
    table = tmp_path / "holds.csv"
    alone = palpate.batch([root / RECORD], table)
    mixed = palpate.batch({"a.csv": content, "b.csv": io.BytesIO(content)}, table)
    assert mixed.holds == 2 * alone.holds and mixed.failures == []
    assert palpate.batch([content, root / RECORD], table).holds == 2 * alone.holds


def curve(modulus_pa: float) -> str:
    """Approach and retraction of a ball of 5 um, by Hertz."""
    row = np.arange(600)
    height = 2e-6 - 1e-8 * abs(row - 300)
    force = 4 / 3 * modulus_pa / 0.75 * np.sqrt(5e-6) * np.maximum(height, 0) ** 1.5
    lines = [f"{0.001 * i},{1e9 * h},{1e9 * f}" for i, h, f in zip(row, height, force, strict=True)]
    return "Time (s),Indentation (nm),Force (nN)\n" + "\n".join(lines) + "\n"


def test_curves_without_a_hold_have_a_modulus(tmp_path: Path) -> None:
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as members:
        members.writestr("a.csv", curve(500.0))
        members.writestr("b.csv", curve(1500.0))
    test = {
        "specimen": {"shape": "spherical tip", "radius_m": 5e-6, "poisson_ratio": 0.5},
        "contact": {"touch": "0 mm"},
    }
    result = palpate.batch({"map.zip": archive.getvalue()}, tmp_path / "moduli.csv", test=test)
    assert (result.holds, result.without_hold, result.rows, result.failures) == (0, 2, 2, [])
    assert result.loading_modulus_pa == pytest.approx(1000.0, rel=1e-3)
    assert str(result).startswith("No hold in 2 tests.")
    with pytest.warns(palpate.PalpateWarning, match="no_hold"):
        analysis = palpate.read(archive.getvalue(), name="map.zip", part="b.csv", test=test).analyze()
    assert analysis.loading_modulus_pa == pytest.approx(1500.0, rel=1e-3)
    assert "no_hold" in [finding.code for finding in analysis.findings]
