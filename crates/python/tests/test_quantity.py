"""Uncertain numbers against closed forms and the package ``uncertainties``."""

import copy
import math
import pickle
import subprocess
import sys
from decimal import Decimal

import gumption
import numpy as np
import pytest
from gumption import correlated, covariance, quantity


def test_what_is_common_cancels():
    x = quantity(2.0, 0.1)
    assert (x - x).u == 0 and (x / x).y == 1
    for at in range(1, 60):
        x = quantity(at / 7, 0.01)
        for formula, wanted in ((x / x, 1.0), (x / (x + x), 0.5), (np.sin(x) / np.sin(x), 1.0)):
            gum = gumption.evaluate(formula.budget(), monte_carlo=False)["y"].gum
            assert (gum.estimate, gum.standard_uncertainty) == (wanted, 0.0), formula.budget()


def test_digits_that_are_shown():
    x = quantity(1.5, 0.1)
    assert repr(x) == "<1.500, u = 0.100>" and f"{x:.1f}" == "<1.5, u = 0.1>" and f"{x}" == repr(x)
    assert repr(quantity(123456.0, 1000.0, "Hz")) == "<1.2346e+05 Hz, u = 1.00e+03>"
    # Where Monte Carlo gives the estimate, its noise is not shown.
    assert repr(x * quantity(2.0, 0.2)).startswith("<3.000, u = 0.361>")
    assert repr(x - x) == "<0, u = 0>"


def test_copies_are_the_same_quantity():
    x = quantity(1.5, 0.1)
    assert (copy.deepcopy(x) - x).u == 0 and copy.copy(x) is x
    assert pickle.loads(pickle.dumps(x)) is x
    a, b = correlated([1.0, 2.0], u=[0.1, 0.2], correlation=[[1, -0.5], [-0.5, 1]])
    assert [(one - x).u for one in pickle.loads(pickle.dumps([x, a + b]))] == [0, (a + b - x).u]


def test_quantities_go_to_other_processes_and_come_back():
    x, made = quantity(1.5, 0.1), "import pickle, sys\nfrom gumption import *\n"
    script = made + (
        "x = pickle.loads(bytes.fromhex(sys.argv[1]))\n"
        "a, b = correlated([1.0, 2.0], u=[0.1, 0.2], correlation=[[1, -0.5], [-0.5, 1]])\n"
        "print(pickle.dumps([x * 2, quantity(3.0, 0.2), a, b]).hex())"
    )
    said = subprocess.run([sys.executable, "-c", script, pickle.dumps(x).hex()], capture_output=True, check=True)
    double, other, a, b = pickle.loads(bytes.fromhex(said.stdout.decode()))
    assert (double - 2 * x).u == 0
    # What another process made has no name here that something else has.
    assert math.isclose((other + x).u, math.hypot(0.1, 0.2), rel_tol=1e-9)
    assert math.isclose((a + b).u, math.sqrt(0.03), rel_tol=1e-9)


def test_long_chains_are_handed_over():
    x = chain = quantity(1.0, 0.1)
    for _ in range(3000):
        chain = chain + x
    again, same = pickle.loads(pickle.dumps([chain, x]))
    assert again is chain and same is x
    script = "import pickle, sys\nchain, x = pickle.load(sys.stdin.buffer)\nprint(chain.sensitivities()[x])"
    run = subprocess.run([sys.executable, "-c", script], input=pickle.dumps([chain, x]), capture_output=True, check=True)
    assert run.stdout.split() == [b"3001.0"]


