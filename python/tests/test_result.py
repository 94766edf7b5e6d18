"""The result of a pair: the numbers of the command line's files, and the lifetime of the arrays."""

import gc
import math
import pprint
import unittest

import numpy as np
from PIL import Image
from rendered_road import calibration, inspected, json_file, noise_pair, pair

import roadstereo


def process(*frames, **options):
    return roadstereo.Pipeline("default", calibration(), **options).process(*(frames or pair()))


class Numbers(unittest.TestCase):
    def test_maps_equal_files_of_inspect_bit_for_bit(self):
        result = process()
        for name in ("disparity", "sigma", "transformed"):
            written = np.asarray(Image.open(inspected() / f"{name}.tiff"))
            self.assertEqual(written.dtype, np.float32)
            self.assertEqual(getattr(result, name).tobytes(), written.tobytes(), name)
            read = roadstereo.read_disparity(inspected() / f"{name}.tiff")
            self.assertTrue(np.array_equal(read, written, equal_nan=True))

    def test_values_equal_result_json(self):
        result, written = process(), json_file("result.json")
        geometry, plane = result.geometry, result.geometry.plane
        self.assertEqual(written["road_model"], {"a0": plane.a0, "a1": plane.a1, "a2": plane.a2})
        for name in ("alpha0", "alpha1", "roll_rad", "roll_stderr_rad", "roll_observable", "residual_px"):
            self.assertEqual(getattr(geometry, name), written[name], name)
        self.assertAlmostEqual(result.roll_deg, math.degrees(written["roll_rad"]), 12)
        self.assertAlmostEqual(result.roll_stderr_deg, math.degrees(written["roll_stderr_rad"]), 12)
        self.assertEqual(result.ground_plane.height_m, written["camera_height_m"])
        self.assertEqual(result.ground_plane.pitch_rad, written["camera_pitch_rad"])
        self.assertEqual(result.delta_t, written["delta_t"])
        self.assertEqual(result.valid_share, written["valid_fraction"])
        self.assertEqual(result.shift.delta_p, written["delta_p"])
        self.assertEqual(result.shift.disparities, written["disparities"])
        self.assertEqual(result.spread.sigma_road_px, written["sigma_d_px"])
        self.assertEqual(result.spread.sigma_all_px, written["sigma_d_all_px"])
        self.assertEqual(result.spread.road_share, written["road_fraction"])
        self.assertEqual(result.rows.median_px, written["rows"]["median_px"])
        self.assertEqual(result.rows.points, written["rows"]["points"])
        self.assertEqual(result.blur.variance_px2, written["blur"]["difference_px2"])
        self.assertEqual(result.smoothed_px2, written["blur"]["smoothed_px2"])
        self.assertEqual(result.warnings, written["warnings"])

    def test_road_equals_result_json(self):
        road, written = process().road, json_file("result.json")["road"]
        self.assertEqual(written.pop("model"), {"a0": road.model.a0, "a1": road.model.a1, "a2": road.model.a2})
        self.assertEqual(road.status, "found")
        for name, value in written.items():
            self.assertEqual(getattr(road, name), value, name)

    def test_invalid_is_nan(self):
        result = process()
        valid = np.isfinite(result.disparity)
        self.assertEqual(result.valid_share, valid.mean())
        self.assertTrue(np.array_equal(valid, np.isfinite(result.sigma)))
        self.assertFalse(np.isinf(result.disparity).any())

    def test_no_roll_without_road(self):
        result = process(*noise_pair())
        self.assertEqual(result.road.status, "none")
        self.assertTrue(math.isnan(result.roll_deg) and math.isnan(result.roll_stderr_deg))
        self.assertIsNone(result.geometry)
        self.assertIsNone(result.ground_plane)
        self.assertTrue(np.isnan(result.transformed).all())
        self.assertEqual(result.transformed.shape, (180, 320))
        self.assertTrue(any("no road was found" in warning for warning in result.warnings), result.warnings)

    def test_nothing_metric_without_calibration(self):
        result = roadstereo.Pipeline().process(*pair())
        self.assertIsNone(result.calibration)
        self.assertIsNone(result.ground_plane)
        self.assertFalse(math.isnan(result.roll_deg))

    def test_plane_gives_disparities(self):
        plane = process().geometry.plane
        u, v = np.meshgrid(np.arange(3.0), np.arange(2.0))
        np.testing.assert_allclose(plane.disparity(u, v), plane.a0 + plane.a1 * v + plane.a2 * u, rtol=1e-15)
        self.assertEqual(plane.disparity(0, 0), plane.a0)


class Arrays(unittest.TestCase):
    def test_types_and_shapes(self):
        result = process()
        for name, kind in {"disparity": "f4", "sigma": "f4", "transformed": "f4", "grey": "i2"}.items():
            array = getattr(result, name)
            self.assertEqual((array.dtype, array.shape), (np.dtype(kind), (180, 320)), name)
        self.assertIsNone(result.mask)

    def test_grey_is_in_sixteenths(self):
        self.assertTrue(np.array_equal(process().grey, pair()[0].astype(np.int16) * 16))

    def test_views_share_memory(self):
        result = process()
        self.assertTrue(np.shares_memory(result.disparity, result.disparity))
        self.assertFalse(np.shares_memory(result.disparity, result.sigma))

    def test_views_are_read_only(self):
        result = process()
        with self.assertRaises(ValueError):
            result.disparity[0, 0] = 1
        with self.assertRaises(ValueError):
            result.disparity.flags.writeable = True

    def test_view_outlives_result_and_pipeline(self):
        result = process()
        disparity, slice_of_it = result.disparity, result.disparity[10:20, ::2]
        copied, copied_slice = disparity.tobytes(), slice_of_it.tobytes()
        del result
        gc.collect()
        self.assertEqual(disparity.tobytes(), copied)
        del disparity
        others = [process(*noise_pair()) for _ in range(4)]
        gc.collect()
        self.assertEqual(slice_of_it.tobytes(), copied_slice)
        del others

    def test_part_outlives_result(self):
        plane = process().geometry.plane
        expected = (plane.a0, plane.a1, plane.a2)
        gc.collect()
        process(*noise_pair())
        self.assertEqual((plane.a0, plane.a1, plane.a2), expected)

    def test_next_pair_leaves_result(self):
        pipeline = roadstereo.Pipeline("default", calibration())
        first = pipeline.process(*pair())
        disparity, text = first.disparity.tobytes(), repr(first.geometry)
        pipeline.process(*noise_pair())
        self.assertEqual(first.disparity.tobytes(), disparity)
        self.assertEqual(repr(first.geometry), text)

    def test_repr_lists_attributes(self):
        result = process()
        self.assertEqual(repr(result), "FrameResult(320×180 pixels, road found)")
        plane = result.geometry.plane
        self.assertEqual(repr(plane), f"DisparityPlane(a0={plane.a0!r}, a1={plane.a1!r}, a2={plane.a2!r})")

    def test_pprint_prints_attributes(self):
        geometry = process().geometry
        self.assertEqual(pprint.pformat([geometry]), f"[{geometry!r}]")


if __name__ == "__main__":
    unittest.main()
