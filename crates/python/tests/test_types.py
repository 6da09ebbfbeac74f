"""The package and what is written with it hold before a strict checker of types."""

from pathlib import Path

import pytest

USED = """
import gumption
import numpy as np
from gumption import quantity

result = gumption.evaluate({"measurand": {"y": {"model": "x"}}, "input": {"x": {"value": 1, "u": 0.1}}}, seed=7)
figures: dict[str, np.ndarray] = result.samples(1000)
page: str = result.to_html("both")
certificate: bytes = result.to_dcc("laboratory.toml", language="zh")
x = quantity(1.0, 0.1, "V") * 2 + quantity(2.0, unit="V", half_width=0.1)
u: float | None = x.u
value: float = x.to("mV").y
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
a, b = gumption.correlated(np.array([1.0, 2.0]), u=np.array([0.1, 0.2]), correlation=np.eye(2))
total = a * Decimal("1.5") + Decimal("2") * b - Fraction(1, 3) * a + Fraction(1, 2)
table = gumption.calibrate("gyro.toml", recordings=["one.csv", "two.csv"])
errors: list[str] = table["error"]
scaled = a * np.int64(2) + b ** np.int64(2) + np.float32(1) * a + quantity(1, u=Decimal("0.1"))
gumption.evaluate("budget.toml", seed=np.int64(3), trials=1e5, threads=np.int32(1))
gumption.evaluate("budget.toml", files={"readings.csv": Path("readings.csv")})
try:
    gumption.diagnose("case.toml", why=["thermal lag", "drift"], progress=print)
except gumption.Refused as refused:
    mends: list[str | None] = [fault.mend for fault in refused.faults]
"""


def test_types(tmp_path):
    api = pytest.importorskip("mypy.api")
    script = tmp_path / "used.py"
    script.write_text(USED)
    package = Path(__file__).parents[1] / "gumption"
    said, complained, code = api.run(["--strict", "--cache-dir", str(tmp_path / "cache"), str(package), str(script)])
    assert code == 0, said + complained
