"""Tests of scripts/reproduce: scripts/reproduce.sh --test"""

import json
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "scripts/reproduce"))
sys.path.insert(0, str(TOP / "tests/docs"))

import audit  # noqa: E402
import layout  # noqa: E402
import markdown  # noqa: E402
import provenance  # noqa: E402
from in_a_folder import InAFolder  # noqa: E402
from comparison import differences, numbers_agree  # noqa: E402
from maker import Maker, all_makers  # noqa: E402
from workshop import CommandFailed, Workshop  # noqa: E402


def table_of(*rows):
    text = "\n".join(["| a | b | c |", "|---|---|---|", *rows])
    return markdown.read_text("page", text).tables[0]


class Rule(unittest.TestCase):
    def test_numbers_however_they_are_dressed(self):
        for cell in ("1", "−0.5", "**0.0067, 0**", "`3`", "< 2", "below 0.1 ms",
                     "4.91 [4.87, 4.93]", ".5", "10 %", "(3)", "about 7"):
            self.assertTrue(markdown.is_number(cell), cell)
        for cell in ("", "–", "converged", "χ²", "σ² A⁻¹", "level 5", "below the floor"):
            self.assertFalse(markdown.is_number(cell), cell)

    def test_a_quarter_of_the_cells_makes_a_table_of_numbers(self):
        self.assertTrue(markdown.is_of_numbers(table_of("| x | 1 | y |", "| x | z | y |")))
        self.assertFalse(markdown.is_of_numbers(
            table_of("| x | 1 | y |", "| x | z | y |", "| 3 | z | y |")))

    def test_empty_cells_hide_nothing(self):
        self.assertTrue(markdown.is_of_numbers(table_of("| x | 1 | |", "| x | | |", "| x | | |")))

    def test_a_fenced_table_of_the_program_counts(self):
        page = markdown.read_text("page", "```\nname  F\n----  ---\nekf   1\n```")
        self.assertTrue(markdown.is_of_numbers(page.tables[0]))


class Markers(unittest.TestCase):
    def refused(self, text, line):
        with self.assertRaisesRegex(markdown.PageError, f"^page:{line}: "):
            markdown.read_text("page", text)

    def test_that_do_not_pair_are_refused_with_their_line(self):
        self.refused("\n<!-- made: a -->", 2)
        self.refused("<!-- end: a -->", 1)
        self.refused("<!-- made: a -->\n<!-- end: b -->", 2)
        self.refused("<!-- made: a -->\n<!-- made: b -->", 2)
        self.refused("<!-- made: a -->\n<!-- end: a -->\n<!-- made: a -->", 3)
        self.refused("<!-- made:a -->", 1)

    def test_only_what_is_between_them_is_replaced(self):
        page = markdown.read_text("page", "x\n<!-- made: a -->\nold\n<!-- end: a -->\ny\n")
        self.assertEqual(markdown.replace_part(page, "a", "new\n"),
                         "x\n<!-- made: a -->\n\nnew\n\n<!-- end: a -->\ny\n")

    def test_in_a_fence_are_an_example(self):
        self.assertEqual(markdown.read_text("page", "```\n<!-- made: a -->\n```").parts, {})


class Comparison(unittest.TestCase):
    def test_one_unit_of_the_last_place_is_rounding(self):
        self.assertTrue(numbers_agree("45.41", "45.42"))
        self.assertFalse(numbers_agree("45.41", "45.43"))
        self.assertTrue(numbers_agree("1.2e-05", "1.3e-05"))
        self.assertFalse(numbers_agree("1.2e-05", "1.2e-04"))
        self.assertTrue(numbers_agree("45.4", "45.41"))

    def test_counts_are_exact(self):
        self.assertFalse(numbers_agree("26", "27"))
        self.assertFalse(differences("| `sift` | 10000 |", "| `sift` | 10000 |"))

    def test_words_rows_and_the_line_below(self):
        old = "| ring | 1.0 |\n\n" + provenance.recorded_line("`x`")
        self.assertEqual(differences(old, "| ring | 1.0 |"), [])
        self.assertEqual(len(differences(old, "| rung | 1.0 |")), 1)
        self.assertEqual(len(differences(old, "| ring | 1.0 |\n| MIT | 2.0 |")), 1)


