"""The package says what the command line says, to the last bit."""

import copy
import datetime
import json
import math
import pickle
import random
import subprocess
import sys
import threading
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import gumption
import numpy as np
import pytest

TOP = Path(__file__).parents[3]
BUDGETS = sorted((TOP / "budgets").rglob("*.toml"))

RESISTOR = """
title = "Current through a resistor"
[measurand.I]
model = "V / R"
unit = "mA"
[input]
V = { value = 1.0001, unit = "V", u = 0.0003 }
R = { value = 100.02, unit = "ohm", half_width = 0.01 }
"""


@pytest.fixture(scope="session")
def program():
    """The command, as `cargo build` leaves it."""
    path = TOP / "target" / "debug" / "gumption"
    assert path.exists(), "cargo build"
    return path


@pytest.mark.parametrize("path", BUDGETS, ids=lambda path: path.stem)
def test_same_bits_as_the_command(program, path):
    command = [program, "eval", path, "--json", "--full", "--trials", "20000"]
    run = subprocess.run(command, capture_output=True, text=True, cwd=TOP)
    expected = json.loads(run.stdout)
    result = gumption.evaluate(path, trials=20_000)
    expected = expected if isinstance(expected, list) else [expected]
    # Floats read back what was printed, and both print the shortest decimal that does: equal lists are equal bits.
    assert [row.to_dict() for row in result] == expected


def test_matrices_are_arrays():
    omega, read = np.array([-2.0, -1.0, 0.0, 1.0, 3.0]), np.array([-2.01, -1.0, 0.02, 1.01, 2.99])
    text = "omega [deg/s],U [V]\n" + "".join(f"{x},{y}\n" for x, y in zip(omega, read))
    experiment = {"recording": {"file": "r.csv", "average": "none"}, "equations": "U = K*omega + b"}
    found = gumption.calibrate(experiment, files={"r.csv": text})
    # Ordinary least squares: s² (XᵀX)⁻¹.
    columns = np.column_stack([omega, np.ones(5)])
    parameters, squares, *_ = np.linalg.lstsq(columns, read, rcond=None)
    expected = squares[0] / 3 * np.linalg.inv(columns.T @ columns)
    assert found.covariance.shape == (2, 2) and np.allclose(found.covariance, expected, rtol=1e-9)
    assert math.isclose(found["K"].value, parameters[0], rel_tol=1e-12)


def test_figures_by_their_symbols():
    current = gumption.evaluate(RESISTOR)["I"]
    assert current.unit == "mA"
    assert math.isclose(current.y, 1.0001 / 100.02 * 1e3, rel_tol=1e-15)
    # Closed form: relative uncertainties of a quotient in quadrature, the half-width divided by the root of 3.
    u = current.y * math.hypot(0.0003 / 1.0001, 0.01 / math.sqrt(3) / 100.02)
    assert math.isclose(current.u, u, rel_tol=1e-12)
    assert math.isclose(current.U, current.k * current.u, rel_tol=1e-15)
    assert current.interval == (current.y - current.U, current.y + current.U)
    assert repr(current).startswith("<I = 9.99900") and f", k = {current.k:.5g}, U = " in repr(current)
    assert current.gum.effective_degrees_of_freedom == math.inf


def test_a_dict_is_a_budget():
    budget = {
        "title": "Current",
        "measurand": {"I": {"model": "V / R", "unit": "mA"}},
        "input": {
            "V": {"value": np.float64(1.0001), "unit": "V", "u": 0.0003, "dof": math.inf},
            "R": {"value": 100.02, "unit": "ohm", "half_width": np.array(0.01), "u": None},
        },
    }
    from_dict, from_text = gumption.evaluate(budget), gumption.evaluate(RESISTOR)
    assert from_dict["I"].to_dict() == from_text["I"].to_dict()
    # Components are drawn in their order, so that the order of a dict is that of the file.
    assert [one.name for one in from_dict.inputs] == ["V", "R"]
    readings = {"measurand": {"y": {"model": "x"}}, "input": {"x": {"readings": np.array([1.0, 2.0, 4.0])}}}
    assert math.isclose(gumption.evaluate(readings)["y"].y, 7 / 3)
    exact = {"measurand": {"y": {"model": "x"}}, "input": {"x": {"value": Decimal("1.5"), "u": Fraction(1, 4)}}}
    assert gumption.evaluate(exact)["y"].u == 0.25
    for unfit in (object(), 1 + 2j, b"1.0", {1.0, 1.1}, [1.0, None]):
        with pytest.raises(TypeError, match=r"^input\.x\.readings.* cannot stand in a file"):
            gumption.evaluate({"measurand": {"y": {"model": "x"}}, "input": {"x": {"readings": unfit}}})


