"""What a prompt and a notebook show."""

import base64
import html.parser
import re
import unittest
import xml.etree.ElementTree

import fathom
import misbehaving
import numpy
from small_study import FAILING, STUDY


class Parsed(html.parser.HTMLParser):
    """Tags that are open at the end, the names of all, and the pictures."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.pictures = [], set(), []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.tags.add(tag)
        if tag == "img":
            kind, data = dict(attributes)["src"].split(",")
            assert kind == "data:image/svg+xml;base64", kind
            self.pictures.append(xml.etree.ElementTree.fromstring(base64.b64decode(data)))
        else:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def square():
    log = fathom.MeasurementLog()
    for _ in range(3):
        log.add_keyframe((1, 0, numpy.pi / 2), 0.01 * numpy.eye(3))
    log.add_registration(fathom.RelativePose(3, 0, (1.1, 0, numpy.pi / 2), 0.01 * numpy.eye(3)))
    return log


class Texts(unittest.TestCase):
    def test_of_measurements(self):
        log = square()
        step = "x 1 m, y 0 m, theta 1.571 rad"
        self.assertEqual(repr(log), "<fathom.MeasurementLog of 4 keyframes, 1 registration>")
        self.assertEqual(repr(log.steps[0]), f"<fathom.RelativePose 0 -> 1: {step}>")
        errors = fathom.PictureErrors(numpy.eye(3), (0.01, 0.02, 0.03))
        self.assertEqual(repr(errors), "<fathom.PictureErrors sigma 0.01, 0.02, 0.03>")
        shared = fathom.SharedErrors(errors, errors, 0.04 * numpy.eye(3))
        self.assertEqual(repr(shared), "<fathom.SharedErrors own 0.2, 0.2, 0.2 (1 sigma)>")

    def test_of_a_solution(self):
        solution = fathom.solve(square(), "ekf", mode="incremental")
        self.assertRegex(
            repr(solution), r"^<fathom.Solution of ekf: converged, 4 keyframes, F [\d.e-]+>$"
        )

    def test_of_what_an_estimator_is_given(self):
        seen = []

        class Looks(fathom.Estimator):
            def __init__(self, setup):
                self.count = 1
                seen.append(setup)

            def pose(self, k):
                return (0, 0, 0)

            def add_keyframe(self, step):
                self.count += 1

            def update(self, measurements):
                seen.append(measurements)

        fathom.replay(square(), Looks, isolation="none")
        setup, measurements = seen
        self.assertEqual(
            repr(setup), "<fathom.Setup incremental, start x 0 m, y 0 m, theta 0 rad>"
        )
        self.assertEqual(repr(measurements), "<fathom.Measurements of 1 registration, 0 absolute>")
        self.assertIn("<td>1.1</td>", measurements._repr_html_())


class Html(unittest.TestCase):
    def parsed(self, thing):
        page = Parsed(thing._repr_html_())
        self.assertEqual(page.open, [])
        self.assertTrue(page.tags <= {"table", "tr", "td", "th", "p", "img"}, page.tags)
        return page

    def test_of_logs_and_solutions(self):
        log = square()
        for thing in (log, fathom.solve(log)):
            (picture,) = self.parsed(thing).pictures
            self.assertTrue(picture.tag.endswith("}svg"))
        self.assertIn("<td>4</td>", log._repr_html_())
        self.parsed(log.registrations[0])

    def test_of_results(self):
        with fathom.compare(STUDY) as results:
            text = results._repr_html_()
            self.assertEqual(len(self.parsed(results).pictures), 1)
        self.assertIn("drawn &lt;b&gt;logs&lt;/b&gt;: means over the runs", text)
        self.assertIn("<th>mean position error (m)</th>", text)
        mean = results.metric("mean_position_error_m", "ekf", 3).mean()
        row = rf"<td>noise 0.02, loops 0.01</td><td>ekf</td><td>2/2</td><td>{mean:.4g}</td>"
        self.assertTrue(re.search(row, text), text[:2000])
        self.assertEqual(self.parsed(results).pictures, [])  # the folder is gone

    def test_means_are_over_the_runs_that_were_done(self):
        with fathom.compare(FAILING) as results:
            text = results._repr_html_()
        outcomes = [row["outcome"] for row in results.rows if row["estimator"] == "ekf"]
        self.assertEqual(outcomes, ["diverged", "converged", "converged"])
        errors = results.metric("mean_position_error_m", "ekf")
        self.assertEqual(len(errors), 2)
        self.assertIn(f"<td>ekf</td><td>2/3</td><td>{errors.mean():.4g}</td>", text)

    def test_what_an_estimator_says_is_escaped(self):
        class Raises(misbehaving.Follows):
            def __init__(self, setup):
                raise ValueError("<script>alert(1)</script>")

        solution = fathom.replay(square(), Raises)
        self.assertIn("<script>", solution.fault)
        self.parsed(solution)
        self.assertIn("&lt;script&gt;", solution._repr_html_())


if __name__ == "__main__":
    unittest.main()
