"""The package says what the command line says, to the last bit."""

import json
import math
import subprocess
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
    """The command, as `cargo test` and `cargo build` leave it."""
    found = [TOP / "target" / profile / "gumption" for profile in ("debug", "release")]
    for path in found:
        if path.exists():
            return path
    pytest.skip("the command is not built (cargo build)")


@pytest.mark.parametrize("path", BUDGETS, ids=lambda path: path.stem)
def test_same_bits_as_the_command(program, path):
    command = [program, "eval", path, "--json", "--full", "--trials", "20000"]
    run = subprocess.run(command, capture_output=True, text=True, cwd=TOP)
    expected = json.loads(run.stdout)
    result = gumption.evaluate(path, trials=20_000)
    expected = expected if isinstance(expected, list) else [expected]
    assert [row.to_dict() for row in result] == expected


def test_figures_by_their_symbols():
    current = gumption.evaluate(RESISTOR)["I"]
    assert current.unit == "mA"
    assert math.isclose(current.y, 1.0001 / 100.02 * 1e3, rel_tol=1e-15)
    # Closed form: relative uncertainties of a quotient in quadrature, the half-width divided by the root of 3.
    u = current.y * math.hypot(0.0003 / 1.0001, 0.01 / math.sqrt(3) / 100.02)
    assert math.isclose(current.u, u, rel_tol=1e-12)
    assert math.isclose(current.U, current.k * current.u, rel_tol=1e-15)
    assert current.interval == (current.y - current.U, current.y + current.U)
    assert current.gum.effective_degrees_of_freedom == math.inf


def test_a_dict_is_a_budget():
    budget = {
        "title": "Current",
        "measurand": {"I": {"model": "V / R", "unit": "mA"}},
        "input": {
            "V": {"value": 1.0001, "unit": "V", "u": 0.0003},
            "R": {"value": 100.02, "unit": "ohm", "half_width": 0.01},
        },
    }
    assert gumption.evaluate(budget)["I"].u == gumption.evaluate(RESISTOR)["I"].u


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


def test_faults_are_typed():
    with pytest.raises(gumption.Refused) as refused:
        gumption.evaluate(RESISTOR.replace("half_width", "half_widht"))
    fault = next(fault for fault in refused.value.faults if "half_widht" in fault.message + fault.expected)
    assert fault.line == 8 and fault.mend and "half_width" in str(refused.value)
    with pytest.raises(gumption.NoResult):
        gumption.evaluate(RESISTOR.replace("V / R", "ln(-V / 1 'V') * 1 'mA' + 0 * V / R"))


def test_a_missing_file_is_refused():
    with pytest.raises(gumption.Refused):
        gumption.evaluate("no-such-budget.toml")


def test_reports_in_both_languages(tmp_path):
    result = gumption.evaluate(RESISTOR)
    assert "Uncertainty budget" in result.text() and "不确定度" in result.text("zh")
    assert result._repr_html_().startswith("<iframe")
    result.save(tmp_path / "current.html")
    assert "<html" in (tmp_path / "current.html").read_text()
    with pytest.raises(FileExistsError):
        result.save(tmp_path / "current.html")


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
    assert math.isclose(again.measurand("K").y, slope, rel_tol=1e-9)


def test_a_diagnosis_finds_the_square_and_tells_its_progress():
    lines = []
    for k in range(40):
        x = (k % 20) / 10 - 1
        lines.append(f"{x},{1 + 2 * x + 0.02 * x * x + 1e-3 * ((7 * k) % 11 - 5) / 3}")
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
    assert found.rows[0].to_dict()["adopted"]
    assert shares and all(0 <= share <= 1 for share in shares)

    class Enough(Exception):
        pass

    def stop(_):
        raise Enough

    with pytest.raises(Enough):
        gumption.diagnose(experiment, files=files, progress=stop)


def test_an_audit_of_a_sheet():
    sheet = "source,u,unit,divisor\nreference,0.1,mV,1\nresolution,0.05,mV,1.732\nuc,,0.1041,\n"
    found = gumption.audit(sheet)
    assert found.rows[0].to_dict()


def test_published_examples_hold():
    found = gumption.verify(TOP / "budgets/inertial/mimu-gyro-scale-factor.toml")
    assert found.rows[0].to_dict()["examples"]