def of_x(**known):
    return {"measurand": {"y": {"model": "x"}}, "input": {"x": known}}


def test_what_can_be_gone_through_once_is_a_list():
    readings = [1.0, 1.1, 1.2, 1.3]
    expected = gumption.evaluate(of_x(readings=readings))["y"]
    for once in (lambda: (x for x in readings), lambda: iter(readings), lambda: map(float, readings), lambda: dict.fromkeys(readings).keys()):
        found = gumption.evaluate(of_x(readings=once()))["y"]
        assert found.to_dict() == expected.to_dict()
    tables = [{"u": 0.1}, {"half_width": 0.2}]
    found = gumption.evaluate(of_x(value=1, components=(one for one in tables)))["y"]
    assert found.u == gumption.evaluate(of_x(value=1, components=tables))["y"].u


def test_what_contains_itself_is_refused():
    own = {"value": 1}
    own["u"] = own
    deep = 0.1
    for _ in range(100_000):
        deep = [deep]
    for known in (own, {"readings": deep}):
        with pytest.raises(TypeError, match="no more than 100 levels"):
            gumption.evaluate(of_x(**known))
    long = np.longdouble("0.1")
    assert gumption.evaluate(of_x(value=long * 10, u=long))["y"].u == 0.1
    assert gumption.evaluate(of_x(readings=np.array([1, 2, 3], np.longdouble)))["y"].y == 2
    with pytest.raises(TypeError, match="cannot stand in a file"):
        gumption.evaluate(of_x(readings=[np.clongdouble(1)]))


def test_masked_values_are_no_values():
    masked = np.ma.array([1.0, 1.1, 99.0], mask=[0, 0, 1])
    with pytest.raises(TypeError, match=r"input\.x\.readings: some values are masked"):
        gumption.evaluate(of_x(readings=masked))
    assert math.isclose(gumption.evaluate(of_x(readings=masked.compressed()))["y"].y, 1.05)
    with pytest.raises(TypeError, match="masked"):
        gumption.quantity(readings=masked)
    with pytest.raises(TypeError, match="masked"):
        gumption.evaluate(of_x(value=masked[2], u=0.1))
    whole = gumption.evaluate(of_x(readings=np.ma.array([1.0, 2.0, 4.0])))["y"]
    assert math.isclose(whole.y, 7 / 3)


def test_a_budget_in_memory_says_what_it_needs(tmp_path, monkeypatch):
    (tmp_path / "rr.csv").write_text("U\n1.0\n1.2\n")
    monkeypatch.chdir(tmp_path)
    budget = of_x(readings={"file": "rr.csv", "column": "U"})
    with pytest.raises(gumption.Refused, match="no file rr.csv in what was given in memory") as refused:
        gumption.evaluate(budget)
    assert 'files={"rr.csv"' in refused.value.faults[0].mend
    for name in ("rr.csv", Path("rr.csv")):
        assert gumption.evaluate(budget, files={name: Path("rr.csv").read_bytes()})["y"].y == 1.1
    experiment = 'recording = { file = "rr.csv", average = "none" }\nequations = "U = K*omega + b"\n'
    with pytest.raises(gumption.Refused, match='files={"rr.csv"'):
        gumption.calibrate(experiment)


def test_tables_have_arrays():
    table = gumption.evaluate(RESISTOR, trials=2000, profile="JJF").table()
    assert isinstance(table["u"], np.ndarray) and table["measurand"] == ["I"] and table["label"] == [None]
    assert np.isnan(table["nu"][0]) and isinstance(table.copy(), gumption.Table)


