"""Tests of what the pages of results say with "no", "all", "any": scripts/reproduce.sh --test"""

import sys
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "scripts/reproduce"))
sys.path.insert(0, str(TOP / "tests/docs"))

import audit  # noqa: E402
import claims  # noqa: E402
import markdown  # noqa: E402


def wrecked(turn):
    """Changes of a cell that leave no claim true: numbers are scaled up and down in turn, or all
    turned round in sign or size."""
    count = [0]

    def change(cell):
        count[0] += 1
        factor = turn(count[0])
        return claims._VALUE.sub(
            lambda found: f"{claims.numbers_of(found[0])[0] * factor:.6g}", cell)

    return change


TURNS = (lambda n: 1e4, lambda n: 1e-4, lambda n: -1.0, lambda n: 1e4 if n % 2 else 1e-4,
         lambda n: 1e4 if n % 3 else 1e-4, lambda n: 1e4 if n % 7 else 1e-4, lambda n: 0.0)


class Claims(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.pages = {name: markdown.read_page(TOP / name) for name in audit.pages_of(TOP)}
        cls.exceptions = audit.read_exceptions(audit.EXCEPTIONS.read_text(encoding="utf-8"))
        cls.other = audit.read_exceptions(claims.OTHER.read_text(encoding="utf-8"))

    def test_hold_by_their_tables(self):
        for one in claims.all_claims():
            with self.subTest(page=one.page, claim=one.fragment):
                self.assertTrue(one.holds(claims.Tables(self.pages[one.page])))

    def test_fail_by_other_tables(self):
        for one in claims.all_claims():
            def fails(turn, one=one):
                try:
                    return not one.holds(claims.Tables(self.pages[one.page], wrecked(turn)))
                except (ValueError, ZeroDivisionError, IndexError):
                    return True

            with self.subTest(page=one.page, claim=one.fragment):
                self.assertTrue(any(map(fails, TURNS)), "holds whatever the table says")

    def test_stand_on_their_pages_once(self):
        fragments = [(one.page, one.fragment) for one in claims.all_claims()]
        for page, fragment in [*fragments, *self.other]:
            text = "\n".join(self.pages[page].lines)
            with self.subTest(page=page, fragment=fragment):
                self.assertEqual(text.count(fragment), 1)
                self.assertRegex(fragment, claims.WORDS)

    def test_are_made_of_every_such_word_of_a_result(self):
        for name, page in self.pages.items():
            fragments = [one.fragment for one in claims.all_claims() if one.page == name]
            fragments += [fragment for place, fragment in self.other if place == name]
            for index in claims.result_lines(name, page, self.exceptions):
                for text in claims.uncovered(page.lines[index], fragments):
                    with self.subTest(place=f"{name}:{index + 1}", text=text):
                        self.fail("neither a claim of claims_of/ nor a line of its other.txt")


class Reading(unittest.TestCase):
    def test_numbers_of_a_cell(self):
        for cell, numbers in (("0.5 [−0.1, 1.2]", [0.5, -0.1, 1.2]), ("**3**", [3.0]), ("–", []),
                              ("2.4·10⁻⁵", [2.4e-5]), ("1e-3", [1e-3]), ("30 %", [30.0])):
            self.assertEqual(claims.numbers_of(cell), numbers, cell)

    def test_words_outside_of_a_fragment_are_found(self):
        line = "No loop is false, all are kept."
        self.assertEqual(len(list(claims.uncovered(line, []))), 2)
        self.assertEqual(len(list(claims.uncovered(line, ["No loop is false"]))), 1)
        self.assertEqual(len(list(claims.uncovered(line, ["loop is false"]))), 2)
        self.assertEqual(list(claims.uncovered("a [way](page.md#of-no-return)", [])), [])


if __name__ == "__main__":
    unittest.main()
