"""Arrays as frames: every layout that needs no copy, and a sentence for the others."""

import unittest

import numpy as np
from rendered_road import pair

import roadstereo

BGR = np.array([0.114, 0.587, 0.299])  # Rec. 601 luma


def process(left, right, **keywords):
    return roadstereo.Pipeline("fast").process(left, right, **keywords)


def colour(frame):
    """A BGR frame whose channels differ."""
    return np.stack([frame, frame // 2, 255 - frame], axis=-1)


def luma(frame):
    """Sixteenths of a grey level; rounding may differ by one."""
    return frame[..., :3] @ BGR * 16


class Layouts(unittest.TestCase):
    def setUp(self):
        self.left, self.right = pair()
        self.expected = process(self.left, self.right)

    def check(self, left, right, expected=None, **keywords):
        result = process(left, right, **keywords)
        expected = expected or self.expected
        self.assertTrue(np.array_equal(result.grey, expected.grey))
        self.assertEqual(result.disparity.tobytes(), expected.disparity.tobytes())

    def test_halves_of_one_image(self):
        both = np.hstack([self.left, self.right])
        self.check(both[:, :320], both[:, 320:])

    def test_rows_of_both_views_in_turn(self):
        both = np.stack([self.left, self.right], axis=1)
        self.check(both[:, 0], both[:, 1])

    def test_rows_from_bottom_to_top(self):
        self.check(self.left[::-1].copy()[::-1], self.right[::-1].copy()[::-1])

    def test_third_dimension_of_one(self):
        self.check(self.left[..., np.newaxis], self.right[..., np.newaxis])

    def test_read_only(self):
        left, right = np.frombuffer(self.left.tobytes(), np.uint8), np.frombuffer(self.right.tobytes(), np.uint8)
        self.check(left.reshape(180, 320), right.reshape(180, 320))

    def test_samples_of_16_bits(self):
        self.check(self.left.astype(np.uint16) * 257, self.right.astype(np.uint16) * 257)

    def test_part_of_larger_frame_of_16_bits(self):
        frames = [np.pad(frame.astype(np.uint16) * 257, 5)[5:-5, 5:-5] for frame in (self.left, self.right)]
        self.check(*frames)

    def test_colour_orders(self):
        left, right = colour(self.left), colour(self.right)
        expected = process(left, right)
        np.testing.assert_allclose(expected.grey, luma(left), atol=0.51)
        self.check(left[..., ::-1].copy(), right[..., ::-1].copy(), expected, order="rgb")
        self.check(left[..., ::-1], right[..., ::-1], expected, order="rgb")
        swapped = process(left, right, order="rgb")
        np.testing.assert_allclose(swapped.grey, luma(left[..., ::-1]), atol=0.51)

    def test_four_channels(self):
        alpha = np.random.default_rng(1).integers(0, 256, (180, 320, 1), dtype=np.uint8)
        left, right = colour(self.left), colour(self.right)
        with_alpha = [np.concatenate([frame, alpha], axis=-1) for frame in (left, right)]
        self.check(*with_alpha, process(left, right))
        self.check(*with_alpha, process(left, right, order="rgb"), order="rgb")

    def test_grey_and_colour(self):
        result = process(self.left, np.stack([self.right] * 3, axis=-1))
        np.testing.assert_allclose(result.grey, self.left * 16.0)


class Refused(unittest.TestCase):
    def setUp(self):
        self.left, self.right = pair()

    def refuse(self, kind, sentence, left, right=None, **keywords):
        with self.assertRaisesRegex(kind, sentence):
            process(left, self.right if right is None else right, **keywords)

    def test_other_types(self):
        for other in (self.left.tolist(), memoryview(self.left), None, "left.png"):
            self.refuse(TypeError, "^left is of type .*; it must be a numpy array of uint8 or uint16$", other)
        self.refuse(TypeError, "^right is of type list", self.left, [[1, 2]])

    def test_other_samples(self):
        for sample in (np.float32, np.int8, np.int16, np.uint32, np.bool_, np.complex64, "U1"):
            sentence = "^left has samples of type .*; they must be uint8 or uint16"
            self.refuse(TypeError, sentence, self.left.astype(sample))
        self.refuse(TypeError, "swapped bytes", self.left.astype(np.dtype(np.uint16).newbyteorder()))

    def test_other_shapes(self):
        for shape in ((180 * 320,), (180, 160, 2), (10, 18, 320, 1), ()):
            frame = self.left.reshape(shape) if shape else self.left[0, 0, ...]
            self.refuse(roadstereo.Error, r"^left has the shape \(.*\); it must be \(height, width\)", frame)

    def test_rows_that_are_not_adjacent(self):
        planes = np.moveaxis(np.stack([self.left] * 3), 0, -1)
        for frame in (np.asfortranarray(self.left), self.left[:, ::-1], self.left.repeat(2, axis=1)[:, ::2], planes):
            self.refuse(roadstereo.Error, "^left has the strides .*numpy.ascontiguousarray", frame)
        self.refuse(roadstereo.Error, "strides", colour(self.left)[..., 1:3].repeat(2, axis=-1)[..., :3])

    def test_rows_that_overlap(self):
        self.refuse(roadstereo.Error, "rows are 0 bytes apart", np.broadcast_to(self.left[:1], (180, 320)))

    def test_odd_addresses(self):
        odd = np.zeros(180 * 320 * 2 + 1, np.uint8)[1:].view(np.uint16).reshape(180, 320)
        self.refuse(roadstereo.Error, "odd address", odd, odd)

    def test_sizes(self):
        self.refuse(roadstereo.Error, "a pair must have one size", self.left[1:])
        small = self.left[:31, :31]
        self.refuse(roadstereo.Error, "31×31 pixels; it must have between 32×32", small, small)
        for shape in ((0, 0), (0, 320), (180, 0)):
            empty = np.zeros(shape, np.uint8)
            self.refuse(roadstereo.Error, "", empty, empty)
        huge = np.lib.stride_tricks.as_strided(self.left, (2**33, 320), (0, 1))
        self.refuse(roadstereo.Error, "pixels", huge, huge)

    def test_invalid_pairs(self):
        self.refuse(roadstereo.Error, "same", self.left, self.left)
        self.refuse(roadstereo.Error, "swapped", self.right, self.left)
        self.refuse(roadstereo.Error, "", np.zeros_like(self.left))

    def test_order(self):
        self.refuse(roadstereo.Error, "^order is 'gbr'; it must be 'bgr' or 'rgb'$", self.left, order="gbr")

    def test_pipeline_goes_on_after_error(self):
        pipeline = roadstereo.Pipeline("fast")
        with self.assertRaises(roadstereo.Error):
            pipeline.process(self.left, self.left)
        self.assertEqual(pipeline.process(self.left, self.right).road.status, "found")


class Files(unittest.TestCase):
    def test_frames_are_bgr(self):
        import tempfile

        from PIL import Image

        rgb = np.random.default_rng(2).integers(0, 256, (40, 50, 3), dtype=np.uint8)
        with tempfile.TemporaryDirectory() as folder:
            for name in ("a.png", "a.ppm", "a.tiff"):
                Image.fromarray(rgb).save(f"{folder}/{name}")
                read = roadstereo.read_frame(f"{folder}/{name}")
                self.assertTrue(np.array_equal(read[..., ::-1], rgb), name)
                read[0, 0] = 7  # it is the caller's
            with self.assertRaisesRegex(roadstereo.Error, "no.png"):
                roadstereo.read_frame(f"{folder}/no.png")

    def test_white_level(self):
        frame = np.full((40, 40), 1023, np.uint16)
        self.assertEqual(roadstereo.find_white_level(frame, frame), 1023)
        self.assertEqual(roadstereo.find_white_level(frame, frame + 1), 4095)


if __name__ == "__main__":
    unittest.main()
