"""A bar for who looks, and nothing in what is captured."""

import importlib.util
import os
import pty
import subprocess
import sys
import unittest

import fathom
import numpy

HAS_TQDM = importlib.util.find_spec("tqdm") is not None
STUDY = {"dataset": {"type": "simulated_log"}, "trials": 3}
CODE = """
import sys, time
if sys.argv[1] == "no tqdm":
    sys.modules["tqdm"] = sys.modules["tqdm.auto"] = None
import fathom, fathom._progress
fathom._progress.SHOWN_AFTER_S = 0  # what is looked at here is quick
class Slow(fathom.Estimator):
    def __init__(self, setup): self.count = 1
    def pose(self, k): return (0, 0, 0)
    def add_keyframe(self, step): time.sleep(0.01)
    def update(self, measurements): pass
config = {"dataset": {"type": "simulated_log"}}
fathom.WHAT
"""
COMPARE = "compare(config, ['ekf', Slow], set={'trials': 3}, progress=PROGRESS)"
RUN = "run(config, Slow, progress=PROGRESS)"


def shown(what, progress, tqdm="tqdm", at_terminal=True):
    """What is written to a terminal, or to a pipe."""
    code = CODE.replace("WHAT", what).replace("PROGRESS", repr(progress))
    leader, follower = pty.openpty() if at_terminal else os.pipe()
    with subprocess.Popen([sys.executable, "-c", code, tqdm], stderr=follower) as process:
        os.close(follower)
        written = b""
        while True:
            try:
                piece = os.read(leader, 4096)
            except OSError:  # so a terminal ends
                piece = b""
            if not piece:
                break
            written += piece
    os.close(leader)
    assert process.returncode == 0, written
    return written.decode()


class Bars(unittest.TestCase):
    def test_a_line_without_tqdm(self):
        text = shown(COMPARE, None, "no tqdm")
        self.assertRegex(text, r"\rruns \d/6")
        self.assertTrue(text.endswith("\r"))  # the prompt is where it was
        self.assertRegex(shown(RUN, None, "no tqdm"), r"\rslow, keyframe \d+/\d+")

    @unittest.skipUnless(HAS_TQDM, "no tqdm; 'apt-get install python3-tqdm' has it")
    def test_a_bar_of_tqdm(self):
        self.assertRegex(shown(COMPARE, None), r"\rruns: .*\d/6 \[")
        self.assertRegex(shown(RUN, None), r"slow, keyframe: .*/3\d \[")

    def test_nobody_looks(self):
        self.assertEqual(shown(COMPARE, None, at_terminal=False), "")
        self.assertEqual(shown(RUN, None, at_terminal=False), "")

    def test_it_is_asked_for(self):
        self.assertEqual(shown(COMPARE, False), "")
        self.assertIn("runs", shown(COMPARE, True, "no tqdm", at_terminal=False))


class Functions(unittest.TestCase):
    def test_are_called(self):
        heard = []
        fathom.compare(STUDY, ["ekf"], progress=heard.append).close()
        self.assertEqual((heard[-1]["done"], heard[-1]["of"]), (3, 3))
        heard.clear()
        solution = fathom.run({"dataset": {"type": "simulated_log"}}, "ekf", progress=heard.append)
        count = len(solution.log)
        self.assertIn({"stage": "ekf, keyframe", "step": count, "steps": count}, heard)

    def test_what_they_raise_ends_the_work(self):
        def stop(at):
            raise StopIteration("enough")

        log = fathom.MeasurementLog()
        for _ in range(5):
            log.add_keyframe((1, 0, 0), numpy.eye(3))
        with self.assertRaisesRegex(StopIteration, "enough"):
            fathom.replay(log, "ekf", progress=stop)
        with self.assertRaisesRegex(StopIteration, "enough"):
            fathom.run({"dataset": {"type": "simulated_log"}}, "ekf", progress=stop)


if __name__ == "__main__":
    unittest.main()
