#!/usr/bin/python3
"""The rules on a source of a few lines. Exit 77 without libclang."""

import sys
import tempfile
import unittest
from pathlib import Path

try:
    import generate
    generate.use_library()
    generate.Index.create()
except Exception as error:
    print(f"skipped: no libclang for Python ({error}); install python3-clang-16")
    sys.exit(77)


class Generated(unittest.TestCase):
    def generate(self, text, others=None):
        """The rows of the table, and the mutated text."""
        with tempfile.TemporaryDirectory() as folder:
            project, out = Path(folder) / "project", Path(folder) / "out"
            files = {"src/plc/a.cpp": text, **(others or {})}
            for path, content in files.items():
                (project / path).parent.mkdir(parents=True, exist_ok=True)
                (project / path).write_text(content)
            generator = generate.Generator(project, out, list(files))
            generator.run()
            return generator.table(), (out / "src/plc/a.cpp").read_text()

    def mutants(self, text):
        return {(row["rule"], row["before"], row["after"]) for row in self.generate(text)[0]}

    def test_comparisons_and_their_constants(self):
        found = self.mutants("bool f(int a) { return a < 10; }")
        self.assertEqual(found, {("comparison", "a < 10", "(a) <= (10)"), ("constant", "10", "10 + 1"),
                                 ("constant", "10", "10 - 1")})

    def test_conditions(self):
        found = self.mutants("int f(bool a, bool b) { if (a && b) return 7; return 7; }")
        self.assertIn(("never", "a && b", "false"), found)
        self.assertIn(("always", "a && b", "true"), found)
        self.assertIn(("logic", "a && b", "(a) || (b)"), found)
        self.assertIn(("operand dropped", "a && b", "static_cast<bool>(b)"), found)
        self.assertIn(("dropped", "return 7;", ""), found)
        self.assertEqual(sum(rule == "dropped" for rule, _, _ in found), 1)

    def test_state_changes(self):
        found = self.mutants("struct S { int n = 3; void f() { n += 2; n = 0; } };")
        self.assertIn(("dropped", "n += 2;", ""), found)
        self.assertIn(("arithmetic", "n += 2", "n -= 2"), found)
        self.assertIn(("dropped", "n = 0;", ""), found)
        self.assertIn(("constant", "3", "3 + 1"), found)

    def test_cases_and_enumerators(self):
        found = self.mutants("enum class E { a, b }; int f(E e) { switch (e) { case E::a: return 1; case E::b: break; } return 2; }\n"
                             "E g() { return E::b; }")
        self.assertIn(("case", "e", "(e) == E::a ? E::b : (e)"), found)
        self.assertIn(("constant", "E::b", "E::a"), found)

    def test_rows_of_constant_tables_are_chosen_at_run_time(self):
        rows, text = self.generate("constexpr int table[2] = {5, 6};\nint f(int i) { return table[i]; }")
        self.assertEqual([row["after"] for row in rows], ["5 + 1", "5 - 1", "6 + 1", "6 - 1"])
        self.assertTrue(all(row["once"] for row in rows))
        self.assertIn("const int table[2] = {(is_mutant(1) ? (5 + 1) : is_mutant(2) ? (5 - 1) : (5))", text)

    def test_tables_of_such_rows_follow_them(self):
        rows, text = self.generate("struct Row { int n; };\nconstexpr Row first{5};\n"
                                   "struct Table { Row rows[1]; };\nconstexpr Table all{{first}};\nint f() { return all.rows[0].n; }")
        self.assertIn("5 + 1", {row["after"] for row in rows})
        self.assertIn("const Table all", text)

    def test_what_must_stay_constant_is_left_alone(self):
        rows, text = self.generate("constexpr int size = 4;\nint f() { int a[size] = {}; return a[0] + size; }\n"
                                   "static_assert(size == 4);")
        self.assertNotIn("5", {row["after"] for row in rows})
        self.assertIn("constexpr int size = 4;", text)
        self.assertIn("arithmetic", {row["rule"] for row in rows})

    def test_a_function_still_returns_something(self):
        found = self.mutants("int f(bool a) { if (a) { return 1; } else { return 2; } }")
        self.assertNotIn("dropped", {rule for rule, _, _ in found})

    def test_texts_for_people_are_left_alone(self):
        found = self.mutants('const char* f(bool a) { return a ? "RSS" : "is not registered"; }')
        self.assertIn(("constant", '"RSS"', '"RST"'), found)
        self.assertFalse([after for _, before, after in found if "registered" in before])

    def test_what_only_saves_time_is_left_alone(self):
        found = self.mutants("struct S { void reserve(int n); }; void f(S& s) { s.reserve(1 + 2); }")
        self.assertEqual(found, set())

    def test_refusing_a_set_up_is_left_alone(self):
        found = self.mutants("int fail(const char*); struct R { int error(); explicit operator bool(); };\n"
                             'int f(int a, R r) { if (a > 2) return fail("too much"); if (!r) { return r.error(); } return a; }')
        self.assertEqual(found, set())

    def test_numbers_follow_each_other_over_files(self):
        rows, _ = self.generate("int f() { return 0; }", {"src/plc/b.cpp": "int g() { return 0; }"})
        self.assertEqual([(row["id"], row["file"]) for row in rows], [(1, "src/plc/a.cpp"), (2, "src/plc/b.cpp")])


if __name__ == "__main__":
    unittest.main()
