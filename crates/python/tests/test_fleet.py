"""Fleets, and calibrations of many recordings: the bits of the command line, from files, columns and frames."""

import csv
import json
import subprocess
from pathlib import Path

import gumption
import numpy as np
import pytest

TOP = Path(__file__).parents[3]
EXAMPLE = TOP / "docs/examples/fleet"

GYRO = """
recording = { file = "a.csv", average = "none" }
equations = "U = K*omega*(1 + e_rate) + b"
[input.e_rate]
certificate = { U = 2e-4, k = 2 }
"""


@pytest.fixture(scope="session")
def program():
    """The command, as `cargo build` leaves it."""
    return TOP / "target" / "debug" / "gumption"


def by_command(program, folder, *arguments):
    run = subprocess.run([program, *arguments], capture_output=True, text=True, cwd=folder)
    return run.stdout


@pytest.fixture(scope="session")
def statistics(program):
    arguments = ["fleet", "docs/examples/fleet/results.csv", "--by", "type,laboratory", "--date", "date", "--json"]
    return json.loads(by_command(program, TOP, *arguments))


def without_table(found):
    return {key: value for key, value in found.items() if key != "table"}


def devices(results):
    with open(results, newline="") as file:
        head, *rows = csv.reader(file)
    return {name: [row[at] for row in rows] for at, name in enumerate(head)}


@pytest.mark.parametrize("way", ["path", "text", "columns", "pandas", "polars"])
def test_fleets_have_the_bits_of_the_command(statistics, way):
    path = EXAMPLE / "results.csv"
    if way == "path":
        given = path
    elif way == "text":
        given = path.read_text()
    elif way == "columns":
        given = devices(path)
    else:
        given = pytest.importorskip(way).read_csv(path)
    found = gumption.fleet(given, by=["type", "laboratory"], date="date")
    assert without_table(found.rows[0].to_dict()) == without_table(statistics)


def test_what_a_batch_gives_is_a_fleet(statistics):
    table = EXAMPLE / "devices.csv"
    batch = gumption.batch(EXAMPLE / "resistors.toml", table, keep=["type", "laboratory", "date"], shares=True)
    found = gumption.fleet(batch, by=["type", "laboratory"], date="date")
    assert without_table(found.rows[0].to_dict()) == without_table(statistics)
    groups = found.table()
    assert groups["type"] == [group["key"][0] for group in statistics["groups"]]
    assert groups["measurand"][0] == "R" and groups["mean"][0] == statistics["measurands"][0]["groups"][0]["mean"]
    assert len(groups.to_pandas()) == len(groups.to_polars()) == len(statistics["groups"])
    assert found["R"].groups[0].consistency.birge > 0
    assert "<iframe" in found._repr_html_() and "E_n" in found.text()
    # A device that drifts stands apart, in the words of both languages.
    assert "A4" in found.text() and "A4" in found.text("zh")


def test_faults_of_a_fleet_are_typed():
    with pytest.raises(gumption.Refused, match="no column"):
        gumption.fleet(EXAMPLE / "results.csv", by="typ")
    with pytest.raises(gumption.Refused, match="is not a number"):
        gumption.fleet({"y": ["1", "x"], "u(y)": [0.1, 0.1], "k(y)": [2.0, 2.0]})
    with pytest.raises(gumption.Refused, match="no rows"):
        gumption.fleet({"y": [], "u(y)": [], "k(y)": []})


def recording(seed, slope):
    noise = np.random.default_rng(seed).normal(0, 1e-4, 24)
    omega = np.tile(np.arange(-55.0, 65.0, 10.0), 2)
    return {"omega [deg/s]": omega, "U [V]": slope * omega + 0.002 + noise}


def as_text(columns):
    rows = zip(*columns.values())
    return ",".join(columns) + "\n" + "".join(",".join(repr(float(one)) for one in row) + "\n" for row in rows)


def same(found, expected):
    assert list(found) == list(expected)
    for name, column in expected.items():
        if isinstance(column, list):
            assert list(found[name]) == column, name
        else:
            np.testing.assert_array_equal(np.asarray(found[name], float), column, name)


@pytest.fixture
def runs(tmp_path):
    folder = tmp_path / "runs"
    folder.mkdir()
    columns = {name: recording(at, 0.01 + 1e-4 * at) for at, name in enumerate("abc")}
    for name, one in columns.items():
        (folder / f"{name}.csv").write_text(as_text(one))
    (folder / "bad.csv").write_text("omega [deg/s],V [V]\n1,2\n")
    (tmp_path / "gyro.toml").write_text(GYRO)
    return tmp_path, columns


