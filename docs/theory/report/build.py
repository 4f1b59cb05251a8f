#!/usr/bin/env python3
"""build.py PDF: the documents of docs/theory as one report that can be cited, the same bit for bit for the same commit.

Needs the packages `pypandoc_binary` and `typst` of PyPI: pandoc reads Markdown and its formulas, typst sets them (report.typ). Whatever one
of the two cannot read, or warns of, is an error, and so is a link of one document to another that leads nowhere.
"""
import json
import re
import subprocess
import sys
import tempfile
from datetime import datetime, timezone
from pathlib import Path

import pypandoc
import typst

HERE = Path(__file__).resolve().parent
THEORY = HERE.parent
TOP = THEORY.parents[1]
#: The chapters, in the order in which they can be read.
CHAPTERS = ["equations", "outlines", "curves", "errors", "errors-fixed", "certificates", "precedence", "joint", "queries"]
#: Widths of columns: parts of the page, no less than this.
NARROWEST = 0.08
#: A bar before and after something: pandoc keeps neither apart. A sign that stands for it, and what Typst has.
BARS = {"lvert": ("\ue000", 'class("opening", bar.v)'), "rvert": ("\ue001", 'class("closing", bar.v)')}
#: What begins a line in a report, as it does in the source.
STARTS = {"Code:", "Wrong:", "Correct:", "Test:", "Tests:"}


def pandoc(text, *options):
    run = subprocess.run([pypandoc.get_pandoc_path(), "--fail-if-warnings", *options], input=text, capture_output=True, text=True)
    if run.returncode or run.stderr:
        sys.exit(f"pandoc: {run.stderr}")
    return run.stdout


def text_of(inlines):
    """The plain text of some inlines, to measure or to compare it."""
    found = []
    for inline in inlines:
        kind, content = inline["t"], inline.get("c")
        if kind == "Str":
            found.append(content)
        elif kind in ("Space", "SoftBreak", "LineBreak"):
            found.append(" ")
        elif kind in ("Code", "Math"):
            # Commands of a formula are about as wide as one sign.
            found.append(re.sub(r"\\[a-zA-Z]+ ?|[{}^_]", lambda m: "x" if m[0][0] == "\\" else "", content[1]) if kind == "Math" else content[1])
        elif kind in ("Emph", "Strong", "Strikeout", "Superscript", "Subscript", "SmallCaps", "Underline"):
            found.append(text_of(content))
        elif kind in ("Link", "Span", "Quoted"):
            found.append(text_of(content[1]))
    return "".join(found)


def formula(tex):
    """A formula as pandoc's writer sets it well: bars as delimiters, brackets as large as what they hold, and no negative spaces."""
    tex = re.sub(r"\\[bB]ig+l(?![a-z])", r"\\left", re.sub(r"\\[bB]ig+r(?![a-z])", r"\\right", tex)).replace(r"\!", "")
    parts = re.split(r"(?<!\\)(?<!\\left)(?<!\\right)\|", tex)
    if len(parts) % 2 == 0:
        sys.exit(f"bars that are no pairs: {tex}")
    bars = [r"\lvert ", r"\rvert "]
    tex = parts[0] + "".join(bars[place % 2] + part for place, part in enumerate(parts[1:]))
    for name, (sign, _) in BARS.items():
        tex = re.sub(rf"\\{name}(?![a-z])", rf"\\text{{{sign}}}", tex)
    return tex


def slug(text):
    """The anchor that GitHub gives a heading."""
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")


def label(chapter, anchor):
    return f"{chapter}:{anchor}" if anchor else chapter


