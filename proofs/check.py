"""Prints every claim of docs/theory/errors*.md and docs/theory/equations.md with how it is held; fails if one is not.

    proofs/check.sh [--quick]      installs what is missing and runs this

A claim is a `[[claim]]` of ledger.toml or a section with an anchor of docs/theory/equations.md. `by` says what holds it:

gappa        scripts of proofs/gappa about kernels as recorded (proofs/recorded; a unit test of pcr-core compares them)
z3           lemmas of proofs/real/lemmas.py, over the real numbers
budget       the sums of the rows' coefficients, against the constants in the sources, both exact; what each row adds is in its bound
code         expressions of the sources that use what is proved: each is there exactly once, comments left out
sum          the figures of an argument by hand add up to no more than it says
exhaustive   every input, by the example `exhaust` (left out by --quick, and then not counted as held)
test         tests that exist and are not ignored; they run in step `tests` of .ci/test.sh
hand         an argument that is written out at the anchor of the claim
"""

import itertools
import pathlib
import re
import subprocess
import sys
import tomllib
from fractions import Fraction

ROOT = pathlib.Path(__file__).resolve().parent.parent
LEDGER = tomllib.loads((ROOT / "proofs/ledger.toml").read_text())
PRECISION = {"f64": 53, "f32": 24}


# Texts that stand for those of files: those of mutants.py.
CHANGED = {}


def text_of(path):
    return CHANGED[path] if path in CHANGED else (ROOT / path).read_text()


def code_of(path):
    """A Rust source without comments, and with one space wherever there is any."""
    tokens = r"""'(?:\\.|[^\\'])'|"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/"""
    text = re.sub(tokens, lambda m: " " if m[0][0] == "/" else m[0], text_of(path), flags=re.S)
    return " ".join(text.split())


def only(found, what):
    """The only one of a list: another one could be the one that counts."""
    found = list(found)
    if len(found) != 1:
        raise ValueError(f"{len(found)} of {what}")
    return found[0]


# Gappa


def dyadic(number):
    number = Fraction(number)
    return f"({number.numerator}b-{number.denominator.bit_length() - 1})"


def near_sine_coefficients():
    """The coefficients of the sine and cosine of f64, as numbers, from the source."""
    # Parts of a quarter turn come first.
    names = "se0 ce0 se1 ce1 se2 ce2 so0 co0 so1 co1 so2 co2".split()
    return dict(zip(names, near_sine_numbers()[2:], strict=True))


def near_sine_numbers():
    """All numbers of the sine and cosine of f64: the two parts of a quarter turn and the coefficients."""
    code = code_of("pcr-core/src/scalar/trig.rs")
    body = only(re.findall(r"near_sin_cos_f64\(f64\),(.*?)even\[0\]", code), "near_sin_cos_f64")
    return [float(n.replace("_", "")) for n in re.findall(r"-?\d[\d_]*\.[\d_]+(?:e-?\d+)?", body)]


def gappa(script, values, precision):
    text = text_of(f"proofs/gappa/{script}.g")
    text = re.sub(r"@recorded (\w+)", lambda m: text_of(f"proofs/recorded/{m[1]}.g"), text)
    text = text.replace("@format", f"float<{precision},-2000,ne>")
    for name, value in sorted(values.items(), key=lambda item: -len(item[0])):
        text = text.replace(f"@{name}", value)
    text = re.sub(r"@u\(([\d.]+)\)", lambda m: f"{float(m[1]) * 2.0 ** -precision:.9e}", text)
    run = subprocess.run(["gappa"], input=text, text=True, capture_output=True)
    return run.returncode == 0 or run.stderr


def by_gappa(claim):
    for values in claim.get("cases", [{}]):
        if claim["script"] == "sine":
            values = values | {name: dyadic(number) for name, number in near_sine_coefficients().items()}
        for name in claim["formats"]:
            held = gappa(claim["script"], values, PRECISION[name])
            if held is not True:
                return f"{name} {values}: {held}"
    return True


# Lemmas


