"""Changes of the sources and of the ledger, for each of which check.py has to fail: tells if a check of it holds nothing.

    python3 proofs/mutants.py      run by proofs/check.sh, in seconds: nothing is compiled, and no file is changed

A mutant is a file, a text that is there once and what it becomes, and the claims that must then not be held by the methods below.
"""

import sys
import tomllib

import check

# What costs seconds at most; Gappa sees the coefficients that z3 does.
QUICK = {"budget", "code", "hand", "sum", "z3"}

FLOAT, MICRO, FIXED = "pcr-core/src/scalar/float.rs", "pcr-core/src/scalar/micro.rs", "pcr-fixed/src/scalar.rs"
TRIG, SINE, PAIR = "pcr-core/src/scalar/trig.rs", "pcr-fixed/src/sine.rs", "pcr-core/src/pair.rs"
LEDGER = "proofs/ledger.toml"


def row(claim, old, new):
    """A change of the row of one claim of the ledger."""
    text = check.text_of(LEDGER)
    begin = text.index(f'id = "{claim}"')
    end = text.find("[[claim]]", begin)
    own = text[begin:end]
    return LEDGER, own, own.replace(old, new, 1)


MUTANTS = [
    # The slack: too small, and so large that ε is not that of the documents.
    ((FLOAT, "const SLACK: u8 = 64;", "const SLACK: u8 = 40;"), ["e-f64", "e-f32", "e-sum"]),
    ((FLOAT, "const SLACK: u8 = 64;", "const SLACK: u8 = 200;"), ["e-f64", "e-f32"]),
    ((FLOAT, "const SLACK: u8 = 64;", "// const SLACK: u8 = 64;\nconst SLACK: u8 = 8;"), ["e-f64", "e-sum"]),
    ((FLOAT, "const SLACK: u8 = 64;", "/* const SLACK: u8 = 64; */ const SLACK: u8 = 8;"), ["e-f64", "e-sum"]),
    ((FLOAT, "const SLACK: u8 = 64;", "const SLACK: u8 = 64;\nmod other { const SLACK: u8 = 64; }"), ["e-f64", "e-sum"]),
    ((FLOAT, "0.5 * SLACK", "0.05 * SLACK"), ["e-f64", "e-f32"]),
    ((MICRO, "const SLACK: f32 = 70.0", "const SLACK: f32 = 60.0"), ["e-micro", "e-sum-micro"]),
    ((MICRO, "0.5 * Self::SLACK", "0.05 * Self::SLACK"), ["e-micro"]),
    ((FIXED, "const SLACK: i32 = 8;", "const SLACK: i32 = 6;"), ["e-fixed", "q-sum"]),
    ((FIXED, "const SLACK_SHIFT: u32 = 26;", "const SLACK_SHIFT: u32 = 28;"), ["e-fixed", "q-parts"]),
    ((FIXED, "SLACK + (extent.0 >> SLACK_SHIFT)", "SLACK / 2 + (extent.0 >> SLACK_SHIFT)"), ["e-fixed"]),
    ((FIXED, "3 * (arcs + 2)", "3 * arcs"), ["q-drift"]),
    ((PAIR, "first.allowance().max(second.allowance())", "first.allowance().min(second.allowance())"), ["e-promise"]),
    ((PAIR, "self.slack.double()", "self.slack"), ["e-promise"]),
    # Constants beside the budget.
    ((FLOAT, "4.0 * $t::EPSILON * speed", "0.4 * $t::EPSILON * speed"), ["e-phases"]),
    ((FLOAT, "2.0 * $t::EPSILON * of", "0.2 * $t::EPSILON * of"), ["e-times"]),
    ((FIXED, "Self(1 + (of.0 >> 28))", "Self(of.0 >> 28)"), ["e-times"]),
    (("pcr-core/src/motion.rs", "rounding.double() + rounding", "rounding"), ["e-times"]),
    ((FLOAT, "1024.0 * $t::EPSILON", "1.0 * $t::EPSILON"), ["e-sectors"]),
    ((SINE, "FRACTION_BITS - 9", "FRACTION_BITS - 20"), ["e-sectors"]),
    (("pcr-core/src/segment.rs", "- S::Unit::COARSE", ""), ["e-sectors"]),
    (("pcr-core/src/pair/events.rs", "slack.double().double().double().double()", "slack.double()"), ["e-wraps"]),
    (("pcr-core/src/crossing.rs", "slack.double().double()", "slack.double()"), ["e-crossings"]),
    ((FLOAT, "heading: 1_024.0", "heading: 16_777_216.0"), ["e-headings"]),
    # Free values: what a search leaves for rounding, what it takes for clear, and what is a touch.
    (("pcr-core/src/query/start_delay.rs", "pad.max(self.slack()).double().double()", "pad.max(self.slack()).double()"), ["e-delays"]),
    (("pcr-core/src/query/start_delay.rs", "pad.max(self.slack())", "pad"), ["e-delays"]),
    (("pcr-core/src/query/start_delay.rs", "other.latest() + ego.profile().duration()", "ego.profile().duration()"), ["e-delays"]),
    (("pcr-core/src/query/start_delay.rs", "allowance + encounter.pad()", "allowance"), ["e-free"]),
    (("pcr-core/src/query/boundary_search.rs", "if end == clear {", "if true {"), ["e-free"]),
    (("pcr-core/src/query/boundary_search.rs", "if found == Trial::Clear {", "if found != Trial::Elsewhere {"), ["e-free"]),
    (("pcr-core/src/query/time_scaling.rs", "+ leap + noise", "+ leap"), ["e-durations"]),
    (("pcr-core/src/query/clearance.rs", "tolerance().half().half().half();", "tolerance().half();"), ["e-touches"]),
    (("pcr-core/src/query/conflict.rs", "self.tolerance().half(),", "self.tolerance(),"), ["e-touches"]),
    (row("e-delays", "2 + 1 + 0.015625", "2 + 2 + 0.015625"), ["e-delays"]),
    (row("e-touches", "2 * 0.125 + 0.25", "2 * 0.5 + 0.25"), ["e-touches"]),
    # Sine and cosine: a part of a quarter turn, and a coefficient.
    ((TRIG, "1.570_796_326_734_125_6", "1.570_796_326_744_125_6"), ["e-sine"]),
    ((TRIG, "1.570_796_326_734_125_6", "1.570_796_326_734_225_6"), ["e-sine"]),
    ((TRIG, "6.077_100_506_506_192e-11", "6.077_100_506_606_192e-11"), ["e-sine"]),
    ((TRIG, "-1.666_666_666_666_663_2e-1", "-1.666_666_766_666_663_2e-1"), ["e-sine"]),
    # Rows of the ledger that add less than they derive, or than their bound says.
    (row("e-travel", "floating = { j = 19 }", "floating = { j = 1 }"), ["e-travel", "e-sum"]),
    (row("e-travel", "micro = { j = 19 }", "micro = { j = 1 }"), ["e-sum-micro"]),
    (row("e-travel", "most = 19", "most = 190"), ["e-travel"]),
    (row("e-length", "floating = { j = 2, i = 2 }", "floating = { j = 1, i = 2 }"), ["e-length", "e-sum"]),
    (row("e-offset", "radius = 8.28", "radius = 6"), ["e-offset", "e-sum"]),
    (row("q-start", "one = 1.42", "one = 0.42"), ["q-start", "q-sum"]),
    (row("q-travel", "parts = { j = 4 }", "parts = { j = 0.4 }"), ["q-travel", "q-parts"]),
    (row("e-end", "floating = { j = 14 }\n", ""), ["e-sum"]),
]


