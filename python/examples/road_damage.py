"""The damage of one stereo pair: numbers, and a figure of four panels.

    roadstereo synth --scene demo --output demo
    python3 road_damage.py demo damage.png

The cells (# %%) run one by one in editors that know notebooks.
"""

# %% A pair and its calibration
import pathlib
import sys

import matplotlib
import matplotlib.pyplot as plt
import numpy as np

import roadstereo

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "demo")
left = roadstereo.read_frame(folder / "left.png")
right = roadstereo.read_frame(folder / "right.png")
calibration = roadstereo.read_calibration(folder / "calibration.yaml")
if isinstance(calibration, roadstereo.StereoRig):  # cameras whose rows do not agree yet
    rectifier = roadstereo.Rectifier(calibration, left.shape[1], left.shape[0])
    left, right = rectifier.rectify(left, right)
    calibration = rectifier.calibration

# %% Disparities and the road
pipeline = roadstereo.Pipeline("default", calibration)
result = pipeline.process(left, right)
print(f"road: {result.road.status}, roll {result.roll_deg:.3f}° ± {result.roll_stderr_deg:.3f}°")
print(f"disparities: {100 * result.valid_share:.1f} %, median error {np.nanmedian(result.sigma):.3f} px")
for warning in result.warnings:
    print("warning:", warning)

# %% Damage
damage = roadstereo.find_damage(result)
for found in damage.damages:
    if found.metrics is not None:
        depth, area = found.metrics.max_depth_m, found.metrics.area_m2
        print(
            f"{found.id} {found.kind}: {1000 * depth.value:.0f} ± {1000 * depth.std_error:.0f} mm, "
            f"{area.value:.3f} ± {area.std_error:.3f} m², {found.metrics.severity}"
        )

# %% Figure
if len(sys.argv) > 2:
    matplotlib.use("Agg")
figure, axes = plt.subplots(2, 2, figsize=(11, 7), constrained_layout=True)
unit = 1000 if damage.metric else 1
shown = [
    (result.disparity, "disparity, px", "viridis"),
    (result.sigma, "standard error, px", "magma"),
    (unit * damage.depth, "depth, mm" if damage.metric else "depth, px", "RdBu"),
]
axes[0, 0].imshow(result.grey, cmap="gray")
axes[0, 0].set_title("left image and damage")
for found in damage.damages:
    axes[0, 0].contour(damage.ids == found.id, levels=[0.5], colors="orange")
    u, v = found.centroid_px
    axes[0, 0].text(u, v, str(found.id), color="orange")
for panel, (values, title, colours) in zip(axes.flat[1:], shown):
    image = panel.imshow(values, cmap=colours)
    panel.set_title(title)
    figure.colorbar(image, ax=panel)
if len(sys.argv) > 2:
    figure.savefig(sys.argv[2], dpi=100)
else:
    plt.show()
