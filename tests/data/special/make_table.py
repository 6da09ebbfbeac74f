"""Writes the reference tables of this folder: special functions to 50 digits.

    pip install mpmath && python make_table.py

Every line is `name,argument,...,value`; the arguments are exact double precision numbers.
The functions are computed from their series (mpmath's own) for moderate parameters and by
quadrature of the density for large ones; quantiles by a bracketed root search on the logarithm of
the smaller tail, whose arithmetic has nothing in common with the program's.

The points go where implementations are known to fail: t with p just beside 1/2, with p = 1e-10 at
one degree of freedom, with p = 1e-300 and with 1e5 degrees of freedom; chi-squared with one degree
of freedom and p = 1e-5, and with p = 1 - 1e-10; erf from 0.5 to 2.5.
"""

import pathlib

from mpmath import mp, mpf

mp.dps = 50
HERE = pathlib.Path(__file__).parent
DOFS = [0.1, 0.5, 1.0, 2.0, 3.7, 10.0, 30.0, 137.25, 1000.0, 1e5, 1e7, 1e10, 1e15]
SMALL_P = [1e-300, 1e-100, 1e-20, 1e-10, 1e-5, 0.001, 0.025, 0.1, 0.25, 0.4]


def tail_by_quadrature(log_density, start, width, direction):
    """Integral of exp(log_density) from start outwards; width = scale of the fall.

    Divided by its value at the start while it is computed: mp.quad works to an absolute error.
    """
    total = mpf(0)
    left = mpf(start)
    top = log_density(left)
    while True:
        right = left + direction * width
        piece = abs(mp.quad(lambda t: mp.exp(log_density(t) - top), [left, right]))
        total += piece
        if piece < total * mpf(10) ** -40:
            return total * mp.exp(top)
        left = right


def t_sf(t, dof):
    t, dof = mpf(t), mpf(dof)
    if t < 0:
        return 1 - t_sf(-t, dof)
    if dof <= 200:
        return mp.betainc(dof / 2, mpf(1) / 2, 0, dof / (dof + t * t), regularized=True) / 2
    log_k = mp.loggamma((dof + 1) / 2) - mp.loggamma(dof / 2) - mp.log(dof * mp.pi) / 2

    def log_density(u):
        return log_k - (dof + 1) / 2 * mp.log1p(u * u / dof)

    return tail_by_quadrature(log_density, t, 4 / (1 + t), 1)


def t_two_sided(t, dof):
    t, dof = mpf(t), mpf(dof)
    if dof <= 200:
        x = t * t / (dof + t * t)
        return mp.betainc(mpf(1) / 2, dof / 2, 0, x, regularized=True)
    if t < 2:
        return 2 * t * mp.quad(lambda u: t_pdf(u * t, dof), [0, 1])
    return 1 - 2 * t_sf(t, dof)


def t_pdf(t, dof):
    t, dof = mpf(t), mpf(dof)
    log_k = mp.loggamma((dof + 1) / 2) - mp.loggamma(dof / 2) - mp.log(dof * mp.pi) / 2
    return mp.exp(log_k - (dof + 1) / 2 * mp.log1p(t * t / dof))


def gamma_tail(a, x, upper):
    a, x = mpf(a), mpf(x)
    if a <= 200:
        limits = (x, mp.inf) if upper else (0, x)
        return mp.gammainc(a, *limits, regularized=True)
    if (x < a) == upper:
        return 1 - gamma_tail(a, x, not upper)
    log_gamma = mp.loggamma(a)

    def log_density(y):
        return a * y - mp.exp(y) - log_gamma

    width = 4 / (abs(x - a) + mp.sqrt(x))
    return tail_by_quadrature(log_density, mp.log(x), width, 1 if upper else -1)


def beta_tail_odds(a, b, odds, upper):
    a, b, odds = mpf(a), mpf(b), mpf(odds)
    if upper:
        return beta_tail_odds(b, a, 1 / odds, False)
    x = odds / (1 + odds)
    if max(a, b) <= 200:
        return mp.betainc(a, b, 0, x, regularized=True)
    if x > a / (a + b):
        return 1 - beta_tail_odds(b, a, 1 / odds, False)
    log_b = mp.loggamma(a) + mp.loggamma(b) - mp.loggamma(a + b)

    def log_density(y):
        return a * y - (a + b) * mp.log1p(mp.exp(y)) - log_b

    width = 4 / (abs(a - (a + b) * x) + mp.sqrt((a + b) * x * (1 - x)))
    return tail_by_quadrature(log_density, mp.log(odds), width, -1)


