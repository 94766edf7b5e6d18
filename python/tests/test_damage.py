"""Damage: the values of the command line's files, options, lifetime of the arrays."""

import gc
import math
import unittest

import numpy as np
from PIL import Image
from rendered_road import calibration, inspected, json_file, noise_pair, pair

import roadstereo


def process(*frames, **options):
    return roadstereo.Pipeline("default", calibration(), **options).process(*(frames or pair()))


def columns(damage):
    """The damage as a row of damages.json."""
    metrics, evidence = damage.metrics, damage.evidence
    row = {"severity": metrics.severity, "angle_deg": round(math.degrees(metrics.angle_rad), 9)}
    for name in ("id", "kind", "confidence", "pixels", "measured_share", "mean_depth_px", "cut_by_border",
                 "ends_search"):
        row[name] = getattr(damage, name)
    for name in ("contrast_sigmas", "significance", "steepness", "road_share", "border_share", "unseen_share",
                 "surface_significance", "range_vote", "specular_excess", "texture_share", "pixel_significance",
                 "likely_wall_slope", "extent", "rut_significance", "clutter", "depth_significance"):
        value = getattr(evidence, name)
        row[name] = None if math.isnan(value) else value  # a protrusion has no likely slope
    for name in ("length_m", "width_m", "diameter_m", "distance_m", "resolvable_depth_m", "wall_slope", "quantity",
                 "distress", "unit", "severity_range"):
        row[name] = getattr(metrics, name)
    for name in ("minor", "low", "medium", "high"):
        row[f"p_{name}"] = getattr(metrics.severity_probabilities, name)
    for name in ("area_m2", "max_depth_m", "mean_depth_m", "volume_m3"):
        row[name] = getattr(metrics, name).value
        row[f"{name}_stderr"] = getattr(metrics, name).std_error
    row["max_depth_px"] = damage.max_depth_px.value
    row["max_depth_px_stderr"] = damage.max_depth_px.std_error
    row["centroid_u_px"], row["centroid_v_px"] = damage.centroid_px
    row["deepest_u_px"], row["deepest_v_px"] = damage.deepest_px
    row["box_u0_px"], row["box_v0_px"], row["box_u1_px"], row["box_v1_px"] = damage.box_px
    row["centroid_x_m"], row["centroid_y_m"], row["centroid_z_m"] = metrics.centroid_m
    row["road_x_m"], row["road_y_m"] = metrics.road_centroid_m
    return row


class Damage(unittest.TestCase):
    def test_values_equal_damages_json(self):
        found, written = roadstereo.find_damage(process()), json_file("damages.json")
        self.assertGreater(len(found.damages), 0)
        for name in ("damages", "candidates"):
            for row in written[name]:
                row["angle_deg"] = round(row["angle_deg"], 9)
            self.assertEqual([columns(damage) for damage in getattr(found, name)], written[name])
        self.assertEqual(found.noise_px, written["noise_px"])
        self.assertTrue(found.metric)
        self.assertEqual(found.non_metric_reason, "")

    def test_ids_equal_damage_png(self):
        found = roadstereo.find_damage(process())
        self.assertTrue(np.array_equal(found.ids, np.asarray(Image.open(inspected() / "damage.png"))))
        for damage in found.damages:
            self.assertEqual(np.count_nonzero(found.ids == damage.id), damage.pixels)
            u, v = damage.deepest_px
            self.assertEqual(found.ids[v, u], damage.id)

    def test_maps(self):
        found = roadstereo.find_damage(process())
        for name, kind in {"ids": "u2", "road": "u1", "surface": "f4", "depth": "f4"}.items():
            array = getattr(found, name)
            self.assertEqual((array.dtype, array.shape), (np.dtype(kind), (180, 320)), name)
            self.assertFalse(array.flags.writeable)
        self.assertEqual(set(np.unique(found.road)), {0, 255})
        self.assertTrue(np.isnan(found.depth).any())

    def test_options(self):
        result = process()
        every = roadstereo.find_damage(result, options={"damage.min_confidence": 0})
        usual = roadstereo.find_damage(result, threads=1)
        self.assertGreaterEqual(len(every.damages), len(usual.damages))
        none = roadstereo.find_damage(result, options={"damage.min_area_m2": 1e4})
        self.assertEqual(none.damages, [])
        with self.assertRaisesRegex(roadstereo.Error, "the nearest is 'damage.min_confidence'"):
            roadstereo.find_damage(result, options={"damage.min_confidense": 0})
        with self.assertRaisesRegex(roadstereo.Error, "min_confidence"):
            roadstereo.find_damage(result, options={"damage.min_confidence": 2})
        with self.assertRaisesRegex(roadstereo.Error, "matcher.block_radius.* has no effect"):
            roadstereo.find_damage(result, options={"matcher.block_radius": 3})
        as_array = roadstereo.find_damage(result, options={"damage.min_confidence": np.array(0.3)})
        as_number = roadstereo.find_damage(result, options={"damage.min_confidence": 0.3})
        self.assertEqual(len(as_array.damages), len(as_number.damages))
        with self.assertRaises(TypeError):
            roadstereo.find_damage(result.disparity)

    def test_options_of_pipeline_hold(self):
        result = process(options={"damage.min_area_m2": 1e4})
        self.assertEqual(roadstereo.find_damage(result).damages, [])

    def test_pixels_without_calibration(self):
        found = roadstereo.find_damage(roadstereo.Pipeline().process(*pair()))
        self.assertFalse(found.metric)
        self.assertIn("calibration", found.non_metric_reason)
        self.assertTrue(found.damages and all(damage.metrics is None for damage in found.damages))

    def test_nothing_without_road(self):
        found = roadstereo.find_damage(process(*noise_pair()))
        self.assertEqual((found.damages, found.candidates), ([], []))
        self.assertEqual(found.non_metric_reason, "no road was found")

    def test_parts_outlive_map(self):
        found = roadstereo.find_damage(process())
        deepest, depth = found.damages[0], found.depth
        expected = columns(deepest), depth.tobytes()
        del found
        gc.collect()
        roadstereo.find_damage(process())
        self.assertEqual((columns(deepest), depth.tobytes()), expected)


if __name__ == "__main__":
    unittest.main()
