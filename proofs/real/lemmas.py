"""Lemmas over the real numbers: that none has a counterexample is decided by z3, or by exact fractions.

    python3 proofs/real/lemmas.py      proves all of them

Names are those of docs/theory/equations.md: ϱ (rho) and r radii, (x, y) local coordinates, d the distance from the centre, n the
offset, N = r² - n² and F = (ϱ + d)² - r² the products under the roots of the half-width.
"""

import pathlib
import re
import sys
from fractions import Fraction

from z3 import And, Implies, Not, Or, Reals, Solver, unsat

x, y, rho, d, n, r = Reals("x y rho d n r")
ABS = lambda a, b: And(-b <= a, a <= b)  # |a| <= b
ON_ARC = And(rho > 0, d >= 0, d * d == x * x + (rho - y) * (rho - y))


def proved(*claims):
    for claim in claims:
        solver = Solver()
        solver.set("timeout", 60_000)
        solver.add(Not(claim))
        if solver.check() != unsat:
            return False
    return True


def offset_identity():
    """(ϱ - d)(ϱ + d) = 2ϱy - x² - y²"""
    return proved(Implies(ON_ARC, (rho - d) * (rho + d) == 2 * rho * y - x * x - y * y))


def offset_y():
    """|y (2ϱ - y)| <= |y| (ϱ + d)"""
    return proved(Implies(ON_ARC, ABS(2 * rho - y, rho + d)))


def offset_x():
    """x² <= |x| (ϱ + d)"""
    return proved(Implies(ON_ARC, ABS(x, rho + d)))


def half_width():
    """(1 - c) F = (1 + c) N for the cosine c of the half angle, by the law of cosines"""
    c = Reals("c")[0]
    law = r * r == rho * rho + d * d - 2 * rho * d * c
    cosines = And(ON_ARC, n == rho - d, law)
    return proved(Implies(cosines, (1 - c) * ((rho + d) * (rho + d) - r * r) == (1 + c) * (r * r - n * n)))


def residual():
    """A half-width from N', F' is that of a radius r' with (r'² - r²)(N' + F') = N'F - NF', for N + F = N' + F' = 4ϱd"""
    a, b, p, q, square = Reals("a b p q square")
    # tan² = p/q is also (r'² - n²) / ((ϱ + d)² - r'²).
    same = And(a > 0, b > 0, p > 0, q > 0, (square + a - r * r) * q == p * (b + r * r - square))
    return proved(Implies(same, (square - r * r) * (p + q) == p * b - a * q))


def residual_bound():
    """N F / (N + F) <= r²: relative errors of e in N/F change r² by e r² at most"""
    a, b = Reals("a b")
    return proved(Implies(And(a > 0, b > 0, a <= r * r), a * b <= r * r * (a + b)))


def diameter():
    """N (ϱ + d)² <= 4ϱd r²: a relative error of e in the diameter changes r² by 2 e r² at most"""
    near = And(rho > 0, d > 0, r > 0, n == rho - d, ABS(n, r), rho + d > r)
    return proved(Implies(near, (r * r - n * n) * (rho + d) * (rho + d) <= 4 * rho * d * r * r))


def moved():
    """A point that is moved by e changes no distance by more than e"""
    u, v, e, now = Reals("u v e now")
    moved_by = And(d >= 0, now >= 0, e >= 0, d * d == x * x + y * y, u * u + v * v <= e * e,
                   now * now == (x + u) * (x + u) + (y + v) * (y + v))
    return proved(Implies(moved_by, now <= d + e), Implies(moved_by, d <= now + e))


def covers():
    """For |d' - d| <= σ: d <= R gives d' <= R + σ, and that gives d <= R + 2σ"""
    radius, sigma, now = Reals("radius sigma now")
    near = ABS(now - d, sigma)
    return proved(
        Implies(And(near, d <= radius), now <= radius + sigma),
        Implies(And(near, now <= radius + sigma), d <= radius + 2 * sigma),
    )


def turned():
    """(|ac| + |bs|)² + (|bc| + |as|)² <= 2 (a² + b²) for a unit vector (c, s): products of a vector that is turned"""
    a, b, c, s = Reals("a b c s")
    positive = And(a >= 0, b >= 0, c >= 0, s >= 0, c * c + s * s == 1)
    square = (a * c + b * s) * (a * c + b * s) + (b * c + a * s) * (b * c + a * s)
    return proved(Implies(positive, square <= 2 * (a * a + b * b)))


def amplified():
    """Why contact from inside an arc is found from its centre: |d'² - c²| <= 2ϱe gives |d' - c| c <= 2ϱe, and no less"""
    c, e, now = Reals("c e now")
    near = And(rho > 0, c > 0, now > 0, e >= 0, ABS(now * now - c * c, 2 * rho * e))
    return proved(Implies(near, ABS((now - c) * c, 2 * rho * e)))


def common_factor():
    """Errors of terms that are proved one by one add up: |a| <= A and |b| <= B give |a + b| <= A + B"""
    a, b, most, other = Reals("a b most other")
    return proved(Implies(And(ABS(a, most), ABS(b, other)), ABS(a + b, most + other)))


