#!/usr/bin/env python3
"""Lists the tests that a log of CTest says were skipped, by reason; for scripts/test.sh.

    scripts/skipped_tests.py build/release/Testing/Temporary/LastTest.log
"""

import collections
import re
import sys

# What CTest writes before the output of a test.
TEST = re.compile(r"^\d+/\d+ Testing: (.*)$", re.MULTILINE)
# What GoogleTest writes before the output of one of a suite.
CASE = re.compile(r"^\[ RUN      \] (\S+)$", re.MULTILINE)
# How GoogleTest, a script of ours, and unittest say why.
REASONS = (
    re.compile(r"^\S+:\d+: Skipped\n(.+)$", re.MULTILINE),
    re.compile(r"\bskipped: (.+)$", re.MULTILINE),
    re.compile(r"\.\.\. skipped ['\"](.+)['\"]$", re.MULTILINE),
)


def reasons_of(log):
    """Names of tests by the reason for which they, or a part of one, were skipped."""
    skipped = collections.defaultdict(list)
    _, *parts = TEST.split(log)
    for name, record in zip(parts[::2], parts[1::2]):
        cases = CASE.split("\n" + record.partition("<end of output>")[0])
        for case, output in zip([name, *cases[1::2]], cases[::2]):
            found = [reason for pattern in REASONS for reason in pattern.findall(output)]
            for reason in dict.fromkeys(found):
                skipped[reason].append(case)
    return skipped


def main():
    with open(sys.argv[1], encoding="utf-8", errors="replace") as file:
        skipped = reasons_of(file.read())
    # What a test does not apply to cannot be made to run.
    for reason in [reason for reason in skipped if reason.startswith("does not apply: ")]:
        print(f"\nNot applicable: {len(skipped.pop(reason))} tests: {reason[16:]}")
    if not skipped:
        print("\nNo test was skipped.")
        return
    print("\nSkipped, with the reason and what makes them run:")
    for reason, names in sorted(skipped.items(), key=lambda item: (-len(item[1]), item[0])):
        others = f" and {len(names) - 1} more" if len(names) > 1 else ""
        print(f"  {names[0]}{others}: {reason}")


if __name__ == "__main__":
    main()