def root(log_function, target, low, high):
    """y between low and high where the increasing log_function is log(target)."""
    goal = mp.log(mpf(target))
    low, high = mpf(low), mpf(high)
    with mp.workdps(25):
        for _ in range(40):
            middle = (low + high) / 2
            if log_function(middle) < goal:
                low = middle
            else:
                high = middle
    first = (low + high) / 2
    second = first + (high - low) / 2
    with mp.workdps(40):
        return mp.findroot(
            lambda y: log_function(y) - goal, (first, second), solver="secant", tol=mpf(10) ** -50, maxsteps=60
        )


def t_upper_quantile(q, dof):
    """t > 0 with t_sf(t) = q < 1/2."""
    if q > 0.4:
        # From the middle, with the central probability.
        inside = 1 - 2 * mpf(q)
        return t_central_quantile(inside, dof)
    top = mp.asinh(mpf(10) ** (min(600, 310 / dof + 3)))
    low, high = mpf(0), top
    if dof > 30:
        high = mpf(40) if dof >= 1000 else mpf(10) ** 15
        return -root(lambda y: mp.log(t_sf(-y, dof)), q, -high if dof >= 1000 else -mpf(10) ** 4, 0)
    return mp.sinh(-root(lambda y: mp.log(t_sf(mp.sinh(-y), dof)), q, -high, -low))


def t_central_quantile(p, dof):
    high = mpf(1) if dof >= 0.5 else mpf(40)
    y = root(lambda y: mp.log(t_two_sided(mp.exp(y), dof)), p, -80, mp.log(high))
    return mp.exp(y)


def gamma_quantile(a, p, upper):
    centre, spread = mp.log(mpf(a)), 1 / mp.sqrt(mpf(a))
    if upper:
        high = mp.log(a + 60 * mp.sqrt(mpf(a)) + 1000)
        low = centre - 60 * spread if a > 1 else mpf(-200)
        return mp.exp(-root(lambda y: mp.log(gamma_tail(a, mp.exp(-y), True)), p, -high, -low))
    low = -760 / mpf(a) if a < 200 else centre - 60 * spread
    high = mp.log(a + 40 * mp.sqrt(mpf(a)) + 10)
    return mp.exp(root(lambda y: mp.log(gamma_tail(a, mp.exp(y), False)), p, low, high))


def beta_quantile_odds(a, b, p, upper):
    if upper:
        return 1 / beta_quantile_odds(b, a, p, False)
    a, b = mpf(a), mpf(b)
    centre = mp.log(a / b)
    spread = mp.sqrt(1 / a + 1 / b)
    low = centre - (45 * spread if min(a, b) > 200 else 760 / a + 5 * spread)
    high = centre + 6 * spread + 3
    return mp.exp(root(lambda y: mp.log(beta_tail_odds(a, b, mp.exp(y), False)), p, low, high))


def write(name, rows):
    with open(HERE / f"{name}.csv", "w", newline="\n") as file:
        for function, arguments, value in rows:
            if value == 0 or abs(mp.log10(abs(value))) > 300:
                continue
            fields = [repr(float(x)) for x in arguments] + [mp.nstr(value, 25)]
            file.write(",".join([function] + fields) + "\n")
    print(name, len(rows))