def not_held(names):
    """Those of the claims that are not held by what is quick, and why."""
    claims = [claim for claim in check.LEDGER["claim"] if claim["id"] in names]
    found = {}
    for claim in claims:
        quick = [by for by in claim["by"].split(", ") if by in QUICK]
        result = check.held(claim | {"by": ", ".join(quick)})
        if result is not True:
            found[claim["id"]] = result
    return found


def main():
    wrong = []
    every = {name for _, names in MUTANTS for name in names}
    if found := not_held(every):
        wrong.append(f"unchanged: not held {found}")
    ledger = check.LEDGER
    for (path, old, new), names in MUTANTS:
        text = check.text_of(path)
        if text.count(old) != 1 or old == new:
            wrong.append(f"{path}: {text.count(old)} of `{old[:60]}`, or no change")
            continue
        check.CHANGED[path] = text.replace(old, new)
        if path == LEDGER:
            check.LEDGER = tomllib.loads(check.CHANGED[path])
        if missing := set(names) - set(not_held(names)):
            wrong.append(f"{path}: `{old[:60]}` -> `{new[:60]}`: {missing} held")
        check.CHANGED.clear()
        check.LEDGER = ledger
    print(*wrong, sep="\n", end="\n" if wrong else "")
    print(f"{len(MUTANTS)} mutants, {len(wrong)} of them not told")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
