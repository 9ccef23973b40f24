"""Contrast of the colours of docs/site/style.css: scripts/reproduce.sh --test"""

import colorsys
import re
import unittest
from pathlib import Path

STYLE = Path(__file__).resolve().parents[2] / "docs/site/style.css"
LEAST = 4.5  # WCAG 2.1, 1.4.3
WHITE = (1.0, 1.0, 1.0)
SLATE = colorsys.hls_to_rgb(232 / 360, 0.21, 0.15)  # the ground of the dark theme
TINT = {"light": (0.96,) * 3, "dark": colorsys.hls_to_rgb(232 / 360, 0.15, 0.15)}  # of code


def luminance(colour):
    red, green, blue = (one / 12.92 if one <= 0.04045 else ((one + 0.055) / 1.055) ** 2.4
                        for one in colour)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(a, b):
    high, low = sorted((luminance(a), luminance(b)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def colours_of(block):
    return {name: tuple(int(value[i:i + 2], 16) / 255 for i in (0, 2, 4))
            for name, value in re.findall(r"--md-([\w-]+): #(\w{6});", block)}


class Style(unittest.TestCase):
    def test_links_and_header_have_contrast(self):
        light, dark = map(colours_of, re.findall(r'primary="teal"\] \{(.*?)\}',
                                                 STYLE.read_text("utf-8"), re.DOTALL))
        self.assertGreater(contrast(light["primary-fg-color"], WHITE), LEAST)
        for colours, grounds in ((light, (WHITE, TINT["light"])), (dark, (SLATE, TINT["dark"]))):
            for name in ("typeset-a-color", "accent-fg-color"):
                for ground in grounds:
                    self.assertGreater(contrast(colours[name], ground), LEAST, name)

    def test_contrast_is_that_of_the_standard(self):
        self.assertAlmostEqual(contrast(WHITE, (0, 0, 0)), 21)
        self.assertAlmostEqual(contrast(WHITE, (119 / 255,) * 3), 4.48, places=2)


if __name__ == "__main__":
    unittest.main()
