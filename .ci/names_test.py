#!/usr/bin/env python3
"""Tests of names.py: what counts as a definition, what is shared, and where the limit is."""
import pathlib, tempfile, unittest

import names


class Names(unittest.TestCase):
    def places(self, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            return {name: [place.removeprefix(folder + "/") for place in where] for name, where in names.places([root]).items()}

    def test_all_kinds_of_types_are_definitions(self):
        text = "pub struct A;\npub(crate) enum B {}\nunsafe trait C {}\npub(in crate::x) union D { a: u8 }\ntype E = u8;\nmod m {\n    struct F<T>(T);\n}\n"
        self.assertEqual(self.places({"a.rs": text}), {name: [f"a.rs:{line}"] for name, line in zip("ABCDEF", (1, 2, 3, 4, 5, 7))})

    def test_uses_and_types_of_traits_are_none(self):
        text = "use x::{Y, Z};\n// struct A;\nimpl Iterator for Y {\n    type Item = Z;\n}\nfn structure(enumeration: Y) {}\n"
        self.assertEqual(self.places({"a.rs": text}), {})

    def test_tests_and_examples_are_left_out(self):
        text = "struct A;\n#[cfg(test)]\nmod tests {\n    struct B;\n}\nstruct C;\n"
        files = {"a.rs": text, "a/tests.rs": "struct A;\n", "tests/b.rs": "struct A;\n", "examples/c.rs": "struct C;\n"}
        self.assertEqual(self.places(files), {"A": ["a.rs:1"], "C": ["a.rs:6"]})

    def test_shared_names_are_listed_with_their_places_the_most_frequent_first(self):
        files = {"a.rs": "struct A;\nstruct B;\n", "b.rs": "enum A {}\nstruct B;\n", "c.rs": "struct B;\nstruct C;\n"}
        lines, good = names.report(self.places(files))
        self.assertEqual(lines[:2], ["B: a.rs:2 b.rs:2 c.rs:1", "A: a.rs:1 b.rs:1"])
        self.assertIn("5 of 6 definitions", lines[2])
        self.assertFalse(good)

    def test_the_limit_itself_is_allowed_and_no_more(self):
        own = {f"T{k}": ["a.rs:1"] for k in range(17)}
        lines, good = names.report({**own, "S": ["a.rs:1", "b.rs:1", "c.rs:1"]})
        self.assertTrue(good, lines)
        del own["T0"]
        self.assertFalse(names.report({**own, "S": ["a.rs:1", "b.rs:1", "c.rs:1"]})[1])

    def test_a_folder_without_sources_is_an_error(self):
        with self.assertRaises(SystemExit):
            self.places({})


unittest.main()