class Chapter:
    """A document: its headings one level lower where it has several of the first level, anchors and links with its name before them."""

    def __init__(self, name, number_of, blocks):
        self.name, self.number_of = name, number_of
        self.labels, self.links = set(), set()
        firsts = [block for block in blocks if block["t"] == "Header" and block["c"][0] == 1]
        self.deeper = len(firsts) > 1
        self.title = None
        self.waiting = []
        self.blocks = self.all(blocks)
        if self.waiting:
            sys.exit(f"{name}: nothing comes after the anchor {self.waiting}")

    def all(self, blocks):
        found = []
        for block in blocks:
            kind, content = block["t"], block.get("c")
            if kind == "HorizontalRule":
                continue
            if kind == "RawBlock":
                self.anchor(content[1])
                continue
            if kind in ("Para", "Plain"):
                content = self.inlines(content)
                block = {"t": kind, "c": content}
                if not content:
                    continue
            elif kind == "Header":
                block = self.heading(content)
            elif kind == "Table":
                block = {"t": kind, "c": self.table(content)}
            else:
                block = {"t": kind, "c": self.below(content)} if content is not None else block
            if self.waiting:
                # Before what they name, as labels of nothing: a heading has one of its own.
                found.append({"t": "Para", "c": [self.mark(anchor) for anchor in self.waiting]})
                self.waiting = []
            found.append(block)
        return found

    def below(self, content):
        """The blocks in a list or a quotation."""
        if isinstance(content, list):
            if content and all(isinstance(each, dict) and "t" in each for each in content):
                return self.all(content) if content[0]["t"] in ("Para", "Plain", "BulletList", "OrderedList", "Header", "Table") else content
            return [self.below(each) for each in content]
        return content

    def anchor(self, html):
        found = re.findall(r'<a id="([^"]+)">', html)
        if not found and html.strip() not in ("</a>", "") and not html.startswith("<!--"):
            sys.exit(f"{self.name}: HTML that is no anchor: {html}")
        for anchor in found:
            self.labels.add(anchor)
            self.waiting.append(anchor)

    @staticmethod
    def raw(text):
        return {"t": "RawInline", "c": ["typst", text]}

    def mark(self, anchor):
        return self.raw(f"#place-mark(\"{label(self.name, anchor)}\")")

    def inlines(self, inlines):
        found = []
        for inline in inlines:
            kind, content = inline["t"], inline.get("c")
            if kind == "RawInline":
                before = len(self.waiting)
                self.anchor(content[1])
                if found and len(self.waiting) > before:
                    found += [self.mark(anchor) for anchor in self.waiting[before:]]
                    del self.waiting[before:]
                continue
            if kind == "SoftBreak" and not found:
                continue
            if kind == "Strong" and found and found[-1]["t"] == "SoftBreak" and text_of(content) in STARTS:
                found[-1] = {"t": "LineBreak"}
            if kind == "Link":
                found += self.link(content)
            elif kind in ("Emph", "Strong", "Superscript", "Subscript"):
                found.append({"t": kind, "c": self.inlines(content)})
            elif kind == "Math":
                found.append({"t": kind, "c": [content[0], formula(content[1])]})
            elif kind == "Image":
                sys.exit(f"{self.name}: pictures are not foreseen")
            else:
                found.append(inline)
        return found

    def link(self, content):
        _, inlines, (target, _) = content
        inlines = self.inlines(inlines)
        if re.match(r"[a-z]+:", target):
            return [{"t": "Link", "c": content}]
        name, _, anchor = target.partition("#")
        document = Path(name).stem if name else self.name
        if document in self.number_of and name in ("", f"{document}.md"):
            self.links.add((document, anchor))
            if text_of(inlines) == name:
                inlines = [{"t": "Str", "c": f"chapter\u00a0{self.number_of[document]}"}]
            return [self.raw(f"#link(label(\"{label(document, anchor)}\"))["), *inlines, self.raw("]")]
        # A file of the repository: named, not linked, because a report is read without it.
        if not (THEORY / name).exists():
            sys.exit(f"{self.name}: no file {name}")
        path = (THEORY / name).resolve().relative_to(TOP)
        if str(path.with_suffix("")).endswith(text_of(inlines).removesuffix(path.suffix)):
            return [{"t": "Code", "c": [["", [], []], str(path)]}]
        return [*inlines, {"t": "Space"}, {"t": "Str", "c": "("}, {"t": "Code", "c": [["", [], []], str(path)]}, {"t": "Str", "c": ")"}]

    def heading(self, content):
        level, _, inlines = content
        own = slug(text_of(inlines))
        inlines = self.inlines(inlines)
        first = self.title is None
        if first:
            self.title = text_of(inlines)
        elif self.deeper or level == 1:
            level += 1
        self.labels.add(own)
        self.waiting = [anchor for anchor in self.waiting if anchor != own]
        return {"t": "Header", "c": [level, [label(self.name, "" if first else own), [], []], inlines]}

    def table(self, content):
        """With widths of columns by what is in them, and cells as in any text."""
        attributes, caption, columns, head, bodies, foot = content
        rows = [*head[1], *(row for body in bodies for row in [*body[2], *body[3]])]
        longest, longest_word = [1] * len(columns), [1] * len(columns)
        for row in rows:
            for place, cell in enumerate(row[1]):
                text = " ".join(text_of(block["c"]) for block in cell[4])
                longest[place] = max(longest[place], len(text))
                longest_word[place] = max([longest_word[place], *(len(word) for word in text.split())])
                cell[4] = [{"t": block["t"], "c": self.inlines(block["c"])} for block in cell[4]]
        if sum(longest) <= 90:
            columns = [[column[0], {"t": "ColWidthDefault"}] for column in columns]
        else:
            # Long texts take more lines, but not as many more as they are longer.
            parts = [max(min(word, 26), length ** 0.62 * 1.6) for word, length in zip(longest_word, longest)]
            parts = [max(NARROWEST, part / sum(parts)) for part in parts]
            columns = [[column[0], {"t": "ColWidth", "c": part / sum(parts)}] for column, part in zip(columns, parts)]
        columns = [[{"t": "AlignLeft"} if align["t"] == "AlignDefault" else align, width] for align, width in columns]
        return [attributes, caption, columns, head, bodies, foot]


