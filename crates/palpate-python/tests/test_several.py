"""Several records in one calibration."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import palpate
import pytest
from test_calibrate import command

BALL = {"shape": "ball", "radius": "35 mm"}
MODULI_KPA = (24.0, 28.0, 31.0, 26.0)


def specimen(modulus_kpa: float, seed: int) -> palpate.Record:
    squeezed = palpate.simulate(
        {
            "specimen": {**BALL, "modulus": f"{modulus_kpa} kPa"},
            "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
            "step": [{"to": to, "rate": "500 mm/min", "hold": "10 s"} for to in ("5 mm", "10 mm")],
            "output": {"sample_rate": "10 Hz"},
        }
    )
    noise = np.random.default_rng(seed).normal(scale=0.05, size=len(squeezed.time_s))
    return palpate.Record.from_arrays(
        time_s=squeezed.time_s, displacement_m=squeezed.displacement_m, force_n=squeezed.force_n + noise, title=f"{modulus_kpa}"
    )


@pytest.fixture(scope="module")
def batch() -> list[palpate.Record]:
    return [specimen(modulus, seed) for seed, modulus in enumerate(MODULI_KPA)]


@pytest.fixture(scope="module")
def found(batch: list[palpate.Record]) -> palpate.SeveralCalibrations:
    return palpate.calibrate(batch, shared=["exponent", "rate_coefficient", "layer_thickness"], test={"specimen": BALL})


def test_shared_and_own_parameters_and_the_spread(found: palpate.SeveralCalibrations) -> None:
    rows = {row["parameter"]: row for row in found.parameter_table}
    assert rows["exponent"]["between"] == "shared"
    assert rows["exponent"]["low"] < 5.0 < rows["exponent"]["high"]
    assert rows["modulus_pa"]["between"] == "own"
    spread = float(np.std(np.log(MODULI_KPA), ddof=1))
    assert rows["modulus_pa"]["spread"] == pytest.approx(spread, rel=0.05)
    assert rows["modulus_pa"]["spread_low"] < spread < rows["modulus_pa"]["spread_high"]
    moduli = [row["modulus_pa"] for row in found.record_table]
    assert np.allclose(moduli, 1e3 * np.array(MODULI_KPA), rtol=0.01)
    assert len(found) == len(found.materials) == 4


def test_another_specimen_is_less_certain_than_a_tested_one(found: palpate.SeveralCalibrations) -> None:
    specimen = found.specimen
    assert specimen is not None and specimen.origin["specimens"] == 4
    squeeze = [{"to": "8 mm", "rate": "500 mm/min", "hold": "10 s"}]
    width = [
        float((p.force_high_n - p.force_low_n)[0])
        for p in (material.predict(squeeze, at_s=[5.0]) for material in (specimen, found.materials[0]))
    ]
    assert width[0] > 10 * width[1]


def test_two_records_of_one_body(batch: list[palpate.Record]) -> None:
    found = palpate.calibrate([batch[1], specimen(MODULI_KPA[1], 9)], shared="all", test={"specimen": BALL})
    assert found.specimen is not None and found.specimen.origin["specimens"] is None
    assert palpate.calibrate(batch[:2], test={"specimen": BALL}).specimen is None


def test_all_of_it_comes_back(found: palpate.SeveralCalibrations) -> None:
    again = pickle.loads(pickle.dumps(found))
    assert again == found
    assert again.to_dict()["schema"] == "palpate.several-calibrations/1"
    assert str(again) == found.report()


def test_its_text_is_that_of_the_command_line(batch: list[palpate.Record], tmp_path: Path) -> None:
    paths = [tmp_path / f"{index}.csv" for index in range(3)]
    for path, record in zip(paths, batch):
        assert record.displacement_m is not None
        columns = np.column_stack([record.time_s, 1e3 * record.displacement_m, record.force_n])
        np.savetxt(path, columns, delimiter=",", header="time (s),displacement (mm),force (N)", comments="", fmt="%.17g")
    test = tmp_path / "ball.toml"
    test.write_text('[specimen]\nshape = "ball"\nradius = "35 mm"\n')
    ran = command("calibrate", *paths, "--test", test, "--shared", "exponent")
    assert ran.returncode == 0, ran.stderr
    records = [palpate.read(path, test=test) for path in paths]
    assert palpate.calibrate(records, shared=["exponent"]).report() == ran.stdout


def test_what_is_no_batch_is_refused(batch: list[palpate.Record]) -> None:
    with pytest.raises(palpate.OptionError, match="two or more, found 1"):
        palpate.calibrate(batch[:1], test={"specimen": BALL})
    with pytest.raises(palpate.OptionError, match=r"modulus_pa, exponent.*found \"stiffness\""):
        palpate.calibrate(batch[:2], shared=["stiffness"], test={"specimen": BALL})
    with pytest.raises(palpate.OptionError, match="shared: expected"):
        palpate.calibrate(batch[:2], shared=3, test={"specimen": BALL})  # type: ignore[arg-type]
    with pytest.raises(palpate.RecordError, match="are the same record"):
        palpate.calibrate([batch[0], batch[0]], test={"specimen": BALL})