def test_a_value_says_its_unit():
    written = quantity("5 V", 0.01)
    apart = quantity(5, 0.01, "V")
    assert str(written) == str(apart)
    assert (written / quantity("2 A", 0.02)).u == (apart / quantity(2, 0.02, "A")).u


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("45°", "°", 45.0),
        ("45\u00a0°", "°", 45.0),
        ("45°00′36″", "°", 45.01),
        ("5%", "%", 5.0),
        ("5\u202fppm", "ppm", 5.0),
        ("5V", "V", 5.0),
        ("5％", "%", 5.0),
    ],
)
def test_the_unit_of_a_text_is_that_of_a_file(text, unit, value):
    x = quantity(text, 0.1)
    file = {"measurand": {"y": {"model": "a", "unit": unit}}, "input": {"a": {"value": text, "u": 0.1}}}
    there = gumption.evaluate(file, monte_carlo=False)["y"].gum
    assert (x.unit, x.result["y"].gum.estimate, x.u) == (unit, there.estimate, there.standard_uncertainty)
    assert math.isclose(there.estimate, value) and math.isclose(there.standard_uncertainty, 0.1)
    assert math.isclose(quantity(text, certificate={"U": 0.2, "k": 2}).u, 0.1)
    assert math.isclose(correlated([text, text], [0.1, 0.2], np.eye(2))[1].u, 0.2)


def test_what_is_exact_is_looked_at_alone():
    exact = quantity(5, unit="V") * 2
    assert (exact.y, exact.u, exact.unit, str(quantity(5))) == (10.0, 0.0, "V", "<5, u = 0>")
    assert quantity(20, unit="°C").to("K").y == 293.15 and exact.to_gtc().x == 10.0


def test_every_name_may_be_given():
    y, q1 = quantity(1.0, 0.1, name="y"), quantity(2.0, 0.1, name="q1")
    assert quantity(1, half_width=0.1, name="y").y == 1 and quantity(readings=[1, 2], name="y").y == 1.5
    assert (y + q1 * quantity(3.0, 0.1)).result["y1"].gum.estimate == 7.0 and (y - y).u == 0
    assert np.allclose(covariance([y, quantity(1.0, 0.2, name="y1")]), np.diag([0.01, 0.04]))


def test_differences_of_temperatures():
    t, s = quantity(20.0, 0.3, unit="°C"), quantity(25.0, 0.4, unit="degC")
    assert ((s - t).y, (s - t).unit, repr(s - t)) == (5.0, "K", "<5.000 K, u = 0.500>")
    assert (quantity(2.0, 0.1, unit="K") + t).unit == "°C" and (t - quantity(2.0, 0.1, unit="K")).unit == "°C"
    assert ((t + (s - t) / 2).y, (t.to("K") * 2).y, (t - t).u) == (22.5, 586.3, 0.0)
    assert (quantity(70.0, 0.1, unit="°F") - quantity(60.0, 0.1, unit="°F")).to("K").y == pytest.approx(50 / 9)
    for wrong in (lambda: t * 2, lambda: t / s, lambda: -t, lambda: np.exp(t), lambda: t**2):
        with pytest.raises(ValueError, match=r"x\.to\('K'\)"):
            wrong()
    for wrong in (lambda: t + s, lambda: np.mean(np.array([t, s]))):
        with pytest.raises(ValueError, match=r"mean is a \+ \(b - a\)/2"):
            wrong()
    with pytest.raises(ValueError, match="quantity.20, unit='K'"):
        t - 20
    with pytest.raises(gumption.Refused, match="In Python"):
        (quantity(1.0, 0.1, unit="V") + 1).y


def test_what_is_no_quantity():
    light, time = quantity(299792458, unit="m/s"), quantity(1e-9, 1e-12, "s")
    assert math.isclose((light * time).u, 299792458e-12) and math.isclose((light * time).to("m").y, 0.299792458)


