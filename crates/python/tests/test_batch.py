"""A batch gives every row what the budget gives with the row written into it."""

import datetime
import math
import warnings

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


def test_tables_of_arrow():
    arrow = pytest.importorskip("pyarrow")
    budget = BUDGET.format(readings="[1, 2]", R=1, u=1)
    table = arrow.table({"label": ["a", "b", "c"], "R": [100.0, 200.0, None], "R.u": [0.1, 0.2, -1.0]})
    found = gumption.batch(budget, table)
    assert isinstance(found, arrow.Table) and found["label"].to_pylist() == ["a", "b", "c"]
    assert found["I [mA]"].to_pylist() == [15.0, 7.5, None] and found["error"][2].as_py()
    columns = {"R": np.array([100.0, 200.0]), "R.u": np.array([0.1, 0.2])}
    same = gumption.batch(budget, columns)
    assert list(same["U(I) [mA]"]) == found["U(I) [mA]"].to_pylist()[:2]


def test_many_rows_are_what_each_is():
    """Rows that are evaluated together, some of which need more than their figures."""
    random = np.random.default_rng(1)
    budget = """
[measurand.y]
model = "a * b / c"
[input]
a = { value = 1.5, u = 0.01, dof = 5 }
b = { value = 1.5, u = 0.01, dof = 3 }
c = { value = 1.5, u = 0.01 }
"""
    rows = 700
    table = {name: random.uniform(0.1, 9, rows) for name in "abc"} | {"a.u": random.uniform(1e-4, 0.1, rows)}
    table["c"][::97] = 0.02
    table["b"][::101] = np.nan
    names = [f"type {at}" for at in range(rows)]
    wanted = {"keep": ["type"], "shares": True, "contributions": True}
    together = gumption.batch(budget, {"type": names, **table}, **wanted)
    few = ["few_degrees_of_freedom" in one for one in together["findings"]]
    assert any(few) and not all(few)
    # A row alone is read with the file.
    for at in [*range(0, 40), *range(250, 262), 97, 101, rows - 1]:
        row = {name: column[at : at + 1] for name, column in table.items()}
        alone = gumption.batch(budget, {"type": names[at : at + 1], **row}, **wanted)
        for name in together.keys() - {"label"}:
            one, other = together[name][at], alone[name][0]
            assert one == other or (one != one and other != other), (name, at)


def test_the_index_of_a_frame_names_its_rows():
    budget = {"title": "y", "measurand": {"y": {"model": "x"}}, "input": {"x": {"value": 1, "u": 0.1}}}
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({"x": [1.0, 2.0]}, index=["S1", "S2"])
    assert list(gumption.batch(budget, frame)["label"]) == ["S1", "S2"]
    assert list(gumption.batch(budget, frame.reset_index(drop=True))["label"]) == ["1", "2"]


def test_a_file_that_would_hold_something_else_is_refused(tmp_path):
    budget = {"title": "y", "measurand": {"y": {"model": "x"}}, "input": {"x": {"value": 1, "u": 0.1}}}
    with pytest.raises(ValueError, match="would hold CSV"):
        gumption.batch(budget, {"x": [1.0]}, output=tmp_path / "results.parquet")
    (tmp_path / "devices.csv").write_bytes(b"PAR1\x15\x04")
    with pytest.raises(gumption.Refused, match="Parquet"):
        gumption.batch(budget, tmp_path / "devices.csv")