def main():
    out = Path(sys.argv[1])
    number_of = {name: number for number, name in enumerate(CHAPTERS, 1)}
    missing = {path.stem for path in THEORY.glob("*.md")} ^ set(CHAPTERS)
    if missing:
        sys.exit(f"not the chapters of the report: {', '.join(sorted(missing))}")
    chapters, ast = [], None
    for name in CHAPTERS:
        ast = json.loads(pandoc((THEORY / f"{name}.md").read_text(), "-f", "gfm+tex_math_dollars-gfm_auto_identifiers", "-t", "json"))
        chapters.append(Chapter(name, number_of, ast["blocks"]))
    labels = {(chapter.name, anchor) for chapter in chapters for anchor in [*chapter.labels, ""]}
    for chapter in chapters:
        if lost := sorted(chapter.links - labels):
            sys.exit(f"{chapter.name}: links lead nowhere: {lost}")
    ast["blocks"] = [block for chapter in chapters for block in chapter.blocks]
    body = pandoc(json.dumps(ast), "-f", "json", "-t", "typst")
    # Signs that pandoc has by older names.
    for old, new in (("sect", "inter"), ("minus.circle", "minus.o")):
        body = re.sub(r"\$[^$]*\$", lambda formula: re.sub(rf"(?<![\w.]){old}(?![\w.])", new, formula[0]), body)
    for sign, bar in BARS.values():
        body = body.replace(f'upright("{sign}")', bar)
        if sign in body:
            sys.exit("a bar of a formula is in another place than in the formula")

    version = re.search(r'^\[workspace\.package\][^\[]*^version = "([^"]+)"', (TOP / "Cargo.toml").read_text(), re.M | re.S)[1]
    seconds, revision = subprocess.run(["git", "log", "-1", "--format=%ct %h"], cwd=TOP, check=True, capture_output=True, text=True).stdout.split()
    date = datetime.fromtimestamp(int(seconds), timezone.utc)
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "report.typ"
        values = {"version": version, "revision": revision, "year": date.year, "month": date.month, "day": date.day}
        source.write_text("".join(f"#let {name} = {json.dumps(value)}\n" for name, value in values.items())
                          + (HERE / "report.typ").read_text() + "\n" + body)
        # Its own fonts only: those of a machine would show in the bits.
        pdf, warnings = typst.compile_with_warnings(str(source), ignore_system_fonts=True)
    if warnings:
        sys.exit("typst: " + "\n".join(str(warning) for warning in warnings))
    out.write_bytes(pdf)


main()