def test_what_is_wrong_is_told_where_it_is_written():
    for value, u in ((math.nan, 0.1), (1.0, math.inf), (1.0, -0.1)):
        with pytest.raises(ValueError):
            quantity(value, u)
    with pytest.raises(gumption.Refused, match="not a known unit"):
        quantity(1.0, 0.1, "Vv")
    with pytest.raises(gumption.Refused, match="not a known unit"):
        quantity(1.0, 0.1, "V").to("Vv")
    for wrong in ({"doff": 3}, {"distribution": "unifrom"}, {"half_width": 0.1}):
        with pytest.raises(gumption.Refused):
            quantity(1.0, 0.1, **wrong)
    with pytest.raises(gumption.Refused, match="write \"1000 V\""):
        quantity("1 000 V", 1.0)
    for text in ("1.0+/-0.1", "1.0"):
        with pytest.raises(gumption.Refused, match="value"):
            quantity(text)
    with pytest.raises(TypeError, match="cannot stand in a file"):
        quantity(quantity(1.0, 0.1))
    with pytest.raises(ValueError, match="cannot be the name"):
        quantity(1.0, 0.1, name=3)
    for several in ({"values": [1, 2, 3], "u": 0.1}, {"readings": [[1.0, 1.1], [5.0, 5.1]]}):
        with pytest.raises(TypeError, match="a quantity is one"):
            quantity(**several)
    with pytest.raises(ValueError, match=r"x - quantity\(273.15, unit='K'\)"):
        quantity(300.0, 0.1, unit="K").to("°C")
    with pytest.raises(gumption.Refused, match="not symmetric"):
        correlated([1, 2], [0.1, 0.1], [[1, 0.9], [0.5, 1]])
    for short in ({"names": ["a"]}, {"unit": ["V"]}):
        with pytest.raises(ValueError, match="as many u, units and names"):
            correlated([1, 2], [0.1, 0.1], np.eye(2), **short)
    with pytest.raises(TypeError, match="1.0 is no quantity"):
        covariance([quantity(1.0, 0.1), 1.0])


def test_names_and_formats_of_other_packages_are_told():
    x = quantity(1.0, 0.1)
    with pytest.raises(AttributeError, match="no nominal_value; it has .*y, unit, u, "):
        _ = x.nominal_value
    for unknown in (".2uL", "u2", ".0u"):
        with pytest.raises(ValueError, match="is no format of a number.*'.2u' or '.2uS'"):
            _ = f"{x:{unknown}}"
    with pytest.raises(TypeError, match="have no order: compare their estimates, a.y < b.y"):
        _ = x < quantity(2.0, 0.1)
    with pytest.raises(TypeError, match="np.modf takes no quantities; those that do are absolute, add"):
        np.modf(x)
    for to_float in (math.sin, float):
        with pytest.raises(TypeError, match="estimate is .y; .*np.sin"):
            to_float(x)
    assert not hasattr(x, "nominal_value") and quantity(readings=[1, 2, 3]).y == 2


@pytest.mark.parametrize(
    ("value", "u", "plain", "brackets"),
    [
        (1.23456, 0.01234, "<1.235, u = 0.012>", "1.235(12)"),
        # 0.0996 is 0.10 to two digits, which moves the last digit of the estimate.
        (1.23456, 0.0996, "<1.23, u = 0.10>", "1.23(10)"),
        (12.345, 1.234, "<12.3, u = 1.2>", "12.3(1.2)"),
        (123456.0, 1234.0, None, "1.235(12)e+05"),
        (1.23456e-9, 2.34e-11, None, "1.235(23)e-09"),
        (0.0, 0.1, None, "0.00(10)"),
    ],
)
def test_digits_of_u(value, u, plain, brackets):
    x = quantity(value, u)
    assert plain is None or f"{x:.2u}" == plain
    assert f"{x:.2uS}" == brackets
    assert f"{quantity(10.0, 0.25, 'V'):.1uS}" == "10.0(2) V"
    uncertainties = pytest.importorskip("uncertainties")
    if "e" not in brackets:
        assert f"{uncertainties.ufloat(value, u):.2uS}" == brackets


