"""Pickles that something has damaged are refused, or make objects that answer: no panic, no hang, no gigabytes."""

from __future__ import annotations

from pathlib import Path

import damaged
import pytest

# Those whose states are small enough to be tried by the hundred in seconds; validation/damaged_states.py tries all.
QUICK = [
    *["Record, force alone", "Finding", "RecordComparison", "Material", "Prediction", "Trajectory", "Fit", "Fit, prony", "Estimate"],
    *["Comparison", "Observation, hold", "Observer", "Observer, material", "ContactState", "ContactStates", "BatchResult", "Table, observed"],
]

# Damage that has caused a panic before.
KNOWN = [
    ("Fit, stretched", "$.fit.searched without the last"),
    ("Fit", "$.fit.uncertainty.covariance[2] = []"),
    ("Fit", "$.fit.uncertainty.covariance[0] without the last"),
    ("Fit", "$.fit.curve.terms[0].parameters without the first"),
    ("Fit, stretched", "$.fit.curve.terms[0].parameters first one 2000 times"),
    ("Prediction", "$.trajectory.time twice"),
    ("Prediction", "$.force_standard_error without the last"),
    ("Trajectory", "$.force = []"),
    ("Trajectory", "$.strain without the last"),
    ("Trajectory", "$.in_contact without the last"),
    ("ContactStates", "$1 = []"),
]


def test_every_class_that_can_be_pickled_has_an_example() -> None:
    assert {name.partition(",")[0] for name in damaged.EXAMPLES} == damaged.picklable()
    assert set(QUICK) <= set(damaged.EXAMPLES)


def test_a_sample_of_damaged_states_is_answered() -> None:
    tried = damaged.tried(seed=1, most=16, names=QUICK, patience_s=10.0)
    assert all(tried.states.values()), tried.states
    assert not tried.failures, "\n".join(map(str, damaged.fewest(tried.failures)))


@pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")
@pytest.mark.parametrize(("example", "damage"), KNOWN)
def test_damage_that_has_caused_a_panic_is_answered(example: str, damage: str, tmp_path: Path) -> None:
    cases = {case.damage: case for case in damaged.cases(example, damaged.EXAMPLES[example](), seed=1, most=1)}
    wrong = [found for found in damaged.answers_of(cases[damage], tmp_path) if "kind" in found]
    assert not wrong, wrong
