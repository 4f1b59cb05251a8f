#!/usr/bin/env python3
"""Tests of circles.py: each circle of a small crate is found, and what is none is not reported."""
import pathlib, tempfile, unittest

import circles


class Circles(unittest.TestCase):
    def found(self, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            return [line.removeprefix(folder).split(" (")[0] for line in circles.report(root)]

    def test_imports_below_a_module_of_tests_count(self):
        for tests in ["#[cfg(test)]\nmod tests;\n", "#[cfg(test)]\nmod tests {\n    use crate::b::B;\n}\n"]:
            files = {"lib.rs": "mod a;\nmod b;\n", "a.rs": tests + "use crate::b::B;\npub struct A(pub B);\n", "b.rs": "use crate::a::A;\n"}
            self.assertEqual(self.found(files), [": a b"])

    def test_a_file_is_one_part_with_those_in_its_folder(self):
        files = {
            "commands.rs": "mod fleet;\nmod serve;\n",
            "commands/fleet.rs": "mod run;\npub(super) use run::world;\n",
            "commands/fleet/run.rs": "use super::super::serve::broker;\nuse super::Arguments;\n",
            "commands/serve.rs": "mod demo;\n",
            "commands/serve/demo.rs": "use super::super::fleet::{self, Crew};\n",
        }
        self.assertEqual(self.found(files), ["/commands: fleet serve"])

    def test_groups_calls_and_whole_modules_are_imports(self):
        for use in ["use crate::{c::{D, E}, b::B};", "use crate::{\n    c,\n    b,\n};", "use crate::b::*;", "fn f() { crate::b::g() }", "use super::b;"]:
            files = {"lib.rs": "", "a.rs": use, "b.rs": "use crate::a::A;", "c.rs": ""}
            self.assertEqual(self.found(files), [": a b"], use)

    def test_a_circle_of_three(self):
        files = {"lib.rs": "", "a.rs": "use crate::b::B;", "b.rs": "use crate::c::C;", "c.rs": "use crate::a::A;"}
        self.assertEqual(self.found(files), [": a b c"])

    def test_no_circle(self):
        apart = {"a.rs": "use crate::b::B;\n// crate::c names a\n", "b.rs": "use super::c;\n", "c.rs": "mod d;\nuse d::D;\n", "c/d.rs": "use super::C;\n"}
        self.assertEqual(self.found({"lib.rs": "pub use a::A;\n", **apart}), [])
        # Tests may name anything, in the file and in a file of their own.
        tests = {"b.rs": "#[cfg(test)]\nmod tests;\n", "b/tests.rs": "use crate::a::A;\n", "c.rs": "#[cfg(test)]\n#[rustfmt::skip]\nmod tests {\n    use crate::a::A;\n}\n"}
        self.assertEqual(self.found({**apart, **tests}), [])

    def test_a_folder_without_sources_is_an_error(self):
        with self.assertRaises(SystemExit):
            self.found({})


unittest.main()