def test_paths_stand_in_a_dict():
    readings = {"readings": {"file": Path("readings.csv"), "column": "U"}}
    budget = {"measurand": {"y": {"model": "x"}}, "input": {"x": readings}}
    assert gumption.evaluate(budget, files={"readings.csv": "U\n1.0\n1.2\n"})["y"].y == 1.1
    for unfit in (3, [1.0, 1.2]):
        with pytest.raises(TypeError, match="what readings.csv holds is a text, bytes or a path"):
            gumption.evaluate(budget, files={"readings.csv": unfit})
    for unfit in (None, 3, [budget], b"[input]\n"):
        with pytest.raises(TypeError, match="a file is its path, its text, or a dict"):
            gumption.evaluate(unfit)


def test_a_path_with_files_in_memory(tmp_path):
    (tmp_path / "mean.toml").write_text(
        '[measurand]\nU.model = "V"\nU.unit = "V"\n[input]\n'
        'V = { unit = "V", readings = { file = "readings.csv", column = "U" } }\n'
    )
    result = gumption.evaluate(tmp_path / "mean.toml", files={"readings.csv": b"U\n1\n2\n3\n"})
    assert result["U"].y == 2


def test_files_in_memory():
    text = """
    title = "Mean"
    [measurand.U]
    model = "V"
    unit = "V"
    [input.V]
    unit = "V"
    readings = { file = "readings.csv", column = "U" }
    """
    result = gumption.evaluate(text, files={"readings.csv": "U\n1.0001\n1.0003\n1.0000\n1.0002\n"})
    assert math.isclose(result["U"].y, 1.00015)


def test_samples_are_arrays_of_one_distribution():
    result = gumption.evaluate(RESISTOR, trials=2000)
    samples = result.samples(100_000)["I"]
    assert isinstance(samples, np.ndarray) and samples.shape == (100_000,)
    # Standard error of a mean and, for a nearly normal output, of a standard deviation: five of them.
    u = result["I"].u
    assert abs(samples.mean() - result["I"].y) < 5 * u / math.sqrt(len(samples))
    assert abs(samples.std(ddof=1) - u) < 5 * u / math.sqrt(2 * len(samples))


def test_samples_are_those_of_the_run():
    result = gumption.evaluate(RESISTOR, trials=2000, seed=5)
    mean = result.samples(2000)["I"].mean()
    assert math.isclose(mean, result["I"].monte_carlo.estimate, rel_tol=1e-14)


def test_samples_are_not_copied():
    (samples,) = gumption.evaluate(RESISTOR, trials=2000).samples(4000).values()
    # The array looks at the memory of the engine, which lives as long as it does.
    assert not samples.flags.owndata and type(samples.base).__name__ == "PySliceContainer"
    assert samples.flags.writeable and samples.flags.c_contiguous


def test_samples_are_as_many_as_fit():
    result = gumption.evaluate(RESISTOR, trials=1000)
    assert len(result.samples(1e3)["I"]) == 1000
    with pytest.raises(ValueError, match="trials"):
        result.samples(0)
    with pytest.raises(MemoryError, match="do not fit into the memory"):
        result.samples(10**15)
    with pytest.raises(IndexError):
        result.samples(1000, row=1)


def test_what_is_handed_over_comes_back():
    result = gumption.evaluate(RESISTOR, trials=1000)
    assert "I" in result and "J" not in result
    assert copy.deepcopy(result) is result and copy.copy(result) is result
    assert pickle.loads(pickle.dumps(result["I"])).u == result["I"].u
    with pytest.raises(TypeError, match="stays in its process"):
        pickle.dumps(result)
    with pytest.raises(gumption.Refused) as refused:
        gumption.evaluate(RESISTOR.replace("half_width", "half_widht"))
    again = pickle.loads(pickle.dumps(refused.value))
    assert (str(again), again.faults) == (str(refused.value), refused.value.faults)
    with pytest.raises(gumption.NoResult) as without:
        gumption.evaluate('[measurand]\ny.model = "sqrt(x)"\n[input]\nx = { value = 0, u = 0.1 }\n', monte_carlo=False)
    again = pickle.loads(pickle.dumps(without.value))
    assert (str(again), again.code) == (str(without.value), without.value.code)