class Layout(unittest.TestCase):
    def test_significant_digits(self):
        for value, text in ((0.000123456, "0.000123"), (9.996, "10.0"), (12345.6, "12300"),
                            (0, "0"), (None, "–"), (-1.5, "-1.50")):
            self.assertEqual(layout.significant(value), text)

    def test_share_intervals_are_those_of_published_tables(self):
        # Clopper and Pearson's, as R's binom.test prints them.
        for k, n, low, high in ((0, 10, 0, 0.3085), (5, 10, 0.1871, 0.8129), (10, 10, 0.6915, 1),
                                (1, 20, 0.0013, 0.2487)):
            found = layout.share_interval(k, n)
            self.assertAlmostEqual(found[0], low, places=4)
            self.assertAlmostEqual(found[1], high, places=4)
        self.assertEqual(layout.share(0, 20), "0 of 20 [0, 17] %")


class Audit(InAFolder):
    TABLE = "| a | b |\n|---|---|\n| x | 1 |\n"
    HOW = "`fathom x`"
    PART = f"<!-- made: t -->\n{TABLE}\n{provenance.recorded_line(HOW)}\n<!-- end: t -->\n"

    def problems(self, page, exceptions=None, pictures=(), makers=1):
        self.write("README.md", page)
        (self.top / "docs/images").mkdir(parents=True, exist_ok=True)
        made = [Maker("README.md", "t", "quick", self.HOW, 1, None, pictures=pictures)] * makers
        return audit.problems(self.top, made, exceptions or {})

    def test_what_is_right_passes(self):
        self.assertEqual(self.problems(self.PART), [])

    def test_a_table_without_a_maker_fails(self):
        self.assertRegex(self.problems(self.PART + self.TABLE)[0],
                         r"^README.md:\d+: a table of numbers")

    def test_an_exception_lets_it_pass_and_is_refused_where_nothing_needs_it(self):
        place = {("README.md", "| a | b |"): "because"}
        self.assertEqual(self.problems(self.TABLE, place, makers=0), [])
        self.assertEqual(len(self.problems("text\n", place, makers=0)), 1)
        self.assertEqual(len(self.problems(self.PART, place)), 2)

    def test_markers_and_makers_go_together(self):
        self.assertRegex(self.problems("text\n")[0], "no markers")
        self.assertRegex(self.problems(self.PART, makers=0)[0], "no maker")
        self.assertRegex(self.problems(self.PART, makers=2)[0], "same name")

    def test_the_line_names_the_command_of_the_maker(self):
        self.assertRegex(self.problems(self.PART.replace("fathom x", "fathom y"))[0], "otherwise")
        self.assertRegex(self.problems(self.PART.replace("*Recorded", "Recorded"))[0], "0 lines")

    def test_every_picture_has_a_maker(self):
        self.write("docs/images/a.png", "")
        self.assertRegex(self.problems(self.PART)[0], "without a maker")
        self.assertEqual(self.problems(self.PART, pictures=("docs/images/a.png",)), [])
        pictures = ("docs/images/a.png", "docs/images/b")
        self.assertRegex(self.problems(self.PART, pictures=pictures)[0], "is not there")

    def test_an_exception_needs_a_reason(self):
        with self.assertRaises(markdown.PageError):
            audit.read_exceptions("README.md: | a | b | => \n")