def test_more_functions_of_numpy():
    x, z = quantity(0.3, 1e-6), quantity(0.5, 1e-6)
    for function in (np.log1p, np.expm1, np.exp2, np.reciprocal, np.positive):
        slope = (function(0.3 + 1e-6) - function(0.3 - 1e-6)) / 2e-6
        assert math.isclose(function(x).y, function(0.3), rel_tol=1e-9), function
        assert math.isclose(function(x).u, abs(slope) * 1e-6, rel_tol=1e-6), function
    assert np.fmax(x, z).y == 0.5 and np.fmin(x, z).y == 0.3 and np.fabs(-x).y == 0.3
    assert np.maximum(x, z).y == 0.5 and np.minimum(x, z).y == 0.3 and np.float_power(x, 2).y == (x**2).y
    tiny = quantity(1e-12, 1e-15)
    assert math.isclose(np.expm1(tiny).y, 1e-12, rel_tol=1e-9) and math.isclose(np.log1p(tiny).y, 1e-12, rel_tol=1e-9)
    sample = np.array([quantity(value, 0.1, "V") for value in (1.0, 2.0, 4.0)])
    assert math.isclose(sample.std(ddof=1).y, np.std([1, 2, 4], ddof=1), rel_tol=0.05) and sample.std().unit == "V"


def test_a_root_has_a_simple_fraction():
    assert np.cbrt(quantity(8.0, 0.1, "V")).unit == "V^(1/3)" and (quantity(8.0, 0.1, "V") ** (2 / 3)).unit == "V^(2/3)"


def test_arithmetic_takes_numbers_of_other_packages():
    uncertainties, gtc = pytest.importorskip("uncertainties"), pytest.importorskip("GTC")
    length = uncertainties.ufloat(2.0, 0.1)
    assert (quantity(length) - length).u == 0 and math.isclose((quantity(1.0, 0.1) + length).u, math.hypot(0.1, 0.1))
    angle = gtc.ureal(1.0, 0.1, 9)
    assert (quantity(angle) * angle).nu == pytest.approx(9)
    assert (quantity(1.0, 0.1, "V") * Decimal("0.5")).y == 0.5


def test_readings_are_those_that_were_given():
    readings = [9.99, 10.02, 10.00]
    x, y = quantity(None, readings=readings), quantity(None, readings=iter(tuple(readings)))
    readings.append(99.0)
    assert x.u == y.u == quantity(None, readings=[9.99, 10.02, 10.00]).u


def test_a_long_chain_is_no_tree():
    x = quantity(1.0, 1e-3)
    y = x
    for _ in range(60):
        y = (y + y) / 2
    assert math.isclose(y.u, 1e-3, rel_tol=1e-12)


def test_sum_of_ten_readings():
    readings = [9.99, 10.02, 10.00, 9.98, 10.03]
    mean = quantity(None, readings=readings)
    assert math.isclose(mean.u, np.std(readings, ddof=1) / math.sqrt(5), rel_tol=1e-12)
    assert mean.nu == 4
    # k for 95.45 % of Student's t with 4 degrees of freedom (JCGM 100, table G.2: 2.87), or for 95 % (2.78).
    assert 2.77 < mean.k < 2.88 and math.isclose(mean.U, mean.k * mean.u)


def test_units():
    voltage, resistance = quantity(1.0, 0.001, "V"), quantity(100.0, 0.1, "ohm")
    current = (voltage / resistance).to("mA")
    assert math.isclose(current.y, 10) and math.isclose(current.u, 10 * math.hypot(1e-3, 1e-3))
    assert (voltage / resistance).unit == "V·ohm^-1" and (voltage + voltage).unit == "V"
    assert (np.sqrt(voltage * voltage) / voltage).unit == "1"
    assert math.isclose((voltage**2 / resistance).to("mW").y, 10)
    with pytest.raises(gumption.Refused):
        (voltage + resistance).u  # noqa: B018


@pytest.mark.parametrize("name", ["sqrt", "exp", "log", "sin", "arctan", "tanh", "log10"])
def test_functions_of_numpy(name):
    uncertainties = pytest.importorskip("uncertainties")
    umath = pytest.importorskip("uncertainties.unumpy")
    ours = getattr(np, name)(quantity(0.7, 1e-3))
    theirs = getattr(umath, name)(np.array([uncertainties.ufloat(0.7, 1e-3)]))[0]
    assert math.isclose(ours.y, theirs.nominal_value, rel_tol=1e-12)
    assert math.isclose(ours.u, theirs.std_dev, rel_tol=1e-9)


