"""The examples, with the road that the command line tool renders."""

import os
import pathlib
import subprocess
import sys
import unittest

from PIL import Image
from rendered_road import FOLDER, json_file, road

EXAMPLES = pathlib.Path(__file__).resolve().parent.parent / "examples"


class Example(unittest.TestCase):
    def test_prints_damage_and_draws(self):
        command = [sys.executable, EXAMPLES / "road_damage.py", road(), FOLDER / "damage.png"]
        without_screen = {**os.environ, "MPLBACKEND": "Agg"}
        done = subprocess.run(command, check=True, capture_output=True, text=True, env=without_screen)
        self.assertEqual(done.stderr, "")
        for damage in json_file("damages.json")["damages"]:
            depth, error = 1000 * damage["max_depth_m"], 1000 * damage["max_depth_m_stderr"]
            self.assertIn(f"{damage['id']} {damage['kind']}: {depth:.0f} ± {error:.0f} mm", done.stdout)
        self.assertEqual(Image.open(FOLDER / "damage.png").size, (1100, 700))

    def test_throughput(self):
        files = [road() / name for name in ("left.png", "right.png", "calibration.yaml")]
        command = [sys.executable, EXAMPLES / "throughput.py", *files, "2"]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        self.assertRegex(done.stdout, r"^one pipeline: [\d.]+ pairs/s, two: [\d.]+ pairs/s, [\d.]+ times as many\n$")


if __name__ == "__main__":
    unittest.main()