def test_faults_are_typed():
    with pytest.raises(gumption.Refused) as refused:
        gumption.evaluate(RESISTOR.replace("half_width", "half_widht"))
    fault = next(fault for fault in refused.value.faults if "half_widht" in fault.message)
    assert (fault.line, fault.column) == (8, RESISTOR.splitlines()[7].index("half_width") + 1)
    assert "half_width" in fault.mend and fault.code in str(refused.value)


def test_faults_are_said_in_the_language():
    with pytest.raises(gumption.Refused, match="错误"):
        gumption.evaluate(RESISTOR.replace("half_width", "half_widht"), language="zh")
    with pytest.raises(ValueError, match="language"):
        gumption.evaluate(RESISTOR, language="fr")


def test_a_budget_without_a_derivative_says_why():
    with pytest.raises(gumption.NoResult, match="no finite derivative"):
        root = '[measurand]\ny.model = "sqrt(x)"\n[input]\nx = { value = 0, u = 0.1 }\n'
        gumption.evaluate(root, monte_carlo=False)


def test_settings_are_checked():
    wrong_values = [
        {"trials": 10},
        {"trials": "many"},
        {"trials": 10**15},
        {"seed": -1},
        {"threads": 0},
        {"profile": "nobody"},
        {"monte_carlo": False, "seed": 1},
    ]
    for wrong in wrong_values:
        with pytest.raises(ValueError, match=list(wrong)[-1]):
            gumption.evaluate(RESISTOR, **wrong)
    for wrong in ({"trials": 1500.5}, {"seed": "1"}, {"profile": 3}, {"monte_carlo": "no"}, {"quasi_random": 1}):
        with pytest.raises(TypeError, match=list(wrong)[-1]):
            gumption.evaluate(RESISTOR, **wrong)
    same = [gumption.evaluate(RESISTOR, trials=trials)["I"].u for trials in (10_000, 1e4, np.int32(10_000))]
    assert same[0] == same[1] == same[2]


def test_a_missing_file_is_refused():
    with pytest.raises(gumption.Refused):
        gumption.evaluate("no-such-budget.toml")


def test_reports_in_both_languages():
    result = gumption.evaluate(RESISTOR)
    assert "Uncertainty budget" in result.text() and "不确定度" in result.text("zh")
    assert result._repr_html_().startswith("<iframe") and "&lt;svg" in result._repr_html_()
    assert "U = " in result.statement
    assert result.to_xlsx().startswith(b"PK")


def test_certificates():
    result = gumption.evaluate(RESISTOR)
    with pytest.raises(ValueError, match="names the laboratory"):
        result.to_dcc()
    data = {
        "number": "17",
        "begin": datetime.date(2026, 1, 15),
        "laboratory": {"name": "Electrical laboratory", "city": "Beijing", "country": "CN"},
        "customer": {"name": "Makers of resistors", "city": "Shanghai", "country": "CN"},
        "item": [{"name": "Resistor", "serial": "R-17"}],
        "person": [{"name": "A. Lin", "role": "Head"}],
    }
    dcc = result.to_dcc(data, language="both")
    assert b"digitalCalibrationCertificate" in dcc and b"2026-01-15" in dcc and b'lang="zh"' in dcc
    certified = result.certified(data)
    assert "Electrical laboratory" in certified.text() and certified["I"].to_dict() == result["I"].to_dict()
    assert "Electrical laboratory" not in result.text()
    with pytest.raises(gumption.Refused, match="certificate.toml"):
        result.certified({**data, "number": 17})
    with pytest.raises(ValueError, match="evaluated budget"):
        gumption.audit(TOP / "docs/examples/claimed-budget.csv").certified(data)


def test_the_certificate_of_the_command(program, tmp_path):
    budget, data = TOP / "budgets/mass/weight-10kg-ea402-s2.toml", TOP / "reports/certificates/laboratory.toml"
    assert budget.exists()
    command = [program, "eval", budget, "--certificate", data, "--lang", "both", "-o", tmp_path / "theirs.xml"]
    subprocess.run(command, check=True, capture_output=True)
    assert gumption.evaluate(budget).to_dcc(data, language="both") == (tmp_path / "theirs.xml").read_bytes()


