"""The example, with the road that the command line tool renders."""

import os
import pathlib
import subprocess
import sys
import unittest

from PIL import Image
from rendered_road import FOLDER, json_file, road

EXAMPLE = pathlib.Path(__file__).resolve().parent.parent / "examples" / "road_damage.py"


class Example(unittest.TestCase):
    def test_prints_damage_and_draws(self):
        command = [sys.executable, EXAMPLE, road(), FOLDER / "damage.png"]
        without_screen = {**os.environ, "MPLBACKEND": "Agg"}
        done = subprocess.run(command, check=True, capture_output=True, text=True, env=without_screen)
        self.assertEqual(done.stderr, "")
        for damage in json_file("damages.json")["damages"]:
            depth, error = 1000 * damage["max_depth_m"], 1000 * damage["max_depth_m_stderr"]
            self.assertIn(f"{damage['id']} {damage['kind']}: {depth:.0f} ± {error:.0f} mm", done.stdout)
        self.assertEqual(Image.open(FOLDER / "damage.png").size, (1100, 700))


if __name__ == "__main__":
    unittest.main()
