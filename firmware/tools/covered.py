#!/usr/bin/env python3
"""covered.py PROOF CRATE...: every public function of the crates is called in the proof that nothing panics.
covered.py --test: what it sees and what it misses, on a source made for it.

The source is read as the compiler expands it (`-Zunpretty=expanded`), so that functions made by macros are there, too. What has
to be in the proof:
  pub fn of a type           Type::name
  method of a public trait   Trait::name, S::name of a number type
  pub fn                     name(
  impl of a foreign trait    <Type as Trait>::name; for Display shown::<Type>
Not looked at: what is derived, whose parts are looked at themselves; Debug; conversions from and to floating point."""
import os
import pathlib
import re
import subprocess
import sys

HOST_ONLY = {"from_f64", "from_f32", "to_f64", "to_f32", "to_radians", "from_radians"}
# What the proof calls types and traits.
NAMES = {"Scalar": "Scalar|S", "Angle": "Angle|S::Angle", "Wide": "Wide|S::Wide", "Unit": "Unit|S::Unit", "Q": "Number|S",
         "Micro": "S", "Radians": "S::Angle", "Turns": "Turns|S::Angle", "Product": "Product|S::Wide", "Sine": "Sine|S::Unit"}
FLOATS = {"f32", "f64"}


def generics_end(text):
    """Where the list of generics that the text begins with ends."""
    depth = 0
    for place, sign in enumerate(text):
        depth += {"<": 1, ">": -1}.get(sign, 0) if text[place - 1:place + 1] != "->" else 0
        if depth == 0:
            return place + 1 if sign == ">" else 0
    return 0


def last_name(path):
    """A type or trait without its path and generics."""
    path = path.strip().lstrip("&'_ ").removeprefix("a ").removeprefix("mut ")
    return re.match(r"[\w:]+", path)[0].split("::")[-1] if re.match(r"[\w:]+", path) else ""


class Block:
    def __init__(self, indent, kind, name="", of=""):
        self.indent, self.kind, self.name, self.of = indent, kind, name, of


def block_of(head, derived):
    """The block that a line begins, with the lines of its head joined."""
    indent = len(head) - len(head.lstrip())
    text = head.strip().removeprefix("unsafe ")
    if text.startswith("macro_rules!") or "mod tests" in text:
        return Block(indent, "passed over")
    if m := re.match(r"pub (?:unsafe )?trait (\w+)", text):
        return Block(indent, "trait", m[1])
    if re.match(r"(pub\([\w: ]+\) )?trait ", text):
        return Block(indent, "passed over")
    if re.match(r"impl\b", text):
        rest = text[4:]
        rest = re.split(r"\bwhere\b", rest[generics_end(rest):] if rest.startswith("<") else rest)[0]
        of, _, name = rest.rpartition(" for ")
        return Block(indent, "passed over" if derived else "impl", last_name(name.rstrip(" {}")), of.strip())
    return None


def traits(text):
    return set(re.findall(r"^ *(?:pub(?:\([\w: ]+\))? )?(?:unsafe )?trait (\w+)", text, re.M))


def functions(text, own):
    """Type or trait, foreign trait and name of the functions that users can call; `own` are the traits of all crates."""
    public = set(re.findall(r"^ *pub (?:struct|enum|type|union) (\w+)", text, re.M))
    blocks, derived, head = [], False, ""
    for line in text.splitlines():
        indent = len(line) - len(line.lstrip())
        if blocks and indent <= blocks[-1].indent and line.strip().startswith("}"):
            blocks.pop()
            continue
        if any(block.kind == "passed over" for block in blocks):
            continue
        if line.strip().startswith("#["):
            derived |= "automatically_derived" in line
            continue
        # A head goes on until its block begins.
        begins = re.match(r" *(unsafe )?(impl\b|macro_rules!|mod tests|(pub(\([\w: ]+\))? )?(unsafe )?trait )", line)
        if head or begins:
            head = head + " " + line.strip() if head else line
            if "{" in line or line.rstrip().endswith(";"):
                block = block_of(head, derived)
                if block and not re.search(r"\{ *\}$", head.strip()) and "{" in line:
                    blocks.append(block)
                head, derived = "", False
            continue
        block = blocks[-1] if blocks else None
        m = re.match(r" *(pub )?(?:const )?(?:unsafe )?(?:extern \"C\" )?fn (\w+)", line)
        if not m:
            continue
        # Functions inside functions are those of nobody else.
        if block and indent != block.indent + 4:
            continue
        derived = False
        if block is None:
            if m[1]:
                yield "", "", m[2]
        elif block.kind == "trait":
            yield block.name, "", m[2]
        elif not block.of:
            if m[1]:
                yield block.name, "", m[2]
        elif last_name(block.of) not in own | {"Debug", "Format", "Serialize"} and block.name in public:
            if not FLOATS & set(re.findall(r"\w+", block.of)):
                yield block.name, last_name(block.of), m[2]


