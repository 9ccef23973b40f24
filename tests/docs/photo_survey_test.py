"""Tests of scripts/photo_survey.py: scripts/reproduce.sh --test"""

import struct
import subprocess
import sys
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "tests/docs"))

from in_a_folder import InAFolder  # noqa: E402

SCRIPT = TOP / "scripts/photo_survey.py"


def folder(entries, offset):
    """An EXIF folder at this offset: entries (tag, type, count, bytes), long values behind it."""
    behind = offset + 2 + 12 * len(entries) + 4
    head, tail = struct.pack("<H", len(entries)), b""
    for tag, kind, count, value in entries:
        place = value.ljust(4, b"\0") if len(value) <= 4 else struct.pack("<I", behind + len(tail))
        head += struct.pack("<HHI", tag, kind, count) + place
        tail += value if len(value) > 4 else b""
    return head + struct.pack("<I", 0) + tail


def angle(degrees, minutes, seconds):
    return struct.pack("<6I", degrees, 1, minutes, 1, round(seconds * 10000), 10000)


def jpeg(time, north_s, west_s, dji=True):
    """The headers of a JPEG of 40 x 30 pixels, at 46° 50' north, 91° 59' west and seconds."""
    gps_at, exif_at = 500, 300
    gps = folder([(1, 2, 2, b"N\0"), (2, 5, 3, angle(46, 50, north_s)), (3, 2, 2, b"W\0"),
                  (4, 5, 3, angle(91, 59, west_s)), (6, 5, 1, struct.pack("<2I", 1983, 10))],
                 gps_at)
    exif = folder([(0x9003, 2, 20, time.encode() + b"\0")], exif_at)
    first = folder([(0x8769, 4, 1, struct.pack("<I", exif_at)),
                    (0x8825, 4, 1, struct.pack("<I", gps_at))], 8)
    data = (b"II*\0" + struct.pack("<I", 8) + first).ljust(exif_at, b"\0") + exif
    data = b"Exif\0\0" + data.ljust(gps_at, b"\0") + gps
    xmp = b'drone-dji:RelativeAltitude="+40.10" drone-dji:GimbalYawDegree="+90.00"' if dji else b""
    segments = [(0xE1, data), (0xE1, xmp), (0xC0, struct.pack(">BHH", 8, 30, 40))]
    return b"\xff\xd8" + b"".join(struct.pack(">BBH", 0xFF, marker, len(content) + 2) + content
                                  for marker, content in segments)


class PhotoSurvey(InAFolder):
    def photo(self, name, *arguments, **more):
        (self.top / "photos").mkdir(exist_ok=True)
        (self.top / "photos" / name).write_bytes(jpeg(*arguments, **more))

    def make(self, *arguments):
        return subprocess.run([sys.executable, "-B", str(SCRIPT), str(self.top / "photos"), "--out",
                               str(self.top / "survey"), *arguments],
                              capture_output=True, text=True, check=False)

    def rows(self, name):
        lines = (self.top / "survey" / name).read_text("utf-8").splitlines()
        return [line for line in lines if not line.startswith("#")]

    def three(self):
        self.photo("a1.JPG", "2016:06:23 16:31:59", 33.0, 40.0)
        self.photo("a2.JPG", "2016:06:23 16:32:06", 34.0, 40.0)
        self.photo("a3.JPG", "2016:06:23 16:32:13", 34.0, 41.0)

    def test_a_folder_that_fathom_reads(self):
        self.three()
        done = self.make("--focal-px", "30")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.rows("mav0/cam0/sensor.yaml"),
                         ["resolution: [40, 30]", "intrinsics: [30.0, 30.0, 19.5, 14.5]"])
        self.assertEqual(self.rows("mav0/cam0/data.csv")[0], "1466699519000000000,a1.JPG")
        self.assertEqual(self.rows("mav0/altimeter0/data.csv")[1], "1466699526000000000,40.100")
        self.assertFalse((self.top / "survey/mav0/position0").exists())

    def test_positions_are_metres_north_and_west_and_heading_is_counter_clockwise(self):
        self.three()
        self.make("--focal-px", "30")
        poses = [list(map(float, row.split())) for row in self.rows("reference.tum")]
        # A second of latitude there is 30.88 m, one of longitude 21.19 m (WGS 84).
        self.assertAlmostEqual(poses[1][1], 30.88, delta=0.01)
        self.assertAlmostEqual(poses[2][2], 21.19, delta=0.01)
        self.assertAlmostEqual(poses[0][6], -(0.5 ** 0.5), places=6)  # east is −90°

    def test_every_other_position_is_given_and_the_others_are_held_out(self):
        self.three()
        self.make("--focal-px", "30", "--fixes", "even", "--sigma-m", "2")
        self.assertEqual(len(self.rows("mav0/position0/data.csv")), 2)
        self.assertTrue(self.rows("mav0/position0/data.csv")[0].endswith(",4.0,0,4.0"))
        self.assertEqual([row.split()[0] for row in self.rows("held_out.tum")],
                         ["1466699526.000000000"])

    def test_height_over_the_ground(self):
        self.photo("a1.JPG", "2016:06:23 16:31:59", 33.0, 40.0, dji=False)
        self.assertIn("give --altitude-m or --ground-m", self.make("--focal-px", "30").stderr)
        self.assertEqual(self.make("--focal-px", "30", "--ground-m", "150").returncode, 0)
        self.assertTrue(self.rows("mav0/altimeter0/data.csv")[0].endswith(",48.300"))

    def test_refusals_leave_nothing_behind(self):
        self.photo("a1.JPG", "2016:06:23 16:31:59", 33.0, 40.0)
        self.photo("a2.JPG", "2016:06:23 16:31:59", 33.0, 40.0)
        done = self.make("--focal-px", "30")
        self.assertEqual(done.returncode, 2)
        self.assertIn("a2.JPG: not later than the photo before it", done.stderr)
        self.write("photos/a0.jpg", "no photo")
        self.assertIn("a0.jpg: has no EXIF", self.make("--focal-px", "30").stderr)
        self.assertEqual([path.name for path in self.top.iterdir()], ["photos"])


if __name__ == "__main__":
    unittest.main()