def normal():
    rows = []
    for x in [-3.0, -0.5, 1e-300, 1e-10, 0.1, 0.5, 0.84, 1.0, 1.3, 2.0, 2.5, 3.0, 5.0, 5.9]:
        rows.append(("erf", [x], mp.erf(x)))
    for x in [-5.0, -1.0, 1e-10, 0.1, 0.5, 0.9, 1.3, 2.0, 2.5, 5.0, 6.1, 10.0, 20.0, 26.0]:
        rows.append(("erfc", [x], mp.erfc(x)))
    for x in [-37.3, -8.1, -1.0, -0.1, 1e-12, 0.5, 1.0, 1.96, 3.3, 7.7, 12.3, 25.1, 36.9]:
        rows.append(("normal_pdf", [x], mp.npdf(mpf(x))))
        rows.append(("normal_sf", [x], mp.erfc(mpf(x) / mp.sqrt(2)) / 2))
    for p in SMALL_P + [0.075, 0.49, 0.4999999, 0.5000001, 0.6, 0.9, 0.975, 0.99865, 1 - 1e-10, 1 - 2**-53]:
        q = mpf(p) if p < 0.5 else 1 - mpf(p)
        guess = mp.sqrt(2) * abs(mp.erfinv(1 - 2 * q)) if q > 1e-8 else mp.sqrt(-2 * mp.log(q)) - 0.5
        x = mp.findroot(lambda x: mp.log(mp.erfc(x / mp.sqrt(2)) / 2) - mp.log(q), guess)
        rows.append(("normal_quantile", [p], -x if p < 0.5 else x))
    for p in [1e-200, 1e-12, 0.001, 0.3, 0.6827, 0.85, 0.8500001, 0.9, 0.95, 0.9545, 0.99, 0.9973, 1 - 2**-52]:
        rows.append(("normal_two_sided_quantile", [p], mp.sqrt(2) * mp.erfinv(mpf(p))))
    write("normal", rows)


def student_t():
    rows = []
    for dof in DOFS:
        for t in [1e-9, 0.001, 0.1, 0.7, 1.0, 2.0, 5.0, 12.0, 30.0, 1e3, 1e8, 1e60]:
            if dof >= 1000 and t > 35:
                continue
            rows.append(("student_t_sf", [t, dof], t_sf(t, dof)))
            rows.append(("student_t_pdf", [t, dof], t_pdf(t, dof)))
            if t < 100:
                rows.append(("student_t_two_sided", [t, dof], t_two_sided(t, dof)))
        for p in SMALL_P + [0.46, 0.4999999, 0.5000001, 0.55, 0.975, 1 - 1e-10, 1 - 2**-53]:
            q = mpf(p) if p < 0.5 else 1 - mpf(p)
            t = t_upper_quantile(q, dof)
            rows.append(("student_t_quantile", [p, dof], -t if p < 0.5 else t))
        for p in [1e-30, 1e-6, 0.05, 0.0999, 0.1001]:
            rows.append(("student_t_two_sided_quantile", [p, dof], t_central_quantile(mpf(p), dof)))
        for p in [0.6827, 0.9, 0.95, 0.9545, 0.99, 0.9973]:
            t = t_upper_quantile((1 - mpf(p)) / 2, dof)
            rows.append(("student_t_two_sided_quantile", [p, dof], t))
    write("student_t", rows)


def gamma():
    rows = []
    for x in [1e-10, 0.05, 0.5, 0.9, 1.1, 2.5, 7.3, 15.0, 60.5, 170.5]:
        rows.append(("gamma", [x], mp.gamma(x)))
    for x in [1e-10, 0.05, 0.5, 2.5, 7.3, 60.5, 1e5, 1e15]:
        rows.append(("ln_gamma", [x], mp.loggamma(x)))
    for a in [0.05, 0.5, 1.0, 2.5, 9.9, 10.1, 47.0, 150.0, 1e3, 1e6, 1e12]:
        for factor in [1e-100, 1e-6, 0.01, 0.3, 0.8, 1.0, 1.3, 3.0, 20.0, 600.0]:
            if a >= 1e3:
                factor = 1 + (factor**0.1 - 0.9) / a**0.5 * 8
            x = float(a * factor)
            rows.append(("gamma_p", [a, x], gamma_tail(a, x, False)))
            rows.append(("gamma_q", [a, x], gamma_tail(a, x, True)))
        for p in SMALL_P + [0.5]:
            rows.append(("gamma_p_inverse", [a, p], gamma_quantile(a, p, False)))
            rows.append(("gamma_q_inverse", [a, p], gamma_quantile(a, p, True)))
    write("gamma", rows)


