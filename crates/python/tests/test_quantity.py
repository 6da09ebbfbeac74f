"""Uncertain numbers against closed forms and the package ``uncertainties``."""

import math

import gumption
import numpy as np
import pytest
from gumption import quantity


def test_what_is_common_cancels():
    x = quantity(2.0, 0.1)
    assert (x - x).u == 0 and (x / x).y == 1


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


def test_units():
    voltage, resistance = quantity(1.0, 0.001, "V"), quantity(100.0, 0.1, "ohm")
    current = (voltage / resistance).to("mA")
    assert math.isclose(current.y, 10) and math.isclose(current.u, 10 * math.hypot(1e-3, 1e-3))


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
