#!/usr/bin/env python3
"""Plots how the time of matching grows with disparities, pixels and threads.

Usage: build/bin/bench_stages --benchmark_filter=match --benchmark_repetitions=5 \\
           --benchmark_enable_random_interleaving=true --benchmark_out=scaling.json --benchmark_out_format=json
       scripts/plot_scaling.py scaling.json docs/images/scaling.png
Takes the fastest repetition of each. Needs matplotlib.
"""
import json
import re
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

NAME = re.compile(r"match/(?P<preset>\w+)/threads:(?P<threads>\d+)/(?P<w>\d+)/(?P<h>\d+)/(?P<d>\d+)/")


def read(path):
    """(preset, threads, width, height, disparities) -> milliseconds."""
    with open(path, encoding="utf-8") as file:
        entries = json.load(file)["benchmarks"]
    times = {}
    for entry in entries:
        match = NAME.match(entry["name"])
        if match and entry["run_type"] == "iteration":
            key = (match["preset"],) + tuple(int(match[k]) for k in ("threads", "w", "h", "d"))
            times[key] = min(entry["real_time"], times.get(key, float("inf")))
    return times


def main(source, target):
    times = read(source)
    presets = sorted({key[0] for key in times})
    figure, (by_d, by_pixels, by_threads) = plt.subplots(1, 3, figsize=(13, 4))
    for preset in presets:
        one = {key[2:]: ms for key, ms in times.items() if key[0] == preset and key[1] == 1}
        points = sorted((d, ms) for (w, h, d), ms in one.items() if (w, h) == (640, 360))
        by_d.plot(*zip(*points), "o-", label=preset)
        points = sorted((w * h / 1e6, ms) for (w, h, d), ms in one.items() if d == 32)
        by_pixels.plot(*zip(*points), "o-", label=preset)
    sizes = sorted({key[2:] for key in times if key[1] == 2}, key=lambda s: s[0] * s[1])
    width = 0.8 / len(presets)
    for i, preset in enumerate(presets):
        gains = [times[(preset, 1) + size] / times[(preset, 2) + size] for size in sizes]
        by_threads.bar([x + i * width for x in range(len(sizes))], gains, width, label=preset)
    by_d.set(title="640×360, one thread", xlabel="disparities", ylabel="ms", xlim=(0, None), ylim=(0, None))
    by_pixels.set(title="D 32, one thread", xlabel="million pixels", ylabel="ms", xlim=(0, None), ylim=(0, None))
    by_threads.set(title="two threads against one", ylabel="times as fast", ylim=(0, 2.4))
    by_threads.axhline(2, color="grey", linewidth=0.8)
    by_threads.set_xticks([x + width for x in range(len(sizes))], [f"{w}×{h}×{d}" for w, h, d in sizes])
    for axes in (by_d, by_pixels, by_threads):
        axes.legend(loc="lower right" if axes is by_threads else "upper left")
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(target, dpi=80)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
