#!/usr/bin/env python3
"""Plots what an experiment of `roadstereo evaluate` measured.

Usage: roadstereo evaluate EXPERIMENT ... --json values.json
       scripts/plot_evaluate.py EXPERIMENT values.json figure.png
EXPERIMENT is ablation, blur, flatness, flight, kitti, lambda, roll, runtime, sigma, subpixel or
synth. Needs matplotlib.
"""
import json
import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

PALETTE = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#5a5a5a"]
plt.rcParams["axes.prop_cycle"] = plt.cycler(color=PALETTE)
plt.rcParams["font.size"] = 9


def number(value):
    """A number of the JSON; null is NaN."""
    return math.nan if value is None else value


def column(rows, key):
    return [number(row[key]) for row in rows]


def rows_of(rows, **wanted):
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def names_of(rows, key):
    return list(dict.fromkeys(row[key] for row in rows))


def reference_lines(axes, *values):
    for value in values:
        axes.axhline(value, color="grey", linestyle="--", linewidth=0.8)


def group_bars(axes, title, label, groups, series, cut_all_but=None):
    """Bars of every series (name: values, one a group); those of `cut_all_but` do not set the height of the axis."""
    width = 0.8 / len(series)
    for i, (name, values) in enumerate(series.items()):
        places = [x + (i - (len(series) - 1) / 2) * width for x in range(len(groups))]
        axes.bar(places, values, width, label=name)
    heights = [v for name, values in series.items() if name != cut_all_but for v in values if math.isfinite(v)]
    top = 1.1 * max(heights)
    for i, values in enumerate(series.values()):
        for x, value in enumerate(values):
            if value > top:
                axes.text(x + (i - (len(series) - 1) / 2) * width, 0.98 * top, f"{value:.3g}", rotation=90, color="white",
                          ha="center", va="top", fontsize=7)
    axes.set(title=title, ylabel=label, ylim=(0, top))
    axes.set_xticks(range(len(groups)), groups)
    axes.legend(ncol=len(series), fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.07), frameon=False)
    axes.grid(axis="y", alpha=0.3)


def curves_over(axes, title, x_label, y_label, **scales):
    axes.set(title=title, xlabel=x_label, ylabel=y_label, **scales)
    axes.grid(alpha=0.3, which="both")
    axes.legend(fontsize=8)


def plot_synth(document):
    """Mean error by the phase of the truth, and bars of e_p+ of every group."""
    figure, axes = plt.subplots(3, 2, figsize=(18, 13))
    for method in ("default", "SGBM"):
        phases = document["sub_pixel_phases"][method]
        axes[0, 0].plot(phases["phase_px"], [number(v) for v in phases["mean_error_px"]], "o-", label=method)
    reference_lines(axes[0, 0], -0.03, 0, 0.03)  # a matcher without pixel-locking stays within this band
    curves_over(axes[0, 0], "Sub-pixel bias on clean pairs", "phase of the true disparity, px", "mean error, px")
    axes[0, 1].axis("off")
    for row, tolerance in zip(axes[1:], ("0.5", "1")):
        for one, (key, name) in zip(row, (("visible", "Both cameras see it"), ("damage", "Damage"))):
            rows = document[key]
            series = {method: column(rows_of(rows, method=method), f"e_p_or_missing_{tolerance}px_percent")
                      for method in names_of(rows, "method")}
            group_bars(one, f"{name}: in error by more than {tolerance} px, or missing", "e_p+, %",
                       names_of(rows, "group"), series, cut_all_but="BM")
    return figure


