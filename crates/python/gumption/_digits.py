"""How figures are shown: an estimate has the digits that its uncertainty leaves it."""

from __future__ import annotations

import math


def figure(x: float, count: int) -> str:
    """So many significant digits, zeros among them."""
    return f"{x:#.{count}g}".replace(".e", "e").rstrip(".") if math.isfinite(x) else str(x)


def estimate(y: float, u: float | None) -> str:
    """To the place of the third digit of ``u``."""
    if not u or not y or not math.isfinite(y) or not math.isfinite(u):
        return f"{y:.10g}"
    digits = 3 + math.floor(math.log10(abs(y))) - math.floor(math.log10(u))
    return figure(y, min(max(digits, 1), 17))