def test_calibrations_have_the_bits_of_the_command(program, runs):
    folder, _ = runs
    text = by_command(program, folder, "calibrate", "gyro.toml", "--lang", "en", "--shares", "--recordings", "runs")
    told = []
    found = gumption.calibrate(folder / "gyro.toml", recordings=folder / "runs", shares=True, progress=told.append)
    head, *rows = csv.reader(text.splitlines())
    assert list(found) == head and found["label"] == ["a", "b", "bad", "c"]
    for at, name in enumerate(head):
        texts = [row[at] for row in rows]
        if name in ("label", "findings", "error"):
            # Paths are as they were given.
            assert [one[:5] for one in found[name]] == [one[:5] for one in texts]
        else:
            np.testing.assert_array_equal(found[name], [float(one or "nan") for one in texts])
    assert found["share(K, e_rate)"][0] > 0 and found["error"][2] and told[-1] == 1.0
    assert isinstance(found, gumption.Table) and "<table>" in found._repr_html_()
    assert len(found.to_pandas()) == 4
    fleet = gumption.fleet(found)
    assert fleet.groups[0].faulty[0].rows == 1 and fleet["K"].groups[0].components


def test_recordings_in_memory_are_those_of_files(runs):
    folder, columns = runs
    names = list(columns)
    expected = gumption.calibrate(folder / "gyro.toml", recordings=[folder / "runs" / f"{name}.csv" for name in names])
    pandas = pytest.importorskip("pandas")
    ways = {
        "texts": {name: as_text(one) for name, one in columns.items()},
        "columns": columns,
        "frames": {name: pandas.DataFrame(one) for name, one in columns.items()},
        "files": {name: folder / "runs" / f"{name}.csv" for name in names},
    }
    for way in ways.values():
        same(gumption.calibrate(GYRO, recordings=way), expected)
        same(gumption.calibrate(folder / "gyro.toml", recordings=way), expected)
    same(gumption.calibrate(GYRO, recordings=[folder / "runs" / f"{name}.csv" for name in names]), expected)
    alone = gumption.calibrate(GYRO.replace("a.csv", "b.csv"), files={"b.csv": as_text(columns["b"])})
    assert (alone["K"].value, alone["K"].u) == (expected["K [V·s/deg]"][1], expected["u(K) [V·s/deg]"][1])
    assert alone.table()["value"][0] == alone["K"].value and alone.table()["coefficient"] == ["K", "b"]


def test_recordings_may_be_called_by_numbers():
    experiment = 'recording = { file = "one.csv", average = "none" }\nequations = "U = K*omega + b"\n'
    columns = {"omega [deg/s]": [-20.0, 0.0, 20.0], "U [V]": [-0.2, 0.0001, 0.2]}
    assert gumption.calibrate(experiment, recordings={17: columns})["label"] == ["17"]


def test_a_recording_that_cannot_be_read_stops_nothing(runs):
    _, columns = runs
    short = {**columns["a"], "U [V]": [0.1]}
    recordings = {"a": columns["a"], "short": short, "b": columns["b"], "none": Path("none.csv")}
    found = gumption.calibrate(GYRO, recordings=recordings)
    expected = gumption.calibrate(GYRO, recordings={name: columns[name] for name in "ab"})
    assert list(found) == list(expected) and found["label"] == list(recordings)
    assert list(found["K [V·s/deg]"][[0, 2]]) == list(expected["K [V·s/deg]"]) and np.isnan(found["K [V·s/deg]"][1])
    assert "1 of U [V]" in found["error"][1] and "none.csv" in found["error"][3] and found["error"][::2] == ["", ""]
    assert gumption.calibrate(GYRO, recordings={"short": short})["label"] == ["short"]


def test_findings_of_recordings_are_texts(runs):
    folder, columns = runs
    gap = {name: column.copy() for name, column in columns["a"].items()}
    gap["U [V]"][3] = np.nan
    found = gumption.calibrate(GYRO, recordings={"a": columns["a"], "gap": gap})
    assert found["findings"][0] == "" and found["findings"][1] and not any(found["error"])


