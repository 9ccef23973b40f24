"""The session of docs/python.md gives what the page says."""

import doctest
import importlib.util
import os
import re
import unittest

PAGE = os.path.join(os.path.dirname(__file__), "..", "..", "docs", "python.md")
NEEDS = {".plot(": "matplotlib", "to_frame(": "pandas"}


def sessions():
    with open(PAGE, encoding="utf-8") as page:
        return re.findall(r"^```pycon\n(.*?)^```$", page.read(), re.MULTILINE | re.DOTALL)


class Session(unittest.TestCase):
    def test_it_gives_what_the_page_says(self):
        (session,) = sessions()
        test = doctest.DocTestParser().get_doctest(session, {}, "docs/python.md", PAGE, 0)
        self.assertGreaterEqual(len(test.examples), 12)
        for part, package in NEEDS.items():
            if importlib.util.find_spec(package) is None:
                print(f"skipped: no {package}; 'apt-get install python3-{package}' has it")
                test.examples = [one for one in test.examples if part not in one.source]
        said = []
        flags = doctest.NORMALIZE_WHITESPACE
        runner = doctest.DocTestRunner(verbose=False, optionflags=flags)
        runner.run(test, out=said.append)
        self.assertEqual("".join(said), "")


if __name__ == "__main__":
    unittest.main()