def by_z3(claim):
    sys.path.insert(0, str(ROOT / "proofs/real"))
    import lemmas

    for name in claim["lemmas"]:
        if not lemmas.LEMMAS[name]():
            return f"not proved: {name}"
    return True


# Sums


def constant(path, pattern):
    found = only(re.finditer(pattern, code_of(path)), pattern)
    return Fraction(found[1].replace("_", ""))


def by_code(claim):
    for place in claim["code"]:
        path, expression = place.split(": ", 1)
        only(re.findall(re.escape(expression), code_of(path)), f"`{expression}` in {path}")
    return True


KINDS = ("floating", "micro", "digits", "parts")


def rows(kind):
    return [claim[kind] for claim in LEDGER["claim"] if kind in claim]


def exact(value):
    return Fraction(str(value))


def total(kind, at):
    """The sum of all rows of a kind, for lengths and coordinates `x` of the one that is followed (j) and of the one that is
    covered (i), and radii, as parts of M."""
    parts = {"j": at[0], "i": at[1], "radius": at[2], "one": 1}
    return sum(exact(value) * parts[name] for row in rows(kind) for name, value in row.items())


def is_stated(claim):
    """What a row adds to a budget is what its bound says: a sum of some of its figures, once or for both paths. Where an argument adds
    up to it (`most`), that is among it. What `Micro` adds is more than in its bound, and is held by the sum of all rows alone."""
    figures = [exact(n) for n in re.findall(r"(?<![\w^{.])\d+(?:\.\d+)?", claim["bound"])]
    if "\\sqrt2" in claim["bound"]:
        figures.append(exact("1.415"))
    sums = {sum(some) for size in range(1, len(figures) + 1) for some in itertools.combinations(figures, size)}
    sums |= {2 * some for some in sums}
    added = [exact(value) for kind in KINDS if kind != "micro" for value in claim.get(kind, {}).values()]
    if "most" in claim:
        most = exact(claim["most"])
        if added and most not in added:
            return f"{claim['most']} is derived, {[float(value) for value in added]} are added"
        sums.add(most)
    missing = [float(value) for value in added if value not in sums]
    return not missing or f"{missing} are added, and not in the bound"


# M is a coordinate or length and twice a radius: what is linear in them is largest at these corners.
CORNERS = [(j, i, Fraction(1 - j, 2) + Fraction(1 - i, 2)) for j in (0, 1) for i in (0, 1)]


def by_budget(claim):
    has = constant(claim["source"], claim["constant"])
    if "shift_from" in claim:
        has = Fraction(2) ** (claim["shift_from"] - int(has))
    for name, value in claim.get("adds", {}).items():
        found = sum(exact(row.get(name, 0)) for row in rows(claim["sum"]))
        if found != exact(value):
            return f"the rows add up to {float(found)} of {name}, not to {value}"
    needs = max(total(claim["sum"], corner) for corner in CORNERS)
    needs *= Fraction(str(claim.get("second_order", 1)))
    return needs <= has or f"{float(needs)} are needed, {float(has)} are allowed"


# Runs and tests


def by_sum(claim):
    """Sums, products and quotients of decimals, exact."""
    terms = re.sub(r"\d+(\.\d+)?", lambda number: f"Fraction('{number[0]}')", claim["terms"])
    if not re.fullmatch(r"[\d. +*/()-]+", claim["terms"]):
        return f"not a sum: {claim['terms']}"
    value = eval(terms, {"Fraction": Fraction})
    return value <= Fraction(str(claim["most"])) or f"{float(value)} is more than {claim['most']}"


def by_exhaustive(claim):
    if "--quick" in sys.argv:
        return "left out (--quick)"
    # Optimized as far as it can be, with all checks: half the time.
    fast = [f"--config=profile.checked.package.{crate}.opt-level=3" for crate in ("pcr-core", "pcr-fixed")]
    command = ["cargo", "run", "-q", "--profile", "checked", *fast, "--locked", "-p", "pcr-fixed", "--example", "exhaust", "--"]
    run = subprocess.run(command + claim["runs"], cwd=ROOT, text=True, capture_output=True)
    return run.returncode == 0 or run.stdout + run.stderr


