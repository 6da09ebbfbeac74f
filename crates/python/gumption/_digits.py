"""How figures are shown: an estimate has the digits that its uncertainty leaves it."""

from __future__ import annotations

import math


def figure(x: float, count: int) -> str:
    """So many significant digits, zeros among them."""
    return f"{x:#.{count}g}".replace(".e", "e").rstrip(".") if math.isfinite(x) else str(x)


def estimate(y: float, u: float | None, count: int = 3) -> str:
    """To the place of the last of so many digits of ``u``."""
    if not u or not y or not math.isfinite(y) or not math.isfinite(u):
        return f"{y:.10g}"
    digits = count + math.floor(math.log10(abs(y))) - math.floor(math.log10(u))
    return figure(y, min(max(digits, 1), 17))


def rounded(u: float, count: int) -> float:
    """To so many significant digits."""
    return float(f"{u:.{count - 1}e}")


def short(y: float, u: float, count: int) -> str:
    """``1.2345(67)``: the digits in brackets are those of u, in units of the last digits of y (GUM 7.2.2)."""
    u = rounded(u, count)
    size = math.floor(math.log10(max(abs(y), u)))
    last = math.floor(math.log10(u)) - count + 1
    # Zeros that no digit of u stands behind would look like known ones.
    shift = size if last > 0 or size < -4 else 0
    places = shift - last
    # The decimal point stands in the brackets where u has digits on either side of it.
    own = u / 10.0**shift
    inside = f"{own:.{places}f}" if own >= 1 and places > 0 else f"{round(u / 10.0**last)}"
    exponent = f"e{shift:+03d}" if shift else ""
    return f"{y / 10.0**shift:.{places}f}({inside}){exponent}"