def test_what_is_read_is_never_overwritten(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    budget, rows = BUDGET.format(readings="[1, 2]", R=1, u=1), "R\n100\n"
    (tmp_path / "budget.toml").write_text(budget)
    (tmp_path / "rows.csv").write_text(rows)
    (tmp_path / "also.csv").symlink_to(tmp_path / "rows.csv")
    (tmp_path / "budget.csv").symlink_to(tmp_path / "budget.toml")
    for name in ("rows.csv", "./rows.csv", tmp_path / "also.csv", "budget.csv"):
        with pytest.raises(OSError, match="never overwritten"):
            gumption.batch("budget.toml", "rows.csv", output=name, replace=True)
    assert (tmp_path / "budget.toml").read_text() == budget and (tmp_path / "rows.csv").read_text() == rows
    assert gumption.batch("budget.toml", "rows.csv", output="out.csv", replace=True)["rows"] == 1


@pytest.mark.parametrize("name", ["error", "findings", "seed", "I", "I [mA]", "u(I) [mA]", "share(I, R)", "label"])
def test_what_is_kept_has_a_name_of_its_own(name):
    budget = BUDGET.format(readings="[1, 2]", R=1, u=1)
    with pytest.raises(gumption.Refused, match="of their own") as refused:
        gumption.batch(budget, {"R": [1.0], name: ["a"]}, keep=[name])
    assert refused.value.faults[0].mend
    assert gumption.batch(budget, {"R": [1.0], "u(X)": ["a"]}, keep=["u(X)"])["u(X)"] == ["a"]


def test_masked_rows_are_missing():
    budget = BUDGET.format(readings="[1, 2]", R=1, u=1)
    for kind in (float, int):
        masked = np.ma.array([100, 99], mask=[0, 1], dtype=kind)
        found = gumption.batch(budget, {"R": masked})
        assert [bool(one) for one in found["error"]] == [False, True] and found["I [mA]"][0] == 15
    fleet = gumption.fleet({"y": np.ma.array([1.0, 1.2, 99.0], mask=[0, 0, 1]), "u(y)": [0.1] * 3, "k(y)": [2.0] * 3})
    assert fleet.table()["mean"][0] == pytest.approx(1.1)


def test_results_have_the_index_of_their_frame():
    pandas = pytest.importorskip("pandas")
    budget = BUDGET.format(readings="[1, 2]", R=1, u=1)
    rows = {"R": [300.0, 100.0, 200.0]}
    pairs = pandas.MultiIndex.from_tuples([("a", 1), ("a", 2), ("b", 1)])
    for index in (None, [5, 9, 7], ["p", "p", "q"], pairs, pandas.to_datetime(["2026-01-01"] * 3)):
        frame = pandas.DataFrame(rows, index=index)
        found = gumption.batch(budget, frame)
        assert found.index.equals(frame.index) and list(found["I [mA]"]) == [5.0, 15.0, 7.5]
    frame = pandas.DataFrame(rows).sort_values("R")
    frame["I"] = gumption.batch(budget, frame)["I [mA]"]
    assert list(frame["I"]) == [15.0, 7.5, 5.0]
    some = pandas.DataFrame(rows)[1:]
    assert list(gumption.batch(budget, some).index) == [1, 2]


def test_what_is_kept_has_its_type():
    budget, day = BUDGET.format(readings="[1, 2]", R=1, u=1), datetime.date(2026, 3, 1)
    rows = {"label": [7, 8], "R": [100.0, 200.0], "n": [1, 2], "day": [day, None], "type": ["A", "B"]}
    keep = ["n", "day", "type"]
    plain = gumption.batch(budget, rows, keep=keep)
    assert all(plain[name] == rows[name] for name in (*keep, "label"))
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(rows, index=[3, 3]).astype({"type": "category", "n": "Int64"})
    found = gumption.batch(budget, frame, keep=keep)
    assert all(found[name].dtype == frame[name].dtype for name in (*keep, "label"))
    assert len(frame.merge(found, on="label")) == 2 and list(found["label"]) == [7, 8]
    polars = pytest.importorskip("polars")
    frame = polars.DataFrame(rows)
    found = gumption.batch(budget, frame, keep=keep)
    assert all(found[name].equals(frame[name]) for name in (*keep, "label"))
    arrow = pytest.importorskip("pyarrow")
    table = arrow.table(rows)
    found = gumption.batch(budget, table, keep=keep)
    assert all(found[name].equals(table[name]) for name in (*keep, "label"))
    # What has no label is called by its number.
    assert gumption.batch(budget, {"R": [1.0, 2.0], "label": ["a", None]})["label"] == ["a", "2"]
    mass = gumption.batch(budget, {"R": [1.0, 2.0], "mass [g]": [3, 4]}, keep="mass")
    assert mass["mass [g]"] == [3, 4]
    once = gumption.batch(budget, {"R": [1.0, 2.0], "type": (one for one in "AB")}, keep="type")
    assert once["type"] == ["A", "B"]


def test_contributions_that_correlate_are_told():
    budget = BUDGET.format(readings="[1.0, 1.1, 1.3, 1.2]", R=1, u=1) + '[[correlation]]\nbetween = ["V", "R"]\nr = 0.5\n'
    with pytest.warns(UserWarning, match="contributions of V, R correlate"):
        gumption.batch(budget, {"R": [100.0]}, contributions=True)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        gumption.batch(budget, {"R": [100.0]})
        gumption.batch(budget.partition("[[")[0], {"R": [100.0]}, contributions=True)


def test_tables_in_utf_16(tmp_path):
    budget, text = BUDGET.format(readings="[1, 2]", R=1, u=1), "label\tR [Ω]\r\n电阻\t100\r\n"
    expected = gumption.batch(budget, {"label": ["电阻"], "R [Ω]": [100.0]})
    for encoding in ("utf-16", "utf-16-le", "utf-16-be"):
        (tmp_path / "rows.csv").write_bytes(text.encode(encoding))
        found = gumption.batch(budget, tmp_path / "rows.csv")
        assert found["label"] == ["电阻"] and found["I [mA]"] == expected["I [mA]"] and found["error"] == [""]


def test_a_list_with_a_gap_is_a_fault_of_its_row():
    budget = BUDGET.format(readings="[1, 2]", R=1, u=1)
    rows = [[1.0, None, 1.2], [1.0, "much"], [1.0, 1.2]]
    found = gumption.batch(budget, {"V.readings": rows, "R": [1.0, 1.0, 1.0]})
    assert [bool(one) for one in found["error"]] == [True, True, False]


def test_what_is_no_table_of_rows_is_said():
    budget = BUDGET.format(readings="[1, 2]", R=1, u=1)
    with pytest.raises(ValueError, match="1 of R, 2 of V"):
        gumption.batch(budget, {"R": [1.0], "V": [1.0, 2.0]})
    pandas = pytest.importorskip("pandas")
    with pytest.raises(TypeError, match="names of columns are texts, and 0 is none"):
        gumption.batch(budget, pandas.DataFrame([[1.0, 2.0]]))
    polars = pytest.importorskip("polars")
    with pytest.raises(TypeError, match="not LazyFrame"):
        gumption.batch(budget, polars.LazyFrame({"R": [1.0]}))


def test_settings_that_do_nothing_are_refused():
    budget, rows = BUDGET.format(readings="[1, 2]", R=1, u=1), {"R": [1.0], "type": ["A"]}
    with pytest.raises(ValueError, match="trials, seed: of use with monte_carlo=True only"):
        gumption.batch(budget, rows, trials=5000, seed=1)
    with pytest.raises(TypeError, match="shares"):
        gumption.batch(budget, rows, shares="yes")
    assert gumption.batch(budget, rows, keep="type")["type"] == ["A"]


def test_a_line_of_means_is_no_row_of_a_table_in_memory():
    budget = BUDGET.format(readings="[1, 2]", R=1, u=1)
    rows = {"label": ["d1", "d2", "d3", "d4", "mean"], "R": [100.0, 203.0, 151.0, 170.0, 156.0]}
    tables = [rows]
    for library in ("pandas", "polars", "pyarrow"):
        frames = pytest.importorskip(library)
        tables.append(frames.table(rows) if library == "pyarrow" else frames.DataFrame(rows))
    for table in tables:
        with pytest.raises(gumption.Refused, match='line 6, "mean"') as refused:
            gumption.batch(budget, table)
        assert refused.value.faults[0].code == "R0108"
    with pytest.raises(gumption.Refused, match='line 6, "mean"'):
        gumption.batch(budget, tables[1].set_index("label"))
    assert len(gumption.batch(budget, {**rows, "label": ["d1", "d2", "d3", "d4", "d5"]})["error"]) == 5


def test_an_empty_table_has_the_columns_of_one_with_rows(tmp_path):
    budget = BUDGET.format(readings="[1, 2]", R=1, u=1)
    pandas, polars, arrow = (pytest.importorskip(name) for name in ("pandas", "polars", "pyarrow"))
    rows = {"R": [100.0], "type": ["A"], "number": [7]}
    keep = ["type", "number"]
    given = arrow.table(rows)
    some, none = (arrow.record_batch(gumption.arrow_batch(budget, given.slice(0, count), keep=keep)) for count in (1, 0))
    assert some.schema == none.schema and none.num_rows == 0
    frame = pandas.DataFrame(rows)
    some, none = (gumption.batch(budget, frame.head(count), keep=keep) for count in (1, 0))
    assert list(some.dtypes) == list(none.dtypes) and list(some) == list(none)
    frame = polars.DataFrame(rows)
    some, none = (gumption.batch(budget, frame.head(count), keep=keep) for count in (1, 0))
    assert some.schema == none.schema and len(polars.concat([some, none])) == 1
    # So has a file.
    place = tmp_path / "results.csv"
    gumption.batch(budget, "R,type\n", keep="type", output=place)
    assert place.read_text().startswith("label,type,I [mA],")


def test_large_whole_numbers_and_dates():
    budget = '[measurand.y]\nmodel = "x"\n[input]\nx = { value = 1, u = 0.01, relative = true }\n'
    found = gumption.batch(budget, {"x": [2**63, 2**64 - 1, -(2**70)]})
    assert found["error"] == ["", "", ""] and list(found["y"]) == [2.0**63, 2.0**64, -(2.0**70)]
    assert list(gumption.batch(budget, {"x": np.array([2**63], np.uint64)})["y"]) == [2.0**63]
    told = gumption.batch(budget, {"x": [datetime.date(2026, 1, 1)]})["error"][0]
    assert "a date is counted from a day that you choose" in told


def test_an_index_of_several_levels_is_a_label():
    pandas = pytest.importorskip("pandas")
    budget = BUDGET.format(readings="[1, 2]", R=1, u=1)
    index = pandas.MultiIndex.from_tuples([("A", 1), ("B", 2)])
    found = gumption.batch(budget, pandas.DataFrame({"R": [1.0, 2.0]}, index=index))
    assert list(found["label"]) == ["A 1", "B 2"] and found.index.equals(index)


def test_columns_of_runs_and_what_is_no_batch():
    arrow = pytest.importorskip("pyarrow")
    budget = BUDGET.format(readings="[1, 2]", R=1, u=1)
    runs = arrow.RunEndEncodedArray.from_arrays([2, 3], [100.0, 200.0])
    found = arrow.record_batch(gumption.arrow_batch(budget, arrow.table({"R": runs})))
    plain = gumption.batch(budget, {"R": [100.0, 100.0, 200.0]})
    assert found["I [mA]"].to_pylist() == list(plain["I [mA]"])
    with pytest.raises(TypeError, match="interface of Arrow is needed, not dict"):
        gumption.arrow_batch(budget, {"R": [1.0]})


def test_an_output_is_no_file_that_the_budget_names(tmp_path):
    budget, data = tmp_path / "budget.toml", tmp_path / "data.csv"
    budget.write_text('[measurand.y]\nmodel = "V * x"\n[input]\nV = { readings = { file = "data.csv", column = "V" } }\nx = { value = 1, u = 0.1 }\n')
    data.write_text("V\n1.0\n1.1\n1.2\n")
    with pytest.raises(OSError, match="never overwritten"):
        gumption.batch(budget, {"x": [1.0, 2.0]}, output=data, replace=True)
    assert data.read_text().startswith("V\n1.0")
