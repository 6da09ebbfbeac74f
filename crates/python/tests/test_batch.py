"""A batch gives every row what the budget gives with the row written into it."""

import math

import gumption
import numpy as np
import pytest

BUDGET = """
[measurand.I]
model = "V / R"
unit = "mA"
[input]
V = {{ unit = "V", readings = {readings} }}
R = {{ value = {R}, unit = "ohm", u = {u} }}
"""

ROWS = [("[1.0, 1.1, 1.3]", 100.0, 0.1), ("[2.0, 2.1]", 250.5, 0.0123456789), ("[0.5, 0.7, 0.4]", 33.3, 1e-9)]


def table():
    return {
        "V.readings": [np.array(eval(readings)) for readings, _, _ in ROWS],  # noqa: S307
        "R": [value for _, value, _ in ROWS],
        "R.u": [u for _, _, u in ROWS],
    }


def by_hand(row, **settings):
    readings, value, u = row
    return gumption.evaluate(BUDGET.format(readings=readings, R=value, u=u), **settings)["I"]


def test_rows_are_budgets():
    budget = BUDGET.format(readings="[1, 2]", R=1, u=1)
    found = gumption.batch(budget, table())
    for at, row in enumerate(ROWS):
        expected = by_hand(row, monte_carlo=False)
        assert (found["I [mA]"][at], found["u(I) [mA]"][at]) == (expected.y, expected.u)
        assert (found["k(I)"][at], found["U(I) [mA]"][at]) == (expected.k, expected.U)
    assert found["error"] == ["", "", ""]
    trials = gumption.batch(budget, table(), monte_carlo=True, trials=2000, shares=True)
    for at, row in enumerate(ROWS):
        expected = by_hand(row, trials=2000, seed=int(trials["seed"][at]))
        assert (trials["I [mA]"][at], trials["u(I) [mA]"][at]) == (expected.y, expected.u)
        assert math.isclose(trials["share(I, V)"][at] + trials["share(I, R)"][at], 1)


def test_a_faulty_row_stops_nothing(tmp_path):
    rows = table()
    rows["R.u"][1] = -1.0
    budget = BUDGET.format(readings="[1, 2]", R=1, u=1)
    found = gumption.batch(budget, rows)
    assert found["error"][1] and np.isnan(found["I [mA]"][1])
    assert found["I [mA]"][2] == by_hand(ROWS[2], monte_carlo=False).y
    told, place = [], tmp_path / "results.csv"
    assert gumption.batch(budget, rows, output=place, progress=told.append) == {"rows": 3, "failed": 1}
    assert len(place.read_text().splitlines()) == 4 and told[-1] == 1.0
    kept = gumption.batch(budget, {**rows, "type": ["A", "B", "C"]}, keep=["type"])
    assert kept["type"] == ["A", "B", "C"] and kept["I [mA]"][2] == found["I [mA]"][2]
    with pytest.raises(gumption.Refused, match="no input or constant"):
        gumption.batch(budget, {"X": [1]})
    with pytest.raises(ValueError, match="lengths"):
        gumption.batch(budget, {"R": [1], "R.u": [1, 2]})


@pytest.mark.parametrize("library", ["pandas", "polars"])
def test_frames(library):
    frames = pytest.importorskip(library)
    frame = frames.DataFrame({"R": [100.0, 200.0], "label": ["a", "b"]})
    found = gumption.batch(BUDGET.format(readings="[1, 2]", R=1, u=1), frame)
    assert isinstance(found, frames.DataFrame)
    assert list(found["label"]) == ["a", "b"] and list(found["I [mA]"]) == [15.0, 7.5]
