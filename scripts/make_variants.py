#!/usr/bin/env python3
"""Makes variants of labelled pairs: what another camera, light or lens would have shown of the same road.

scripts/make_variants.py DIR OUTPUT

DIR is laid out as KITTI Stereo 2015 with masks of the road in road/. Writes OUTPUT/<variant>/ of the same layout for every
variant; `roadstereo evaluate robustness OUTPUT --scenes 0` takes them all. Nothing may be fitted to them.
"""
import io
import pathlib
import sys

import numpy as np
from PIL import Image, ImageFilter

FOLDERS = ("image_2", "image_3", "disp_noc_0", "road")


def grey_levels(values):
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)


def mirror(left, right, disparity, road):
    """The right camera becomes the left one; of two points in one pixel the nearer one is seen."""
    order = np.argsort(disparity[disparity > 0])
    v, u = (index[order] for index in np.nonzero(disparity))
    d = disparity[v, u]
    seen = np.rint(u - d).astype(int)
    v, u, d, seen = (array[seen >= 0] for array in (v, u, d, seen))
    disparity_right, road_right = np.zeros_like(disparity), np.zeros_like(road)
    disparity_right[v, seen], road_right[v, seen] = d, road[v, u]
    return tuple(array[:, ::-1] for array in (right, left, disparity_right, road_right))


def scaled(factor):
    def change(left, right, disparity, road):
        height, width = disparity.shape
        size = int(width * factor), int(height * factor)
        rows, columns = (((np.arange(n) + 0.5) / factor).astype(int) for n in size[::-1])
        images = (np.asarray(Image.fromarray(image).resize(size, Image.LANCZOS)) for image in (left, right))
        return *images, disparity[rows][:, columns] * (size[0] / width), road[rows][:, columns]

    return change


def cropped(top, bottom, first, last):
    """Shares of the height and the width. What the right picture does not show any more has no truth."""

    def change(*arrays):
        height, width = arrays[2].shape
        part = slice(int(top * height), int(bottom * height)), slice(int(first * width), int(last * width))
        left, right, disparity, road = (array[part] for array in arrays)
        seen = np.arange(disparity.shape[1]) - disparity >= 0
        return left, right, np.where(seen, disparity, 0), road

    return change


def seen(of_left, of_right=None):
    """What cameras do to their pictures."""
    return lambda left, right, *truth: (of_left(left), (of_right or of_left)(right), *truth)


def tone(gamma, gain=1.0, offset=0.0):
    return lambda image: grey_levels(gain * 255 * (image / 255.0) ** gamma + offset)


def noise(generator, deviation, contrast=1.0, offset=0.0):
    return lambda image: grey_levels(contrast * image + offset + generator.normal(0, deviation, image.shape))


def blurred(image):
    return np.asarray(Image.fromarray(image).filter(ImageFilter.GaussianBlur(1.6)))


def defocused(generator, radius):
    """By the lens; the noise of the sensor is as sharp as before."""
    noisy = noise(generator, 1)
    return lambda image: noisy(np.asarray(Image.fromarray(image).filter(ImageFilter.GaussianBlur(radius)), float))


def compressed(image):
    memory = io.BytesIO()
    Image.fromarray(image).save(memory, "JPEG", quality=30)
    return np.asarray(Image.open(memory))


def rows_off(image):
    picture = Image.fromarray(image)
    return np.asarray(picture.transform(picture.size, Image.AFFINE, (1, 0, 0, 0, 1, -0.7), Image.BICUBIC))


def variants(generator):
    return {
        "mirrored": mirror,
        "half size": scaled(0.5),
        "0.7 of the size": scaled(0.7),
        "left part": cropped(0, 1, 0, 0.6),
        "middle": cropped(0, 1, 0.25, 0.75),
        "right part": cropped(0, 1, 0.4, 1),
        "without the lower quarter": cropped(0, 0.75, 0, 1),
        "lower half": cropped(0.5, 1, 0, 1),
        "dark": seen(tone(2.2), tone(2.2, 0.8, 8)),
        "bright": seen(tone(0.45), tone(0.5)),
        "noise of 6": seen(noise(generator, 6)),
        "noise of 12": seen(noise(generator, 12)),
        "a third of the contrast": seen(noise(generator, 1.5, 0.3, 40), noise(generator, 1.5, 0.3, 48)),
        "blurred": seen(blurred),
        "blurred on one side": seen(blurred, lambda image: image),
        "right lens defocused by 1 px": seen(lambda image: image, defocused(generator, 1)),
        "right lens defocused by 2 px": seen(lambda image: image, defocused(generator, 2)),
        "JPEG 30": seen(compressed),
        "rows 0.7 px off": seen(lambda image: image, rows_off),
    }


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    source, output = map(pathlib.Path, sys.argv[1:])
    names = sorted(path.name for path in (source / FOLDERS[0]).glob("*.png"))
    if not names:
        sys.exit(f"{source / FOLDERS[0]}: the folder contains no image")
    for variant, change in variants(np.random.default_rng(5)).items():
        folders = [output / variant / folder for folder in FOLDERS]
        for folder in folders:
            folder.mkdir(parents=True, exist_ok=True)
        for name in names:
            left, right, disparity, road = (np.asarray(Image.open(source / folder / name)) for folder in FOLDERS)
            changed = list(change(left, right, disparity / 256.0, road))
            changed[2] = np.rint(256 * changed[2]).astype(np.uint16)
            for folder, array in zip(folders, changed):
                Image.fromarray(np.ascontiguousarray(array)).save(folder / name, compress_level=1)


if __name__ == "__main__":
    main()