def test_covariance():
    a, b = quantity(3.0, 0.1), quantity(4.0, 0.2)
    found = gumption.covariance([a + b, a - b])
    assert np.allclose(found, [[0.05, -0.03], [-0.03, 0.05]])


def test_what_is_no_number_is_refused():
    with pytest.raises(TypeError):
        quantity(1.0, 0.1) + "2"
    with pytest.raises(ValueError):
        quantity(1.0, 0.1) * math.nan


def test_stated_correlation():
    # JCGM 100, 5.2.2, example: resistors in series of one reference are fully correlated.
    resistors = correlated([1000.0] * 10, [0.1] * 10, np.ones((10, 10)), "ohm")
    total = sum(resistors[1:], resistors[0])
    assert math.isclose(total.u, 1.0, rel_tol=1e-9) and total.unit == "ohm"
    a, b = correlated([1.0, 2.0], [0.1, 0.2], [[1, -0.5], [-0.5, 1]])
    assert math.isclose((a + b).u, math.sqrt(0.01 + 0.04 - 0.02))
    assert math.isclose((a * 2).u, 0.2)
    with pytest.raises(ValueError, match="matrix"):
        correlated([1.0, 2.0], [0.1, 0.2], [[1]])


def test_the_budget_is_one():
    V, R = quantity(1.0, 0.001, "V", name="V"), quantity(100.0, 0.1, "ohm", name="R")
    budget = (V / R).to("mA").budget()
    assert list(budget["input"]) == ["V", "R"]
    assert gumption.evaluate(budget)["y"].u == (V / R).to("mA").u
    with pytest.raises(ValueError, match="two quantities"):
        (V + quantity(1.0, 0.1, "V", name="V")).u  # noqa: B018
    with pytest.raises(ValueError, match="name"):
        quantity(1.0, 0.1, name="1y")


def test_numbers_of_uncertainties_stay_correlated():
    uncertainties = pytest.importorskip("uncertainties")
    a, b = uncertainties.ufloat(2.0, 0.1), uncertainties.ufloat(3.0, 0.2)
    theirs = a * b
    x, xy = quantity(a), quantity(theirs)
    assert math.isclose(xy.u, theirs.std_dev) and math.isclose(xy.y, 6.0)
    # Taken one by one, and still of one cause.
    assert math.isclose((xy - 3 * x).u, (theirs - 3 * a).std_dev)
    back = (xy - 3 * x).to_uncertainties()
    assert math.isclose((back - 2 * b).std_dev, 0, abs_tol=1e-12)
    assert (quantity(1.0) * x).u == x.u


def test_quantities_become_numbers_of_uncertainties():
    uncertainties = pytest.importorskip("uncertainties")
    x, y = correlated([1.0, 2.0], [0.1, 0.2], [[1, 0.8], [0.8, 1]])
    z = quantity(5.0, 0.3)
    ours = [x * z, y - x, np.sin(z)]
    theirs = uncertainties.covariance_matrix([one.to_uncertainties() for one in ours])
    assert np.allclose(theirs, gumption.covariance(ours), rtol=1e-9, atol=1e-15)


def test_arrays_of_quantities():
    x = np.array([quantity(float(at), 1e-6) for at in range(1, 4)])
    assert [one.y for one in np.sqrt(x * 4)] == pytest.approx([2, math.sqrt(8), math.sqrt(12)])
    assert math.isclose(x.sum().u, 1e-6 * math.sqrt(3))
    for function in (np.hypot, np.arctan2):
        assert [one.y for one in function(x, x[0])] == [one.y for one in function(x, np.array([x[0]] * 3))]
        assert math.isclose(function(x, 1.0)[1].y, function(2.0, 1.0))
    assert [one.y for one in np.floor(x + 0.5)] == [1, 2, 3] and [one.y for one in np.ceil(x - 0.5)] == [1, 2, 3]
    assert (x[1] * np.array(2.0)).y == 4 and (np.array(x[1], dtype=object) * x[0]).y == 2 and np.polyval(x, 2.0).y == 11