def test_reports_are_written_as_a_whole(tmp_path):
    result, page = gumption.evaluate(RESISTOR), tmp_path / "current.html"
    result.save(page)
    result.save(page)
    assert page.read_text(encoding="utf-8") == result.to_html()
    page.write_text("mine")
    with pytest.raises(FileExistsError):
        result.save(page)
    assert page.read_text() == "mine"
    result.save(page, replace=True)
    with pytest.raises(ValueError, match="endings"):
        result.save(tmp_path / "current.doc")


def test_what_was_read_is_never_overwritten(tmp_path):
    budget, data, sheet = tmp_path / "budget.toml", tmp_path / "data.txt", tmp_path / "sheet.xlsx"
    budget.write_text('[measurand.U]\nmodel = "V"\n[input]\nV = { readings = { file = "data.txt", column = "V" } }\n')
    data.write_text("V\n1.0\n1.1\n1.2\n")
    (tmp_path / "link.txt").symlink_to(data)
    read = gumption.evaluate(budget, monte_carlo=False)
    given = gumption.evaluate(budget.read_text(), files={"data.txt": data}, monte_carlo=False)
    for result, place in ((read, data), (read, tmp_path / "link.txt"), (read, budget), (given, data)):
        if place.suffix == ".toml":
            place = place.rename(tmp_path / "budget.txt")
        with pytest.raises(OSError, match="is read by this command and is never overwritten"):
            result.save(place, replace=True)
    assert data.read_text().startswith("V\n1.0")
    read.save(sheet)
    # What another result has written, and read, is nothing to this one.
    audited = gumption.audit(sheet)
    with pytest.raises(OSError, match="never overwritten"):
        audited.save(sheet)
    read.save(sheet)
    laboratory = tmp_path / "laboratory.txt"
    laboratory.write_bytes((TOP / "reports/certificates/laboratory.toml").read_bytes())
    certified = read.certified(laboratory)
    with pytest.raises(OSError, match="never overwritten"):
        certified.save(laboratory, replace=True)
    read.save(laboratory, replace=True)


def test_frames():
    series = RESISTOR + '[series]\ncolumns = ["label", "V"]\nrows = [["a", 1.0], ["b", 2.0]]\n'
    result = gumption.evaluate(series, trials=2000)
    assert len(result) == 2
    expected = [row["I"].U for row in result]
    for frame in ("pandas", "polars"):
        pytest.importorskip(frame)
        table = getattr(result, f"to_{frame}")()
        assert list(table["U"]) == expected and list(table["label"]) == ["a", "b"]
    with pytest.raises(LookupError, match="2 rows"):
        result["I"]
    assert not hasattr(result, "zzz") and getattr(result, "measurands", None) is None and hasattr(result, "rows")


def test_an_interrupt_ends_an_evaluation():
    script = f"""
import gumption, _thread, threading
threading.Timer(1.0, _thread.interrupt_main).start()
try:
    gumption.evaluate({RESISTOR!r}, trials=4 * 10**9)
except KeyboardInterrupt:
    print("interrupted")
"""
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert run.stdout == "interrupted\n", run.stderr


def test_other_threads_run_during_an_evaluation():
    began, over = threading.Event(), threading.Event()
    counted, told = [], []

    def count():
        began.wait()
        while not over.is_set():
            counted.append(None)

    # Between two calls of `progress` the main thread is in the engine: what is counted there, another thread counted.
    def progress(_):
        if told and len(counted) > told[-1]:
            raise RuntimeError("enough")
        began.set()
        told.append(len(counted))

    counter = threading.Thread(target=count)
    counter.start()
    try:
        with pytest.raises(RuntimeError, match="enough"):
            gumption.evaluate(RESISTOR, trials=4 * 10**9, progress=progress)
    finally:
        began.set()
        over.set()
        counter.join()


def test_progress_tells_the_trials_and_may_end_them():
    told = []
    gumption.evaluate(RESISTOR, trials=50_000, progress=told.append)
    assert told == sorted(told) and told[-1] >= 50_000

    def stop(_):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        gumption.evaluate(RESISTOR, trials=4 * 10**9, progress=stop)


