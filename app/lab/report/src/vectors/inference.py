"""Writes inference.json: reference values for app/lab/report/src/inference.rs.

    python3 -m venv venv && venv/bin/pip install mpmath==1.4.1 scipy==1.17.1 statsmodels==0.15.0
    venv/bin/python app/lab/report/src/vectors/inference.py > app/lab/report/src/vectors/inference.json
"""

import json
import math

import mpmath as mp
import numpy as np
import scipy
import statsmodels
import statsmodels.api as sm
from scipy import optimize, stats
from statsmodels.stats.power import TTestPower
from statsmodels.stats.weightstats import ttost_paired

ALPHA = 0.05
mp.mp.dps = 40

# Hours of sleep gained with two drugs, ten patients: Student, "The Probable Error of a Mean", Biometrika 6 (1908);
# as the data set "sleep" of R, whose manual prints t = -4.0621, df = 9, p = 0.002833, interval -2.4598858 -0.7001142,
# mean of the differences -1.58.
SLEEP = (
    [0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0],
    [1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4],
)


def drawn(seed, n, shift, scale):
    generator = np.random.default_rng(seed)
    base = generator.normal(3.5, 0.8, n)
    return (base + generator.normal(shift, scale, n)).round(3).tolist(), base.round(3).tolist()


def noncentral_t_cdf(t, df, delta):
    """Lenth's series (AS 243) with 40 digits: SciPy's own is NaN for some of these arguments."""
    if t < 0:
        return 1 - noncentral_t_cdf(-t, df, -delta)
    t, df, delta = mp.mpf(t), mp.mpf(df), mp.mpf(delta)
    x, half = t * t / (t * t + df), delta * delta / 2

    def term(j):
        p = mp.exp(-half) * half**j / mp.factorial(j)
        q = delta / mp.sqrt(2) * mp.exp(-half) * half**j / mp.gamma(j + mp.mpf(3) / 2)
        betainc = lambda a: mp.betainc(a, df / 2, 0, x, regularized=True)
        return p * betainc(j + mp.mpf(1) / 2) + q * betainc(j + 1)

    return float(mp.ncdf(-delta) + sum(term(j) for j in range(int(half) + 120)) / 2)


def power(d_z, n, alpha):
    """As statsmodels' TTestPower, which is NaN wherever SciPy's noncentral t is."""
    critical, delta = stats.t.ppf(1 - alpha / 2, n - 1), d_z * math.sqrt(n)
    upper = 1 - noncentral_t_cdf(critical, n - 1, delta)
    value = upper + noncentral_t_cdf(-critical, n - 1, delta)
    theirs = TTestPower().power(d_z, n, alpha)
    assert math.isnan(theirs) or abs(value - theirs) < 1e-9
    return value


def d_z_interval(t, df, n):
    reach = 6 + 1.5 * abs(t)

    def delta(p):
        return optimize.brentq(lambda d: noncentral_t_cdf(t, df, d) - p, t - reach, t + reach, xtol=1e-10)

    return [delta(1 - ALPHA / 2) / math.sqrt(n), delta(ALPHA / 2) / math.sqrt(n)]


def paired(name, a, b, bound):
    a, b = np.array(a), np.array(b)
    d = a - b
    n, df = len(d), len(d) - 1
    test = stats.ttest_rel(a, b)
    interval = test.confidence_interval(1 - ALPHA)
    narrow = test.confidence_interval(1 - 2 * ALPHA)
    d_z = d.mean() / d.std(ddof=1)
    p, lower, upper = ttost_paired(a, b, -bound, bound)
    return {
        "name": name,
        "a": a.tolist(),
        "b": b.tolist(),
        "bound": bound,
        "mean": d.mean(),
        "std": d.std(ddof=1),
        "t": test.statistic,
        "p": test.pvalue,
        "interval": list(interval),
        "d_z": d_z,
        "d_z_interval": d_z_interval(test.statistic, df, n),
        "power": power(abs(d_z), n, ALPHA),
        "tost": {
            "p": p,
            "t_lower": lower[0],
            "p_lower": lower[1],
            "t_upper": upper[0],
            "p_upper": upper[1],
            "interval": list(narrow),
        },
    }