@pytest.mark.parametrize(
    "array",
    [
        np.array([1, 2j]),
        np.array([None, 2.0], dtype=object),
        np.array(["a", "b"]),
        np.array(["2026-01-01"], dtype="datetime64[D]"),
    ],
)
def test_arrays_of_no_numbers_are_refused(array):
    x = quantity(1.5, 0.1)
    for wrong in (lambda: x * array, lambda: array - x):
        with pytest.raises(TypeError, match="stands in no formula of quantities"):
            wrong()


def test_numbers_of_gtc_keep_degrees_of_freedom_and_correlation():
    gtc = pytest.importorskip("GTC")
    a, b = gtc.ureal(2.0, 0.1, 4, label="a"), gtc.ureal(3.0, 0.2)
    theirs = a * b + a
    ours = quantity(theirs)
    gum = ours.result["y"].gum
    assert math.isclose(gum.estimate, theirs.x) and math.isclose(gum.standard_uncertainty, theirs.u)
    assert math.isclose(ours.nu, theirs.df)
    # Taken one by one, and still of one cause.
    rest = (ours - 4 * quantity(a)).result["y"].gum
    assert math.isclose(rest.standard_uncertainty, (theirs - 4 * a).u)
    back = ours.to_gtc() - theirs
    assert math.isclose(back.u, 0, abs_tol=1e-12) and math.isclose(back.x, 0, abs_tol=1e-12)
    x, y = (gtc.ureal(1.0, 0.1, independent=False) for _ in range(2))
    gtc.set_correlation(0.5, x, y)
    assert math.isclose((quantity(x) + quantity(y)).u, (x + y).u)
    with pytest.raises(TypeError, match="real"):
        quantity(gtc.ucomplex(1 + 1j, 0.1))


def test_numbers_of_other_packages_take_a_unit_and_nothing_else():
    uncertainties, gtc = pytest.importorskip("uncertainties"), pytest.importorskip("GTC")
    for number in (uncertainties.ufloat(5.0, 0.1), gtc.ureal(5.0, 0.1, 7)):
        x = quantity(number, unit="mV")
        assert (x.y, x.u, x.unit) == (5.0, 0.1, "mV") and math.isclose((x / quantity(1, unit="mV") - number).u, 0, abs_tol=1e-15)
        assert repr(quantity(number, unit="°C").to("K")) == "<278.150 K, u = 0.100>"
        for wrong in ({"u": 0.3}, {"dof": 3}, {"name": "a"}, {"foo": 1, "unit": "V"}):
            with pytest.raises(TypeError, match="beside it stands unit alone"):
                quantity(number, **wrong)
        with pytest.raises(gumption.Refused, match="not a known unit"):
            quantity(number, unit="nonsense")


def test_numbers_of_which_u_is_missing_are_refused():
    uncertainties = pytest.importorskip("uncertainties")
    unknown, known = uncertainties.ufloat(5.0, math.nan), uncertainties.ufloat(1.0, 0.1)
    for wrong in (lambda: quantity(unknown), lambda: quantity(unknown + known), lambda: quantity(1.0, 0.1) + unknown):
        with pytest.raises(ValueError, match="std_dev of 5.0 is nan"):
            wrong()


def test_a_formula_that_was_handed_over_comes_back_to_first_order():
    pytest.importorskip("uncertainties")
    pytest.importorskip("GTC")
    x = quantity(1.5, 0.1)
    square = x * x
    for there in (square.to_uncertainties(), square.to_gtc()):
        rest = (quantity(there) - square).result["y"]
        assert rest.gum.standard_uncertainty == 0 and rest.u > 0