def test_figures_of_a_table_that_contradict_each_other():
    columns = {"y [V]": [1.0, 1.1], "u(y) [V]": [0.1, 0.1], "k(y)": [2.0, 2.0], "U(y) [mV]": [200.0, 200.0]}
    assert gumption.fleet(columns)["y"].groups[0].values == 2
    # Within what is rounded.
    assert gumption.fleet({**columns, "k(y)": [1.96, 2.0]})["y"].groups[0].values == 2
    with pytest.raises(gumption.Refused, match="F0105.*not k·u"):
        gumption.fleet({**columns, "U(y) [mV]": [200.0, 500.0]})
    with pytest.raises(gumption.Refused, match="cannot be 0"):
        gumption.fleet({**columns, "k(y)": [0.0, 2.0]})
    rows = "label;y;u(y);k(y)\nA;1,0;0,1;2\nB;1,1;0,1;2\nC;1,2;0,1;2\n"
    assert gumption.fleet(rows)["y"].groups[0].values == 3
    with pytest.raises(gumption.Refused, match="decimal"):
        gumption.fleet(rows + "D;1.234;0,1;2\n")
    with pytest.raises(gumption.Refused, match="means of those"):
        gumption.fleet(rows + "mean;1,1;0,1;2\n")


def test_a_group_may_be_called_as_a_figure_is():
    columns = {"y": [1.0, 1.1, 1.2], "u(y)": [0.1] * 3, "k(y)": [2.0] * 3, "mean": ["p", "p", "q"]}
    table = gumption.fleet(columns, by="mean").table()
    assert table["mean (group)"] == ["p", "q"] and table["mean"][1] == 1.2
    with pytest.raises(TypeError, match="date: the name of a column"):
        gumption.fleet(columns, date=["x"])


def test_an_empty_folder_is_said(tmp_path):
    with pytest.raises(OSError, match="no CSV file"):
        gumption.calibrate(GYRO, recordings=tmp_path)


def test_many_calibrations_can_be_stopped(runs):
    folder, columns = runs

    def stop(_):
        raise RuntimeError("enough")

    many = {str(at): columns["a"] for at in range(3000)}
    with pytest.raises(RuntimeError, match="enough"):
        gumption.calibrate(GYRO, recordings=many, progress=stop)


def test_what_is_no_table_is_said(runs):
    folder, columns = runs
    pandas = pytest.importorskip("pandas")
    budget = EXAMPLE / "resistors.toml"
    for given in ([1, 2], [{"ratio": 1.0}], gumption.evaluate(budget), 7):
        with pytest.raises(TypeError, match="a table is a CSV file"):
            gumption.fleet(given)
        with pytest.raises(TypeError, match="a table is a CSV file"):
            gumption.batch(budget, given)
    with pytest.raises(TypeError, match="the column ratio is 1.0"):
        gumption.batch(budget, {"ratio": 1.0})
    frame = pandas.DataFrame(columns["a"])
    for given in (frame, [frame]):
        with pytest.raises(TypeError, match="a dict of names with frames"):
            gumption.calibrate(GYRO, recordings=given)


def test_an_experiment_that_is_none_is_refused(runs):
    folder, _ = runs
    with pytest.raises(gumption.Refused, match="no file"):
        gumption.calibrate(folder / "none.toml", recordings=folder / "runs")
    with pytest.raises(gumption.Refused):
        gumption.calibrate("equations = [", recordings=folder / "runs")


def test_a_group_of_one_row_has_the_columns_of_the_others():
    def groups(names):
        return gumption.fleet({"R": [1.0, 2.0, 2.1, 2.05], "u(R)": [0.1] * 4, "k(R)": [2.0] * 4, "type": names}, by="type").table()

    first, last, alone = groups(list("ABBB")), groups(list("ZBBB")), groups(list("ABCD"))
    assert list(first) == list(last) == list(alone) and "consistency" not in first
    assert np.isnan(first["birge"][0]) and first["birge"][1] == last["birge"][0] and np.isnan(alone["birge"]).all()


def test_a_line_of_means_is_no_device_of_columns():
    rows = {"label": ["d1", "d2", "d3", "d4", "mean"], "R": [1.0, 1.3, 1.2, 1.1, 1.15], "u(R)": [0.1, 0.12, 0.11, 0.13, 0.115], "k(R)": [2.0] * 5}
    for table in (rows, pytest.importorskip("pandas").DataFrame(rows)):
        with pytest.raises(gumption.Refused, match='line 6, "mean"'):
            gumption.fleet(table)