def ratio(name, a, b):
    logs = np.log(np.array(a) / np.array(b))
    test = stats.ttest_1samp(logs, 0)
    interval = test.confidence_interval(1 - ALPHA)
    return {
        "name": name,
        "a": list(a),
        "b": list(b),
        "ratio": math.exp(logs.mean()),
        "interval": [math.exp(interval.low), math.exp(interval.high)],
    }


def blocks(name, groups):
    """A fixed-effects model with a mean for each block: the mean of the blocks' means and its interval."""
    values = np.concatenate([np.array(g, float) for g in groups])
    design = np.zeros((len(values), len(groups)))
    row = 0
    for column, group in enumerate(groups):
        design[row : row + len(group), column] = 1
        row += len(group)
    fit = sm.OLS(values, design).fit()
    contrast = fit.t_test(np.full((1, len(groups)), 1 / len(groups)))
    return {
        "name": name,
        "groups": groups,
        "mean": contrast.effect.item(),
        "interval": contrast.conf_int(ALPHA)[0].tolist(),
        "df": fit.df_resid,
    }


DFS = [1, 2, 3, 5, 9, 13, 29, 119, 1000]
generator = np.random.default_rng(5)
runs = [(367 * generator.normal(1, 0.01, 5)).round(2), (501 * generator.normal(1, 0.01, 5)).round(2)]
document = {
    "source": f"SciPy {scipy.__version__}, statsmodels {statsmodels.__version__}, mpmath {mp.__version__}, by inference.py",
    "t_cdf": [[t, df, stats.t.cdf(t, df)] for df in DFS for t in (-14.4, -2.5, -0.3, 0.0, 0.7, 1.96, 6.0)],
    "t_quantile": [[p, df, stats.t.ppf(p, df)] for df in DFS for p in (1e-4, 0.025, 0.3, 0.5, 0.95, 0.975, 0.9995)],
    "noncentral_t_cdf": [
        [t, df, delta, noncentral_t_cdf(t, df, delta)]
        for df in DFS
        for t in (-12.7, -2.2, 0.0, 0.6, 2.2, 12.7)
        for delta in (-3.0, 0.0, 0.6196, 2.0, 8.0)
    ],
    "power": [
        [d, n, alpha, power(d, n, alpha)]
        for d in (0.0787, 0.1656, 0.5, 1.2)
        for n in (2, 3, 14, 34, 200)
        for alpha in (0.05, 0.01)
    ],
    "sample_size": [
        [d, wanted, math.ceil(TTestPower().solve_power(d, power=wanted, alpha=ALPHA))]
        for d in (0.1656, 0.3, 0.5, 0.8)
        for wanted in (0.8, 0.95)
    ],
    "paired": [
        paired("sleep (Student 1908)", *SLEEP, 0.5),
        paired("14 drawn, no effect", *drawn(1, 14, 0.02, 0.14), 0.5),
        paired("30 drawn, an effect", *drawn(2, 30, 0.3, 0.4), 0.5),
        paired("3 drawn", *drawn(3, 3, -0.2, 0.3), 0.5),
    ],
    "ratio": [
        ratio("five runs", *[r.tolist() for r in runs]),
        ratio("two runs", [35.1, 34.8], [17.6, 17.9]),
    ],
    "blocks": [
        blocks("equal", [[-0.31, -0.30, -0.28], [-0.35, -0.37, -0.36], [-0.20, -0.21, -0.24]]),
        blocks("unequal, one of one", [[0.5, 0.52], [0.7], [0.44, 0.40, 0.43, 0.45]]),
    ],
}
print(json.dumps(document, indent=1, allow_nan=False))