def chi_squared():
    rows = []
    for dof in [0.1, 1.0, 2.0, 5.5, 30.0, 1e3, 1e7]:
        for x in [1e-8, 0.1, 1.0, 3.84, 20.0, 200.0]:
            x = x if dof < 100 else dof + (x**0.2 - 1.3) * 6 * dof**0.5
            rows.append(("chi_squared_cdf", [x, dof], gamma_tail(dof / 2, mpf(x) / 2, False)))
            rows.append(("chi_squared_sf", [x, dof], gamma_tail(dof / 2, mpf(x) / 2, True)))
        for p in SMALL_P + [0.5, 0.9, 0.975, 1 - 1e-10]:
            x = gamma_quantile(dof / 2, p, False) if p <= 0.5 else gamma_quantile(dof / 2, 1 - mpf(p), True)
            rows.append(("chi_squared_quantile", [p, dof], 2 * x))
        for q in SMALL_P:
            rows.append(("chi_squared_upper_quantile", [q, dof], 2 * gamma_quantile(dof / 2, q, True)))
    write("chi_squared", rows)


SHAPES = [
    (0.05, 0.05), (0.05, 3.0), (0.5, 0.5), (0.5, 15.0), (1.0, 1.0), (2.0, 3.0), (4.5, 0.7), (30.0, 12.0),
    (150.0, 180.0), (0.5, 1e4), (1e3, 2.5), (1e5, 0.5), (1e5, 3e5), (1e9, 1e7), (3.0, 1e12),
]


def beta():
    rows = []
    for a, b in SHAPES:
        rows.append(("ln_beta", [a, b], mp.loggamma(a) + mp.loggamma(b) - mp.loggamma(mpf(a) + mpf(b))))
        mean = mpf(a) / (a + b)
        sd = mp.sqrt(mean * (1 - mean) / (mpf(a) + b + 1))
        points = [mean + z * sd for z in (-6, -2, -0.5, 0, 0.4, 1.7, 5, 20)]
        points += [mean / 1000, 1 - (1 - mean) / 1000]
        for x in sorted({float(x) for x in points if 0 < x < 1}):
            # 1 - x must be exact in double precision too, or the comparison is unfair.
            if mpf(1 - x) + mpf(x) != 1:
                x = 1 - (1 - x)
            odds = mpf(x) / (1 - mpf(x))
            if odds <= 0:
                continue
            rows.append(("beta_lower", [a, b, x], beta_tail_odds(a, b, odds, False)))
            rows.append(("beta_upper", [a, b, x], beta_tail_odds(a, b, odds, True)))
        for p in [1e-300, 1e-20, 1e-5, 0.025, 0.3, 0.5]:
            odds = beta_quantile_odds(a, b, p, False)
            rows.append(("beta_inverse", [a, b, p], odds / (1 + odds)))
        for p in [0.6, 0.975, 1 - 1e-10]:
            odds = beta_quantile_odds(a, b, 1 - mpf(p), True)
            rows.append(("beta_inverse", [a, b, p], odds / (1 + odds)))
    write("beta", rows)


def f():
    rows = []
    for n, d in [(0.1, 0.1), (1.0, 1.0), (1.0, 7.0), (4.0, 20.0), (9.5, 2.3), (100.0, 3.0), (50.0, 1e6), (1e5, 1e5)]:
        for x in [1e-6, 0.1, 0.9, 1.0, 1.1, 3.0, 40.0]:
            x = x if n + d < 1e5 else 1 + (x**0.2 - 1) / n**0.5 * 5
            odds = mpf(x) * mpf(n) / mpf(d)
            rows.append(("f_cdf", [x, n, d], beta_tail_odds(n / 2, d / 2, odds, False)))
            rows.append(("f_sf", [x, n, d], beta_tail_odds(n / 2, d / 2, odds, True)))
        for p in [1e-20, 1e-5, 0.025, 0.3, 0.5, 0.9, 0.95, 0.99]:
            if p <= 0.5:
                odds = beta_quantile_odds(n / 2, d / 2, p, False)
            else:
                odds = beta_quantile_odds(n / 2, d / 2, 1 - mpf(p), True)
            rows.append(("f_quantile", [p, n, d], odds * mpf(d) / mpf(n)))
        for q in [1e-20, 1e-5, 0.05]:
            odds = beta_quantile_odds(n / 2, d / 2, q, True)
            rows.append(("f_upper_quantile", [q, n, d], odds * mpf(d) / mpf(n)))
    write("f", rows)


if __name__ == "__main__":
    import sys

    for make in [normal, gamma, chi_squared, beta, f, student_t]:
        if len(sys.argv) == 1 or make.__name__ in sys.argv[1:]:
            make()
