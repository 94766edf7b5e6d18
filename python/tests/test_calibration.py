"""Calibrations: files, values, rigs that are not rectified."""

import math
import pathlib
import tempfile
import unittest

import numpy as np
from rendered_road import calibration, pair, road

import roadstereo

OPENCV = """%YAML:1.0
---
K1: !!opencv-matrix {rows: 3, cols: 3, dt: d, data: [300., 0., 159.5, 0., 310., 89.5, 0., 0., 1.]}
D1: !!opencv-matrix {rows: 1, cols: 4, dt: d, data: [0.01, 0.002, 0., 0.]}
K2: !!opencv-matrix {rows: 3, cols: 3, dt: d, data: [300., 0., 159.5, 0., 310., 89.5, 0., 0., 1.]}
D2: !!opencv-matrix {rows: 1, cols: 4, dt: d, data: [0., 0., 0., 0.]}
R: !!opencv-matrix {rows: 3, cols: 3, dt: d, data: [1., 0., 0., 0., 1., 0., 0., 0., 1.]}
T: !!opencv-matrix {rows: 3, cols: 1, dt: d, data: [-0.25, 0., 0.]}
"""


def ideal_rig(**size):
    """Two equal pinhole cameras side by side: rectification changes nothing."""
    matrix = [[300, 0, 159.5], [0, 300, 89.5], [0, 0, 1]]
    return roadstereo.StereoRig(matrix, [], matrix, [], np.eye(3), [-0.25, 0, 0], **size)


class Rectified(unittest.TestCase):
    def test_file_has_values_of_its_lines(self):
        lines = (road() / "calibration.yaml").read_text(encoding="utf-8").splitlines()
        written = dict(line.split(": ") for line in lines if not line.startswith("#"))
        read = calibration()
        for name, value in written.items():
            self.assertEqual(getattr(read, name), float(value), name)
        self.assertEqual(read.disparity_offset_px, 0)

    def test_depth_and_point(self):
        rig = roadstereo.Calibration(500, 320, 240, baseline_m=0.2, disparity_offset_px=5)
        self.assertEqual(rig.depth_m(15), 500 * 0.2 / 20)
        depths = rig.depth_m(np.array([[15, 45], [np.nan, 5]], np.float32))
        np.testing.assert_array_equal(depths, [[5, 2], [np.nan, 10]])
        self.assertEqual(rig.point_m(420, 190, 15), [1.0, -0.5, 5.0])
        self.assertIn("baseline_m=0.2", repr(rig))

    def test_attributes_are_read_only(self):
        with self.assertRaises(AttributeError):
            calibration().focal_px = 3

    def test_wrong_calibrations(self):
        small = roadstereo.Calibration(300, 80, 45, 0.25, width=160, height=90)
        with self.assertRaisesRegex(roadstereo.Error, "is for 160×90 pixels, but the images have 320×180"):
            roadstereo.Pipeline(calibration=small).process(*pair())
        millimetres = roadstereo.Calibration(300, 160, 90, 250)
        with self.assertRaisesRegex(roadstereo.Error, "baseline is 250; it must be between 0.005 and 10 metres"):
            roadstereo.Pipeline(calibration=millimetres).process(*pair())
        with self.assertRaisesRegex(TypeError, "^calibration is of type str; it must be a Calibration or None$"):
            roadstereo.Pipeline(calibration="calibration.yaml")

    def test_missing_file(self):
        with self.assertRaisesRegex(roadstereo.Error, "no/such.yaml"):
            roadstereo.read_calibration(pathlib.Path("no/such.yaml"))


class Unrectified(unittest.TestCase):
    def test_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "rig.yaml")
            path.write_text(OPENCV, encoding="utf-8")
            rig = roadstereo.read_calibration(path)
        self.assertIsInstance(rig, roadstereo.StereoRig)
        np.testing.assert_array_equal(rig.left_matrix, [[300, 0, 159.5], [0, 310, 89.5], [0, 0, 1]])
        self.assertEqual(rig.left_distortion[:2], [0.01, 0.002])
        self.assertEqual(rig.translation_m, [-0.25, 0, 0])
        with self.assertRaisesRegex(roadstereo.Error, "Rectifier"):
            roadstereo.Pipeline(calibration=rig)

    def test_size_of_several(self):
        seed = pathlib.Path(__file__).parents[2] / "tests/fuzz/seeds/calibration/zed"
        rig = roadstereo.read_calibration(seed, size=(1280, 720))
        self.assertIsInstance(rig, roadstereo.StereoRig)
        with self.assertRaisesRegex(roadstereo.Error, "give one of them as size: .*1280×720"):
            roadstereo.read_calibration(seed)
        with self.assertRaisesRegex(roadstereo.Error, "640×480"):
            roadstereo.read_calibration(seed, size=(640, 480))

    def test_size_of_one(self):
        path = road() / "calibration.yaml"
        self.assertEqual(roadstereo.read_calibration(path, size=(320, 180)).width, 320)
        with self.assertRaisesRegex(roadstereo.Error, "is for 320×180 pixels; size is 640×360"):
            roadstereo.read_calibration(path, size=(640, 360))

    def test_ideal_rig_is_rectified_already(self):
        left, right = pair()
        rectifier = roadstereo.Rectifier(ideal_rig(), 320, 180)
        self.assertEqual(rectifier.calibration.baseline_m, 0.25)
        scale = rectifier.calibration.focal_px / 300  # no black borders: a little is cut off
        self.assertTrue(1 <= scale < 1.05, scale)
        for frame, rectified in zip((left, right), rectifier.rectify(left, right)):
            self.assertEqual((rectified.shape, rectified.dtype), (frame.shape, frame.dtype))
        colour = [np.stack([frame, frame // 2, frame // 4], axis=-1) for frame in (left, right)]
        bgr = rectifier.rectify(*colour)
        rgb = rectifier.rectify(colour[0][..., ::-1], colour[1][..., ::-1], order="rgb")
        self.assertTrue(np.array_equal(bgr, rgb))

    def test_pixel_maps_to_same_ray(self):
        left, right = pair()
        rectifier = roadstereo.Rectifier(ideal_rig(), 320, 180)
        columns = np.broadcast_to(np.arange(320, dtype=np.uint16) * 100, (180, 320)).copy()
        rectified = rectifier.rectify(columns, columns)[0]
        found = rectifier.calibration
        u = np.arange(20, 300)
        true = (u - found.cx_px) / found.focal_px * 300 + 159.5
        np.testing.assert_allclose(rectified[90, 20:300] / 100, true, atol=0.05)
        self.assertFalse(math.isnan(found.cy_px))

    def test_bad_rigs(self):
        matrix = np.eye(3)
        with self.assertRaisesRegex(roadstereo.Error, "^left_matrix has 4 values; it must have 9$"):
            roadstereo.StereoRig(np.eye(2), [], matrix, [], matrix, [-1, 0, 0])
        with self.assertRaisesRegex(roadstereo.Error, "1280"):
            roadstereo.Rectifier(ideal_rig(width=1280, height=720), 320, 180)
        with self.assertRaises(roadstereo.Error):
            roadstereo.Rectifier(ideal_rig(), 320, 180).rectify(pair()[0][1:], pair()[1][1:])


if __name__ == "__main__":
    unittest.main()
