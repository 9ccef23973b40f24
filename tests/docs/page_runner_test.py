"""Tests of page_runner.py: scripts/reproduce.sh --test"""

import os
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import in_a_folder  # noqa: E402
import page_runner  # noqa: E402


class Following(in_a_folder.InAFolder):
    def follow(self, *lines, **rest):
        return page_runner.follow("\n".join(lines), self.top, dict(os.environ), **rest)

    def refused(self, *lines):
        with self.assertRaises(page_runner.PageError) as caught:
            self.follow(*lines)
        return str(caught.exception)

    def test_files_are_written_and_commands_run_in_order(self):
        page = ("text", '```yaml title="a.yaml"', "key: 1", "```", "```sh", "cat a.yaml",
                "cp a.yaml b", "```", "```", "key: 1", "```", "```sh", "cat b", "```")
        self.assertEqual(self.follow(*page), 2)

    def test_a_command_that_fails_is_named(self):
        self.assertIn("line 2: status 3", self.refused("text", "```sh", "(exit 3)", "```"))
        self.assertIn("status 1", self.refused("```sh", "false", "echo later", "```"))

    def test_a_block_that_nothing_checks_is_refused(self):
        self.assertIn("neither run nor a file", self.refused("```yaml", "key: 1", "```"))
        self.assertIn("left open", self.refused("```sh", "true"))
        self.assertIn("not a fence", self.refused("```sh title=a", "```"))

    def test_output_that_is_not_printed_is_named(self):
        self.assertIn("not printed: c",
                      self.refused("```sh", "echo a", "echo b", "```", "```", "a", "c", "```"))

    def test_python_can_be_left_out(self):
        page = ("```sh", "true", "```", '```python title="a.py"', "```", "```sh", "false", "```")
        self.assertEqual(self.follow(*page, with_python=False), 1)


class Showing(unittest.TestCase):
    def test_numbers_may_differ_a_little_and_words_not(self):
        for shown, printed, is_same in (
                ("ekf 0.0160 [0.00887, 0.0310] 3/3", "ekf  0.0161 [0.009, 0.03]  3/3", True),
                ("a 1.0", "a 2.0", False), ("a 1.0", "b 1.0", False), ("a -1", "a 1", False),
                ("a 1e-05", "a 1.1e-05", True), ("a 1", "a –", False),
                ("p 0.041.", "p 0.04.", True),
                ("a … c", "a b c", True), ("a …", "b c", False), ("a 1 …", "a 9 c", False)):
            with self.subTest(shown=shown, printed=printed):
                self.assertEqual(page_runner.is_shown_by(shown, printed), is_same)

    def test_lines_follow_one_another_but_where_some_are_left_out(self):
        printed = "a\nb\n---\nc\nd\n"
        for shown, missing in (("a\nb\nc\n", None), ("b\n", None), ("a\nc\n", "c"),
                               ("a\n…\nd\n", None), ("b\na\n", "a"), ("a\n…\ne\n", "e")):
            with self.subTest(shown=shown):
                self.assertEqual(page_runner.missing_line(shown, printed), missing)


if __name__ == "__main__":
    unittest.main()