def plot_subpixel(document):
    """Mean error by sub-pixel phase, and noise against its bound."""
    figure, axes = plt.subplots(1, 2, figsize=(16, 6))
    noises = sorted({row["noise_grey"] for row in document["methods"]})
    for phases in rows_of(document["phases"], noise_grey=noises[len(noises) // 2]):
        axes[0].plot(phases["phase_px"], [number(v) for v in phases["mean_error_px"]], "o-", label=phases["method"])
    reference_lines(axes[0], -0.01, 0, 0.01)
    curves_over(axes[0], f"Bias, noise of {noises[len(noises) // 2]:.0f} grey levels",
                "phase of the disparity that is fitted, px", "mean error, px")
    series = {method: column(rows_of(document["methods"], method=method), "ratio")
              for method in names_of(document["methods"], "method")}
    group_bars(axes[1], "Noise over its Cramér–Rao bound", "ratio", [f"{noise:.0f} grey levels" for noise in noises], series)
    return figure


def plot_sigma(document):
    """Actual against predicted errors, and the share within 2 σ by σ and by group."""
    figure, axes = plt.subplot_mosaic([["size", "share"], ["groups", "groups"]], figsize=(16, 11))
    for key, name in (("bins", "both cameras see it"), ("damage_bins", "damage")):
        rows = document[key]
        axes["size"].plot(column(rows, "sigma_px"), column(rows, "p68_error_px"), "o-", label=name)
        axes["share"].plot(column(rows, "sigma_px"), column(rows, "within_2_sigma_percent"), "o-", label=name)
    sigmas = column(document["bins"] + document["damage_bins"], "sigma_px")
    ends = [min(sigmas), max(sigmas)]
    axes["size"].plot(ends, ends, "--", color="grey", label="actual = predicted")
    curves_over(axes["size"], "Standard errors by tenths: what 68.3 % of the errors stay below",
                "predicted standard error, px", "actual error, px", xscale="log", yscale="log")
    curves_over(axes["share"], "Errors within two standard errors", "predicted standard error, px", "share, %",
                xscale="log", ylim=(None, 100))
    groups = names_of(document["groups"], "group")
    series = {name: column(rows_of(document["groups"], where=where), "within_2_sigma_percent")
              for where, name in (("visible", "both cameras see it"), ("damage", "damage"))}
    group_bars(axes["groups"], "Errors within two standard errors, group by group", "share, %", groups, series)
    for one in (axes["share"], axes["groups"]):
        reference_lines(one, 90, 97)
    return figure


def plot_ablation(document):
    """Lying bars of every variant and measure, coloured by their comparison with the preset of the variant."""
    rows = document["variants"]
    measures = [key for key in rows[0] if key not in ("variant", "preset", "kitti_density_percent")]
    figure, axes = plt.subplots(1, len(measures), figsize=(2.1 * len(measures), 0.26 * len(rows) + 1), sharey=True)
    for one, key in zip(axes, measures):
        for i, row in enumerate(rows):
            base = number(next(r for r in rows if r["variant"] == row["preset"])[key])
            value = number(row[key])
            colour = PALETTE[0] if row["variant"] == row["preset"] else "darkgrey"
            if abs(value - base) > 0.03 * base:
                colour = PALETTE[2] if value < base else PALETTE[1]
            share = value / base if base > 0 else 0
            one.barh(i, min(share, 3), color=colour)
            one.text(min(share, 3) + 0.1, i, f"{value:.4g}", va="center", fontsize=8)
        one.set(title=key.replace("_percent", " %").replace("e_p_or_missing", "e_p+").replace("_", " "), xlim=(0, 4.6))
        one.title.set_fontsize(7)
        one.set_xticks([])
        one.spines[["top", "right", "bottom"]].set_visible(False)
    axes[0].set_yticks(range(len(rows)), [row["variant"] for row in rows])
    axes[0].set_ylim(len(rows) - 0.5, -0.5)
    figure.suptitle("Blue: the preset; green better, orange worse, grey within 3 % of it; bars end at 3 times it", fontsize=9)
    return figure


def plot_kitti(document):
    """Bars of e_p+ and e_r of every method."""
    regions = [key for key in ("road", "all") if key in document]
    figure, axes = plt.subplots(len(regions), 2, figsize=(16, 5 * len(regions)), squeeze=False)
    for row, region in zip(axes, regions):
        rows = document[region]["mean"]
        keys = [key for key in rows[0] if key.startswith("e_p_or_missing_")]
        shares = {r["method"]: [number(r[key]) for key in keys] for r in rows}
        thresholds = ["more than " + key.split("_")[4].replace("px", " px") for key in keys]
        group_bars(row[0], f"{region}: in error or missing", "e_p+, %", thresholds, shares, cut_all_but="BM")
        errors = {r["method"]: [number(r["e_r_px"])] for r in rows}
        group_bars(row[1], f"{region}: e_r", "e_r, px", ["e_r"], errors, cut_all_but="BM")
    return figure


def plot_flight(document):
    """Errors of the roll and of the road model by frame, tracked and independent, and the times of the frames."""
    frames = document["frames"]
    jumps = [frame["frame"] for frame in frames[1:] if frame["reestimated"]]
    numbers = column(frames, "frame")
    panels = [("roll_rad", "Roll", "error of ψ, rad"), ("plane_px", "Road model", "largest error of the plane, px")]
    if not any(number(frame["independent"]["after_roll_rad"]) > 0 for frame in frames):  # straight down there is no roll
        panels.pop(0)
    figure, axes = plt.subplots(1, len(panels) + 1, figsize=(7 * (len(panels) + 1), 5))
    for one, (key, title, label) in zip(axes, panels):
        for stage in ("before", "after"):
            for start, style in (("tracked", "-"), ("independent", "--")):
                values = [number(frame[start][f"{stage}_{key}"]) for frame in frames]
                one.plot(numbers, values, style, label=f"{start}, {stage} matching")
        curves_over(one, title, "frame", label, yscale="log")
    axes[-1].plot(numbers, [min(frame["times_ms"]) for frame in frames], label="min of the passes")
    curves_over(axes[-1], "Time of a frame", "frame", "ms", ylim=(0, None))
    for one in axes:
        for jump in jumps:
            one.axvline(jump, color="grey", linestyle="--", linewidth=0.8)
    return figure


def plot_lambda(document):
    """Iterations of the gradient descent against λ(0)."""
    rows = document["rows"]
    figure, axes = plt.subplots(figsize=(8, 5))
    axes.plot(column(rows, "lambda"), column(rows, "mean_iterations"), "o-", label="mean of the maps")
    axes.plot(column(rows, "lambda"), column(rows, "max_iterations"), label="slowest map")
    axes.axvline(document["published_optimum"], color="grey", linestyle="--", label="optimum of the paper")
    axes.axvline(document["optimum"], color="grey", linestyle=":", label=f"optimum here: {document['optimum']:.3g}")
    curves_over(axes, "Gradient descent on the roll angle", "λ(0)", "iterations", xscale="log", ylim=(0, None))
    return figure


def plot_roll(document):
    """Largest error of all views by angle: every solver on the hardest exact maps, and matched pairs."""
    hardest = "rolled rig, damage, 5 % outliers"
    matched = any(trial["maps"].startswith("matched") for trial in document["trials"])
    figure, axes = plt.subplots(1, 1 + matched, figsize=(8 * (1 + matched), 5), squeeze=False)
    for trial in document["trials"]:
        largest = {}
        for angle, error in zip(trial["roll_deg"], trial["error_rad"]):
            largest[angle] = max(largest.get(angle, 0), abs(number(error)))
        if trial["maps"] == hardest:
            axes[0, 0].plot(largest.keys(), largest.values(), "o-", label=trial["solver"])
        elif trial["maps"].startswith("matched"):
            axes[0, 1].plot(largest.keys(), largest.values(), "o-", label=trial["maps"])
    for one, title in zip(axes[0], ("Exact maps, damage, 5 % outliers", "Matched pairs, damage, noise")):
        one.axhline(document["rows"][0]["mean_rad"], color="grey", linestyle="--", label="mean error of the paper")
        curves_over(one, title, "roll, degrees", "largest error, rad", yscale="log", ylim=(None, 0.05))
    return figure


def plot_blur(document):
    """Density and error against the length of the blur."""
    figure, axes = plt.subplots(1, 2, figsize=(13, 5))
    for method in names_of(document["rows"], "method"):
        rows = rows_of(document["rows"], method=method)
        for one, key in zip(axes, ("density_percent", "rms_px")):
            one.plot(column(rows, "length_px"), column(rows, key), "o-", label=method)
    curves_over(axes[0], "Density", "length of the motion blur, px", "density, %")
    curves_over(axes[1], "Error", "length of the motion blur, px", "e_r, px", ylim=(0, None))
    return figure


def plot_flatness(document):
    """σ_d of every frame without and with roll, from the truth and from matching."""
    rows = [row for row in document["rows"] if not row["frame"].startswith("published")]
    paper = next(row for row in document["rows"] if row["frame"].startswith("published"))
    series = {}
    for disparities in ("truth", "matched"):
        own = rows_of(rows, disparities=disparities)
        known = disparities == "truth"
        series[f"{disparities}, no roll"] = column(own, "without_roll_px") + [paper["without_roll_px"] if known else math.nan]
        series[f"{disparities}, roll"] = column(own, "robust_px") + [paper["gradient_descent_px"] if known else math.nan]
    figure, axes = plt.subplots(figsize=(12, 5))
    group_bars(axes, "σ_d of the transformed road", "σ_d, px", names_of(rows, "frame") + ["paper"], series)
    return figure


def plot_runtime(document):
    """Median time of every method."""
    rows = document["rows"]
    figure, axes = plt.subplots(figsize=(12, 5))
    axes.bar([row["method"].split(":")[-1].strip() for row in rows], column(rows, "total_ms"))
    axes.set(title=f"Time per frame, {document['width']}×{document['height']}, D {document['disparities']}",
             ylabel="median, ms")
    axes.tick_params(axis="x", rotation=30)
    axes.grid(axis="y", alpha=0.3)
    return figure


def main():
    plots = {name[5:]: plot for name, plot in globals().items() if name.startswith("plot_")}
    if len(sys.argv) != 4 or sys.argv[1] not in plots:
        sys.exit(__doc__)
    with open(sys.argv[2], encoding="utf-8") as file:
        figure = plots[sys.argv[1]](json.load(file))
    figure.tight_layout()
    figure.savefig(sys.argv[3], dpi=80)


if __name__ == "__main__":
    main()