def ramp_slow_end():
    """A way of (v + a e/2) e is at least half of its final speed times e: a relative error of e counts twice at most"""
    v, a, e = Reals("v a e")
    return proved(Implies(And(v >= 0, a >= 0, e >= 0), 2 * (v + a * e / 2) * e >= (v + a * e) * e))


def two_laps():
    """Two laps of less than half a turn, shown by an error of e in their ends: d² - 2ed + 2Rδ <= 0 only for δ <= e²/2R"""
    radius, delta, e = Reals("radius delta e")
    shown = And(radius > 0, e >= 0, d >= 0, d * d - 2 * e * d + 2 * radius * delta <= 0)
    return proved(Implies(shown, 2 * radius * delta <= e * e))


def two_roots():
    """Errors of ±1/2 in the roots p of N and q of F: 2pq(qa - pb) / (p² + q²) of r², with r >= p, are 0.61 of r at most"""
    p, q, a, b = Reals("p q a b")
    half = Fraction(1, 2)
    halves = And(p > 0, q > 0, ABS(a, half), ABS(b, half), r >= p)
    return proved(Implies(halves, ABS(p * q * (q * a - p * b), Fraction(61, 100) * r * (p * p + q * q))))


def through_both_ends():
    """A phase told by both ends: an error e of the speed at its slow end is one of e T/4 of a length at most"""
    whole, t, e = Reals("whole t e")
    inside = And(0 <= t, t <= whole, whole > 0, e >= 0)
    return proved(Implies(inside, e * t * (whole - t) * 4 <= e * whole * whole))


# The polynomials of trig.rs, by fractions: within a step the difference from the series is bounded by its value and slope in
# the middle and its second derivative, in which every term is taken at its largest.


def series(first, terms):
    """Coefficients of z^k of (sin r / r - 1) / z for first = 3, of (cos r - 1 + z / 2) / z² for first = 4"""
    value, found = Fraction(1), []
    for k in range(2, first + 1):
        value /= k
    sign = -1 if first == 3 else 1
    for k in range(terms):
        found.append(sign * value)
        sign, value = -sign, value / ((first + 2 * k + 1) * (first + 2 * k + 2))
    return found


def largest_difference(coefficients, exact, most, weight, steps):
    """Bound of |P(z) - E(z)| weight(z) for z in [0, most]; the series beyond its terms is less than one part in 2^80 of 1."""
    size = max(len(coefficients), len(exact))
    padded = [list(p) + [Fraction(0)] * (size - len(p)) for p in (coefficients, exact)]
    difference = [a - b for a, b in zip(*padded)]
    bend = sum(abs(k * (k - 1) * c) * most ** max(k - 2, 0) for k, c in enumerate(difference))
    half = most / steps / 2
    worst = Fraction(0)
    for step in range(steps):
        z, value, slope = (2 * step + 1) * half, Fraction(0), Fraction(0)
        for c in reversed(difference):
            slope = slope * z + value
            value = value * z + c
        error = abs(value) + abs(slope) * half + bend * half * half / 2 + Fraction(1, 2**80)
        worst = max(worst, error * weight(z + half))
    return worst


def polynomials():
    """Sine and cosine of f64 within 2^-57 of the functions for |r| <= 0.7854"""
    root = pathlib.Path(__file__).resolve().parent.parent
    sys.path.insert(0, str(root))
    from check import near_sine_coefficients

    by_name = {name: Fraction(number) for name, number in near_sine_coefficients().items()}
    most = Fraction(7854, 10000)
    held = True
    # |r|³ <= z most, and r⁴ = z².
    for kind, first, weight in (("s", 3, lambda z: z * most), ("c", 4, lambda z: z * z)):
        polynomial = [by_name[f"{kind}{half}{k}"] for k in range(3) for half in "eo"]
        error = largest_difference(polynomial, series(first, 12), most**2, weight, 1000)
        held &= error <= Fraction(1, 2**57)
    return held


# 60 digits.
PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459")


def quarter_turns():
    """Up to 2^20 quarter turns of f64, in two parts: the first part exact, both right to 2^-60, the second rounded by 2^-67"""
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
    from check import near_sine_numbers

    first, second = (Fraction(number) for number in near_sine_numbers()[:2])
    most = 2**20
    # As many digits as it has, and 20 more, are no more than 53.
    digits = first.numerator.bit_length()
    # |x| < 10^6 has no more quarter turns.
    held = 10**6 / (PI / 2) + 1 < most and digits <= 33
    held &= abs(first + second - PI / 2) * most <= Fraction(1, 2**60)
    return held and abs(second) * most <= Fraction(1, 2**13)


LEMMAS = {
    function.__name__.replace("_", "-"): function
    for function in (
        offset_identity, offset_y, offset_x, half_width, residual, residual_bound, diameter, moved, covers, turned, amplified,
        common_factor, ramp_slow_end, two_laps, two_roots, through_both_ends, polynomials,
        quarter_turns,
    )
}

if __name__ == "__main__":
    missed = [name for name, lemma in LEMMAS.items() if not lemma()]
    for name, lemma in LEMMAS.items():
        print(f"{'NOT PROVED' if name in missed else 'proved':10} {name:18} {lemma.__doc__}")
    sys.exit(1 if missed else 0)