def test_a_calibration_becomes_a_budget():
    recording = "omega [deg/s],U [V]\n-20,-0.1999\n-10,-0.0999\n0,0.0002\n10,0.1001\n20,0.2003\n"
    experiment = """
    recording = { file = "run.csv", average = "none" }
    equations = "U = K*omega + b"
    """
    found = gumption.calibrate(experiment, files={"run.csv": recording})
    x, y = np.array([-20, -10, 0, 10, 20]), np.array([-0.1999, -0.0999, 0.0002, 0.1001, 0.2003])
    slope = np.polyfit(x, y, 1)[0]
    assert math.isclose(found["K"].value, slope, rel_tol=1e-9)
    again = gumption.evaluate(found.files()["budget.toml"])
    assert math.isclose(again["K"].gum.estimate, slope, rel_tol=1e-9)


def test_a_diagnosis_finds_the_square_and_tells_its_progress():
    lines, noise = [], random.Random(1)
    for k in range(40):
        x = (k % 20) / 10 - 1
        lines.append(f"{x},{1 + 2 * x + 0.02 * x * x + noise.gauss(0, 1e-3)}")
    experiment = """
    recording = "recording.csv"
    equations = "y = a + b*x"
    [columns]
    x = "stimulus"
    y = "output"
    [noise]
    u = "1 mV"
    """
    files = {"recording.csv": "x,y [V]\n" + "\n".join(lines) + "\n"}
    shares = []
    found = gumption.diagnose(experiment, files=files, progress=shares.append)
    assert found.verdict == "identified" and found.effects[0].named[0].id == "quadratic"
    assert set(found.files()) >= {"budget.toml", "case.toml", "recording.csv"}
    assert shares and all(0 <= share <= 1 for share in shares)
    [rival] = gumption.diagnose(experiment, files=files, why="cubic").accounts
    assert rival.standing == "excluded" and rival.instead.noise_factor > 1
    with pytest.raises(ValueError, match="the catalogue has no effect"):
        gumption.diagnose(experiment, files=files, why="astrology")

    class Enough(Exception):
        pass

    def stop(_):
        raise Enough

    with pytest.raises(Enough):
        gumption.diagnose(experiment, files=files, progress=stop)


def test_a_calibration_without_a_result_says_why():
    experiment = 'recording = { file = "run.csv", average = "none" }\nequations = "U = K*omega + b"\n'
    with pytest.raises((gumption.NoResult, gumption.Refused)) as why:
        gumption.calibrate(experiment, files={"run.csv": "omega [deg/s],U [V]\n10,0.1\n10,0.1\n10,0.1\n"})
    assert str(why.value)


@pytest.mark.parametrize(
    ("command", "path"),
    [("plan", "experiments/tumble-plan.toml"), ("audit", "docs/examples/claimed-budget.csv")],
)
def test_other_commands_say_the_same(program, command, path):
    run = subprocess.run([program, command, path, "--json"], capture_output=True, text=True, cwd=TOP)
    found = getattr(gumption, command)(TOP / path)
    expected = json.loads(run.stdout)
    assert found.rows[0].to_dict().keys() == expected.keys()
    assert _without_paths(found.rows[0].to_dict()) == _without_paths(expected)


def _without_paths(value):
    """The same without the names of files, which are those that were given."""
    return json.loads(json.dumps(value).replace(str(TOP) + "/", ""))


def test_a_simulation_is_the_recording_of_its_experiment(program):
    experiment = """
    recording = "recording.csv"
    equations = "y = a + b*x"
    [columns]
    x = "stimulus"
    y = "output"
    [noise]
    u = "1 mV"
    """
    recorded = "x,y [V]\n" + "".join(f"{x},{1 + 2 * x}\n" for x in range(12))
    simulated = gumption.simulate(experiment, files={"recording.csv": recorded}, seed=3)
    again = gumption.simulate(experiment, files={"recording.csv": recorded}, seed=3)
    other = gumption.simulate(experiment, files={"recording.csv": recorded}, seed=4)
    assert simulated == again != other
    assert gumption.diagnose(experiment, files={"recording.csv": simulated}).rows[0].to_dict()


