"""Points of disparity maps: those of the command line's cloud.ply."""

import unittest

import numpy as np
from rendered_road import calibration, inspected, pair

import roadstereo


def written_cloud():
    """Points and colours of cloud.ply."""
    header, data = (inspected() / "cloud.ply").read_bytes().split(b"end_header\n", 1)
    points = np.frombuffer(data, [("points", "<f4", 3), ("colours", "u1", 3)])
    assert f"element vertex {len(points)}\n" in header.decode()
    return points["points"], points["colours"]


class Cloud(unittest.TestCase):
    def test_equals_file(self):
        disparity = roadstereo.read_disparity(inspected() / "disparity.tiff")
        found = roadstereo.cloud_from_disparity(disparity, calibration(), pair()[0])
        for array, written in zip(found, written_cloud()):
            self.assertEqual(array.tobytes(), written.tobytes())

    def test_points_by_hand(self):
        rig = roadstereo.Calibration(100, 1, 0, 0.1, disparity_offset_px=2)
        disparity = np.array([[8, np.nan, 3], [-2, -1.7, np.inf]])  # 1 m, none, 2 m, none, 33 m, none
        points, colours = roadstereo.cloud_from_disparity(disparity, rig)
        self.assertIsNone(colours)
        np.testing.assert_allclose(points, [[-0.01, 0, 1], [0.02, 0, 2]], atol=1e-6)
        points, colours = roadstereo.cloud_from_disparity(np.full((2, 2), np.nan), rig, np.zeros((2, 2), np.uint8))
        self.assertEqual((points.shape, colours.shape), ((0, 3), (0, 3)))

    def test_colour_order_and_white(self):
        rig, disparity = roadstereo.Calibration(100, 1, 0, 0.1), np.full((1, 2), 5.0)
        left = np.array([[[1, 2, 3], [4, 5, 6]]], np.uint16) * 16
        for order, expected in {"rgb": [[1, 2, 3], [4, 5, 6]], "bgr": [[3, 2, 1], [6, 5, 4]]}.items():
            colours = roadstereo.cloud_from_disparity(disparity, rig, left, order=order, white_level=4080)[1]
            np.testing.assert_array_equal(colours, expected)

    def test_refused(self):
        with self.assertRaisesRegex(roadstereo.Error, "disparity has 3 dimensions"):
            roadstereo.cloud_from_disparity(np.zeros((2, 2, 1)), calibration())
        with self.assertRaisesRegex(roadstereo.Error, "they must have the same size"):
            roadstereo.cloud_from_disparity(np.zeros((180, 320)), calibration(), pair()[0][:90])
        with self.assertRaisesRegex(roadstereo.Error, "calibration: the baseline is 100; it must be between 0.005 and 10"):
            roadstereo.cloud_from_disparity(np.zeros((2, 2)), roadstereo.Calibration(100, 1, 0, 100))
        with self.assertRaises(TypeError):
            roadstereo.cloud_from_disparity("disparity.tiff", calibration())

    def test_odd_addresses(self):
        rig, left = roadstereo.Calibration(100, 1, 0, 0.1), np.full((2, 2), 4080, np.uint16)
        odd = np.frombuffer(b" " + left.tobytes(), np.uint8)[1:].view(np.uint16).reshape(2, 2)
        colours = roadstereo.cloud_from_disparity(np.full((2, 2), 5.0), rig, odd, white_level=4080)[1]
        self.assertTrue((colours == 255).all())


if __name__ == "__main__":
    unittest.main()