def test_quantities_become_numbers_of_gtc():
    pytest.importorskip("GTC")
    x, y = correlated([1.0, 2.0], [0.1, 0.2], [[1, 0.8], [0.8, 1]])
    z = quantity(5.0, 0.3, dof=6)
    for ours in (x * z, y - x, np.sin(z)):
        theirs, gum = ours.to_gtc(), ours.result["y"].gum
        assert math.isclose(theirs.x, gum.estimate)
        assert math.isclose(theirs.u, gum.standard_uncertainty, rel_tol=1e-9)
    assert math.isclose((2 * z).to_gtc().df, 6)


def test_a_sum_begins_with_nothing():
    total = sum([quantity(1.0, 0.1, "V"), quantity(2.0, 0.1, "V")])
    assert math.isclose(total.u, 0.1 * math.sqrt(2)) and total.unit == "V"


@pytest.mark.parametrize("package", ["uncertainties", "GTC"])
@pytest.mark.parametrize("unit", [None, "V", "°C"])
def test_what_was_handed_over_comes_back(package, unit):
    pytest.importorskip(package)

    def there(one):
        return one.to_uncertainties() if package == "uncertainties" else one.to_gtc()

    def assert_same(one, other):
        assert math.isclose((one - other).u or 0.0, 0, abs_tol=1e-15 * other.u)

    for x in (quantity(2.0, 0.1, unit), quantity(2.0, 0.1, unit, dof=5), quantity(unit=unit, readings=[1.0, 2.0, 4.0])):
        assert_same(quantity(there(x)), quantity(there(x)))
        if unit is None:
            assert quantity(there(x)).nu == x.nu and math.isclose((x - there(x)).u, 0, abs_tol=1e-15)
            assert math.isclose((x + there(x)).u, 2 * x.u) and math.isclose((there(x) + x).u, 2 * x.u)
        # Through what rests on it.
        product = there(x) * 3
        assert_same(quantity(product), 3 * quantity(there(x)))
    if unit == "V":
        assert math.isclose((x / quantity(1, unit="V") - there(x)).u, 0, abs_tol=1e-15)


@pytest.mark.parametrize("r", [0.5, -0.9, 1.0])
def test_correlated_quantities_come_back(r):
    pytest.importorskip("uncertainties")
    pytest.importorskip("GTC")
    a, b = correlated([1.0, 2.0], u=[0.1, 0.2], correlation=[[1, r], [r, 1]])
    for back in (lambda one: one.to_uncertainties(), lambda one: one.to_gtc()):
        assert math.isclose((a - back(a)).u, 0, abs_tol=1e-15)
        assert math.isclose((a + back(b)).u, (a + b).u) and math.isclose((back(a) * 2 + b).u, (2 * a + b).u)


def test_a_number_that_was_changed_is_refused():
    uncertainties = pytest.importorskip("uncertainties")
    number = uncertainties.ufloat(1.0, 0.1)
    assert quantity(number).u == 0.1
    number.std_dev = 0.2
    with pytest.raises(ValueError, match="was 0.1 when it became a quantity"):
        quantity(number)


def test_what_is_masked_is_no_number():
    x, masked = quantity(2.0, 0.1), np.ma.array([1.0, 99.0], mask=[0, 1])
    # Arithmetic of masked arrays keeps the mask.
    assert (masked * x).mask.tolist() == (x * masked).mask.tolist() == [False, True]
    for wrong in (
        lambda: np.multiply(x, masked),
        lambda: correlated([1.0, 2.0], u=[0.1, 0.2], correlation=np.ma.array(np.eye(2), mask=np.eye(2) == 0)),
        lambda: correlated(masked, u=[0.1, 0.2], correlation=np.eye(2)),
        lambda: quantity(masked[1], 0.1),
    ):
        with pytest.raises(TypeError, match="masked"):
            wrong()


def test_numbers_that_python_has_no_type_for():
    long = np.longdouble("1.5")
    assert quantity(long, np.longdouble(0.1)).y == 1.5 and quantity(readings=np.array([1, 2, 3], np.longdouble)).y == 2
    assert f"{quantity(1.234, 0.0123):S}" == "1.234(12)"