class Shop(InAFolder):
    def shop(self, **options):
        program = self.write("build/program", "#!/bin/sh\necho $1 >> count\ntest $1 != bad\n")
        program.chmod(0o755)
        return Workshop(self.top, *(self.top / of for of in ("out", "build", "data")), **options)

    def calls(self):
        count = self.top / "count"
        return len(count.read_text().split()) if count.exists() else 0

    def test_a_command_that_has_ended_is_not_run_again(self):
        self.shop().run("a", "program", "good")
        shop = self.shop()
        folder = shop.run("a", "program", "good")
        self.assertEqual(self.calls(), 1)
        self.assertEqual(shop.records, [json.loads((folder / "made.json").read_text())])

    def test_but_with_other_arguments_or_sources_or_when_asked_to(self):
        self.shop().run("a", "program", "good")
        self.shop().run("a", "program", "better")
        self.write("src/a.cpp", "int a;\n")
        self.shop().run("a", "program", "good")
        self.assertEqual(self.calls(), 3)
        again = self.shop(again=True)
        for _ in range(2):
            again.run("a", "program", "good")
        self.assertEqual(self.calls(), 4)

    def test_and_with_another_configuration_of_the_same_name(self):
        for text in ("trials: 1\n", "trials: 2\n"):
            self.write("configs/a.yaml", text)
            self.shop().run("a", "program", "configs/a.yaml")
        self.assertEqual(self.calls(), 2)

    def test_a_command_that_failed_is_run_again(self):
        for _ in range(2):
            with self.assertRaises(CommandFailed):
                self.shop().run("a", "program", "bad")
        self.assertEqual(self.calls(), 2)


class CommandLine(InAFolder):
    def run_in_a_copy(self, *arguments, change=("", "")):
        shutil.copytree(TOP / "scripts/reproduce", self.top / "scripts/reproduce")
        shutil.copytree(TOP / "docs", self.top / "docs")
        shutil.copy(TOP / "README.md", self.top)
        page = self.top / "docs/registration.md"
        text = page.read_text(encoding="utf-8")
        if change[0]:
            self.assertEqual(text.count(change[0]), 1)
            page.write_text(text := text.replace(*change), encoding="utf-8")
        program = [sys.executable, "-B", str(self.top / "scripts/reproduce")]
        done = subprocess.run([*program, *arguments], capture_output=True, text=True, cwd=self.top,
                              check=False)
        return done, text, page.read_text(encoding="utf-8")

    ONE = ("--only", "places-needed")
    CHANGE = ("| places needed | 14 |", "| places needed | 15 |")

    def test_check_passes_what_is_as_made(self):
        done, *_ = self.run_in_a_copy("--check", *self.ONE)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_check_names_page_and_table_and_writes_nothing(self):
        done, before, after = self.run_in_a_copy("--check", *self.ONE, change=self.CHANGE)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stdout, "docs/registration.md: places-needed: stale: .* 15 .* 14 ")
        self.assertEqual(before, after)

    def test_making_it_mends_it(self):
        done, before, after = self.run_in_a_copy(*self.ONE, change=self.CHANGE)
        self.assertEqual(done.returncode, 0)
        self.assertEqual(differences(before.replace(*reversed(self.CHANGE)), after), [])

    def test_what_lacks_its_program_is_left_and_said(self):
        done, before, after = self.run_in_a_copy("--check", "--only", "list-estimators")
        self.assertEqual(done.returncode, 77)
        self.assertIn("fathom is not built", done.stdout)

    def test_bad_words_end_with_2_and_one_line(self):
        for arguments in (["nowhere.md"], ["--only", "nothing"]):
            shutil.rmtree(self.top)
            done, *_ = self.run_in_a_copy(*arguments)
            self.assertEqual(done.returncode, 2)
            self.assertRegex(done.stderr, r"\Areproduce: error: [^\n]*\n\Z")


class AllMakers(unittest.TestCase):
    def test_say_how_long_they_take_and_name_no_file_of_one_machine(self):
        self.assertGreater(len(all_makers()), 40)
        for one in all_makers():
            self.assertNotRegex(one.how, r"(^|[\s`=])/")
            self.assertGreaterEqual(one.minutes, 0)
            if one.kind == "quick":
                self.assertLessEqual(one.minutes, 1, one.name)


if __name__ == "__main__":
    unittest.main()
