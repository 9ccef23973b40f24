"""Formulas of the pages, between $ and in blocks of `math`: scripts/reproduce.sh --test"""

import re
import unittest
from pathlib import Path

DOCS = Path(__file__).resolve().parents[2] / "docs"
# Beyond ASCII, what KaTeX and MathJax both draw.
DRAWN = set("αβγδεζηθικλμνξπρσςτυφχψωΓΔΘΛΞΠΣΦΨΩ∂⊕⊖≤≥≈≠←→∞×·±°…")


def formulas_of(text):
    """(line, formula) of a page, code left aside."""
    language = None
    for number, line in enumerate(text.splitlines(), 1):
        fence = re.match(r"\s*```(\w*)", line)
        if fence:
            if language is None:
                language, first, lines = fence[1], number, []
            else:
                if language == "math":
                    yield first, "\n".join(lines)
                language = None
        elif language is not None:
            lines.append(line)
        else:
            for found in re.finditer(r"\$([^$]*)\$", re.sub(r"`[^`]*`", "", line)):
                yield number, found[1]


def fault_of(formula):
    """What keeps a formula from being drawn, or from being read as HTML, or None."""
    foreign = sorted({one for one in formula if ord(one) > 126 and one not in DRAWN})
    if foreign:
        return f"is not drawn: {''.join(foreign)}"
    if "<" in formula:
        return "'<' opens a tag; it is \\lt"
    depth = 0
    for one in re.sub(r"\\[{}]", "", formula):
        depth += {"{": 1, "}": -1}.get(one, 0)
        if depth < 0:
            break
    if depth:
        return "braces do not match"
    begun = []
    for kind, name in re.findall(r"\\(begin|end)\{(\w+)\}", formula):
        if kind == "begin":
            begun.append(name)
        elif not begun or begun.pop() != name:
            return f"\\end{{{name}}} ends nothing"
    if begun:
        return f"{begun[-1]} is not ended"
    if re.search(r"(\^(\{[^}]*\}|\\\w+|\w)|'_(\{[^}]*\}|\w))\^", formula):
        return "two superscripts"
    return None


class Formulas(unittest.TestCase):
    def test_can_be_drawn(self):
        seen = 0
        for page in sorted(DOCS.rglob("*.md")):
            for line, formula in formulas_of(page.read_text("utf-8")):
                seen += 1
                with self.subTest(place=f"{page.relative_to(DOCS)}:{line}", formula=formula):
                    self.assertIsNone(fault_of(formula))
        self.assertGreater(seen, 200)

    def test_faults_are_found(self):
        for formula, is_right in ((r"P_{n+1} = J_X P_n J_X^\top", True), ("a < b", False),
                                  ("P_{n", False), ("a}{", False), (r"x^⊤", False),
                                  (r"\begin{aligned} a", False), (r"G'_k^\top", False),
                                  (r"\begin{aligned} a \end{bmatrix}", False), ("x'", True)):
            with self.subTest(formula=formula):
                self.assertEqual(fault_of(formula) is None, is_right)


if __name__ == "__main__":
    unittest.main()
