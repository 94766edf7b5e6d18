"""Options by the keys of --set."""

import unittest

import numpy as np
from rendered_road import json_file, pair

import roadstereo


class Options(unittest.TestCase):
    def test_defaults_equal_those_of_command_line(self):
        self.assertEqual(roadstereo.Pipeline().options, json_file("result.json")["options"])

    def test_mapping_and_keywords(self):
        pipeline = roadstereo.Pipeline(
            "fast",
            threads=2,
            engine="reference",
            options={"matcher.block_radius": 3, "matcher.sigma_space": 2.5, "roll.solver": "closed_form"},
            **{"check_rows": False, "damage.min_depth_m": 1e-5},
        )
        expected = {
            "threads": 2,
            "engine": "reference",
            "matcher.block_radius": 3,
            "matcher.sigma_space": 2.5,
            "roll.solver": "closed_form",
            "check_rows": False,
            "damage.min_depth_m": 1e-5,
        }
        self.assertEqual({key: pipeline.options[key] for key in expected}, expected)
        self.assertEqual(pipeline.engine_name, "reference")
        self.assertIs(pipeline.options["check_rows"], False)

    def test_type_is_that_of_option(self):
        options = roadstereo.Pipeline(white_level=4095, **{"matcher.prior_weight": 0.5}).options
        for key in ("white_level", "matcher.prior_weight", "damage.max_depth_m"):
            self.assertIs(type(options[key]), float, key)
        self.assertIs(type(options["threads"]), int)
        self.assertIs(type(roadstereo.Pipeline(white_level=0).options["white_level"]), float)

    def test_numpy_scalars(self):
        given = {"threads": np.int64(2), "check_rows": np.bool_(False), "matcher.sigma_space": np.float64(0.1 + 0.2)}
        options = roadstereo.Pipeline(options={**given, "matcher.sigma_colour": np.float32(2.5)}).options
        self.assertEqual({key: options[key] for key in given}, given)
        self.assertEqual(options["matcher.sigma_colour"], 2.5)

    def test_option_has_effect(self):
        without = roadstereo.Pipeline("fast", options={"matcher.sub_pixel": "off", "refinement.radius": 0})
        with_sub_pixel = roadstereo.Pipeline("fast", options={"refinement.radius": 0})
        maps = [pipeline.process(*pair()).disparity for pipeline in (without, with_sub_pixel)]
        self.assertFalse(np.array_equal(*maps, equal_nan=True))

    def refuse(self, sentence, kind=roadstereo.Error, **arguments):
        with self.assertRaisesRegex(kind, sentence):
            roadstereo.Pipeline(**arguments)

    def test_unknown_key_suggests_nearest(self):
        self.refuse("^there is no option called 'thread'; the nearest is 'threads'$", thread=2)
        self.refuse("the nearest is 'matcher.block_radius'", options={"matcher.block_radios": 2})

    def test_bad_values(self):
        self.refuse("'2.0' is not a valid value of threads; it takes a whole number", threads=2.0)
        self.refuse("'yep' is not a valid value of check_rows; it takes true or false", check_rows="yep")
        self.refuse("matcher.sigma_space", options={"matcher.sigma_space": float("nan")})
        self.refuse("block_radius", options={"matcher.block_radius": 99})
        self.refuse("engine", engine="gpu")
        self.refuse("'quick'", preset="quick")
        self.refuse("^the option 'threads' is of type list; it must be", TypeError, threads=[2])
        self.refuse("", TypeError, options=3)

    def test_descriptions(self):
        descriptions = roadstereo.describe_options()
        self.assertEqual(set(descriptions), set(roadstereo.Pipeline().options))
        self.assertIn("pixels", descriptions["matcher.block_radius"])

    def test_presets_and_engines(self):
        self.assertEqual(roadstereo.preset_names(), ["default", "fast", "paper"])
        self.assertIn("cpu", roadstereo.engine_names())


if __name__ == "__main__":
    unittest.main()