def exists(test):
    """`path/of/file.rs::name`, the name a test or the begin of several, or the name of a macro's tests."""
    path, name = test.split("::")
    pattern = re.escape(name[:-1]) if name.endswith("…") else re.escape(name) + r"\b"
    file = next((ROOT / base / path for base in ("tests/tests", ".") if (ROOT / base / path).is_file()), None)
    if file is None:
        return f"no file {path}"
    text = file.read_text()
    function = re.search(r"((?:#\[[^\n]*\]\s*|///[^\n]*\n\s*)*)fn " + pattern, text)
    if function is None or "#[test]" not in function[1]:
        return f"no test {test}"
    return "ignore" not in function[1] or f"{test} is ignored"


def by_test(claim):
    for test in claim["tests"]:
        held = exists(test)
        if held is not True:
            return held
    return True


def by_hand(claim):
    return f'<a id="{claim["id"]}"></a>' in text_of(claim["file"]) or f"no argument at {claim['file']}#{claim['id']}"


HOLDS = {
    "gappa": by_gappa,
    "z3": by_z3,
    "budget": by_budget,
    "code": by_code,
    "exhaustive": by_exhaustive,
    "test": by_test,
    "hand": by_hand,
    "sum": by_sum,
}


def held(claim):
    """True, or what is missing: every method of the claim, and what it uses."""
    known = {other["id"] for other in LEDGER["claim"]}
    missing = [used for used in claim.get("uses", []) if used not in known]
    if missing:
        return f"uses {missing}, which are no claims"
    methods = claim["by"].split(", ")
    if ("code" in claim) != ("code" in methods):
        return "code is listed, or held by, alone"
    if any(kind in claim for kind in KINDS) and (stated := is_stated(claim)) is not True:
        return stated
    for by in methods:
        try:
            result = HOLDS[by](claim)
        except ValueError as error:
            result = str(error)
        if result is not True:
            return f"{by}: {result}"
    return True


def equations():
    """The sections of docs/theory/equations.md that have an anchor, and the tests and lemmas that they name."""
    parts = re.split(r'\n(?=<a id="[^\n]*\n(?:#|\*\*))', text_of("docs/theory/equations.md"))
    for part in parts[1:]:
        ids = re.findall(r'<a id="([^"]+)"></a>', part.split("\n")[0])
        named, file = [], None
        for path, name in re.findall(r"`(\w+\.rs)?(?:::(\w+…?))?`", part):
            file = path or file
            if name:
                named.append(f"{file}::{name}")
        yield ids[0], named


def main():
    claims, not_held = [], []
    for claim in LEDGER["claim"]:
        claims.append((claim["id"], claim["bound"], claim["by"], held(claim)))
    by_definition = LEDGER["equations"]
    for anchor, tests in equations():
        if tests:
            claims.append((f"equations.md#{anchor}", "", "test", by_test({"tests": tests})))
        else:
            why = by_definition.get(anchor)
            claims.append((f"equations.md#{anchor}", why or "", "hand", bool(why) or "no test and no reason"))
    for name, bound, by, result in claims:
        print(f"{'held' if result is True else 'NOT HELD':8} {by:22} {name:28} {bound}")
        if result is not True:
            print(f"         {str(result).strip()}")
            not_held.append(name)
    ways = {by: sum(by in claim[2].split(", ") for claim in claims) for by in HOLDS}
    print("held by " + ", ".join(f"{by}: {count}" for by, count in ways.items()))
    alone = [claim for claim in claims if set(claim[2].split(", ")) <= {"hand", "sum"}]
    print(f"by hand alone: {len(alone)}")
    print(f"{len(claims)} claims, {len(claims) - len(not_held)} held, missed {len(not_held)}")
    return 1 if not_held else 0


if __name__ == "__main__":
    sys.exit(main())