def called(proof, scope, foreign, name):
    generics = r"(?:<[^;]*?>)?"
    alias = NAMES.get(scope, scope)
    if foreign == "Display":
        return re.search(r"\bshown::<(?:\w+::)?(?:%s)\b" % alias, proof)
    if foreign:
        return re.search(r"<(?:%s)%s as %s%s>::%s\b" % (alias, generics, foreign, generics, name), proof)
    before = r"\b(?:%s)(?:::<[^;]*?>)?::" % alias if scope else r"(?<!:)\b"
    return re.search(before + name + r"(?:::<[^;]*?>)?\b[(;)]?", proof)


def missing(proof, crates):
    own = set.union(*(traits(text) for _, text in crates))
    for crate, text in crates:
        for scope, foreign, name in functions(text, own):
            if name not in HOST_ONLY and not called(proof, scope, foreign, name):
                yield f"{crate}: " + (f"<{scope} as {foreign}>::{name}" if foreign else f"{scope}::{name}".lstrip(":"))


def expanded(crate):
    features = ["--no-default-features"] + (["--features", "micromath"] if crate.endswith("core") else [])
    command = ["cargo", "rustc", "--locked", "--quiet", "--lib", *features, "--", "-Zunpretty=expanded"]
    # A stable compiler does so only if it is told that it may.
    environment = {**os.environ, "RUSTC_BOOTSTRAP": "1"}
    return subprocess.run(command, check=True, capture_output=True, text=True, env=environment,
                          cwd=crate).stdout


def test():
    source = """
    pub struct Seen<S> { }
    impl<S: Scalar> Seen<S> {
        pub fn listed(&self) { }
        pub const fn unlisted(&self) { }
        fn private(&self) { }
    }
    impl<S: Scalar> core::ops::Index<usize> for Seen<S> {
        type Output = S;
        fn index(&self, place: usize) -> &S { &self.0[place] }
    }
    impl<S: Scalar>
        Iterator for Seen<S>
        where
        S: Copy {
        fn next(&mut self) -> Option<S> { None }
    }
    impl fmt::Display for Seen<f32> {
        fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result { Ok(()) }
    }
    #[automatically_derived]
    impl<S: PartialEq> PartialEq for Seen<S> {
        fn eq(&self, other: &Seen<S>) -> bool { true }
    }
    impl core::error::Error for Seen<f32> { }
    pub(crate) struct Hidden;
    impl Iterator for Hidden {
        fn next(&mut self) -> Option<()> { None }
    }
    macro_rules! made { ($name:ident) => {
        pub fn $name() { }
    } }
    pub trait Open {
        fn asked(&self);
    }
    pub fn made_by_a_macro() { }
    pub fn called() { }
"""
    proof = "Seen::<f32>::listed(x); <Seen<S> as Iterator>::next(x); any(called()); Open::asked(x)"
    seen = list(missing(proof, [("x", source)]))
    expected = ["x: Seen::unlisted", "x: <Seen as Index>::index", "x: <Seen as Display>::fmt", "x: made_by_a_macro"]
    if seen != expected:
        sys.exit(f"covered.py: expected {expected}, seen {seen}")


if sys.argv[1:] == ["--test"]:
    test()
else:
    crates = [(pathlib.Path(crate).name, expanded(crate)) for crate in sys.argv[2:]]
    proof = pathlib.Path(sys.argv[1]).read_text()
    found = [sum(1 for _ in functions(text, set())) for _, text in crates]
    lost = list(missing(proof, crates))
    if lost or min(found) < 20 or sum(found) < 250:
        sys.exit(f"{sum(found)} functions; not in the proof that nothing panics:\n  " + "\n  ".join(lost))