def test_what_a_result_has_not_is_said():
    found = gumption.audit(TOP / "docs" / "examples" / "claimed-budget.csv")
    with pytest.raises(ValueError, match="and nothing else"):
        found.table()
    with pytest.raises(AttributeError, match="there is no statement; there are format"):
        _ = found.statement
    with pytest.raises(KeyError, match="there are none"):
        _ = found["u"]
    with pytest.raises(TypeError, match="a sheet is its path"):
        gumption.audit({"source": ["a"]})


def test_an_audit_of_a_sheet():
    claimed = TOP / "docs/examples/claimed-budget.csv"
    found, again = gumption.audit(claimed), gumption.audit(claimed.read_bytes(), name=str(claimed))
    assert found.rows[0].to_dict() == again.rows[0].to_dict()
    with pytest.raises(gumption.NoResult, match="no table"):
        gumption.audit("a,b\n1,2\n")


def test_published_examples_hold():
    found = gumption.verify(TOP / "budgets/inertial/mimu-gyro-scale-factor.toml")
    assert found.rows[0].to_dict()["examples"]


def test_a_path_may_have_a_sign_of_equality(tmp_path, monkeypatch):
    (tmp_path / "year=2026").mkdir()
    (tmp_path / "year=2026/resistor.toml").write_text(RESISTOR)
    (tmp_path / "year=2026/resistor").write_text(RESISTOR)
    monkeypatch.chdir(tmp_path)
    for path in ("year=2026/resistor.toml", "year=2026/resistor"):
        assert gumption.evaluate(path, monte_carlo=False)["I"].unit == "mA"
    with pytest.raises(gumption.Refused, match="there is no file year=2025"):
        gumption.evaluate("year=2025/resistor.toml")
    with pytest.raises(gumption.Refused, match="has no key `year`"):
        gumption.evaluate("year=2026")
    with pytest.raises(ValueError, match="no path, being too long") as told:
        gumption.evaluate("x" * 100_000)
    assert len(str(told.value)) < 200


def test_what_is_given_otherwise_than_it_should_be_is_told():
    budget, results = {"measurand": {"y": {"model": "x"}}, "input": {"x": {"value": 1, "u": 0.1}}}, {"R": [1.0, 2.0], "u(R)": [0.1, 0.1]}
    gyro = "recording = { file = 'o.csv', average = 'none' }\nequations = 'U = K*w + b'\n"
    for wrong, told in (
        (lambda: gumption.evaluate(budget, files=["a"]), "files: names with what they hold"),
        (lambda: gumption.evaluate(budget, files={"a.csv": 1}), "files: what a.csv holds"),
        (lambda: gumption.fleet(results, by=None), "by: a text or a list of texts"),
        (lambda: gumption.batch(budget, {"x": [1.0]}, keep=None), "keep: a text or a list of texts"),
        (lambda: gumption.diagnose(gyro, why=[1]), "why: a text or a list of texts"),
        (lambda: gumption.calibrate(gyro, recordings="w,U\n1,2\n"), "a text has a name"),
        (lambda: gumption.calibrate(gyro, progress=print), "progress: of use with recordings only"),
    ):
        with pytest.raises((TypeError, ValueError), match=told):
            wrong()
    assert "it is empty" in gumption.calibrate(gyro, recordings={"e": ""})["error"][0]


def test_a_figure_is_found_by_its_symbol():
    with pytest.raises(AttributeError, match="there are y, u, nu, k, U, interval, p, name, unit, "):
        _ = gumption.evaluate(RESISTOR, monte_carlo=False)["I"].uncertainty


def test_files_may_be_named_by_their_paths(tmp_path):
    (tmp_path / "r.csv").write_text("U\n1.0\n1.1\n1.2\n")
    mean = '[measurand.U]\nmodel = "V"\n[input]\nV = { readings = { file = "readings.csv", column = "U" } }\n'
    assert gumption.evaluate(mean, files={"readings.csv": tmp_path / "r.csv"}, monte_carlo=False)["U"].y == 1.1
