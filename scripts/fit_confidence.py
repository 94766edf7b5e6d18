#!/usr/bin/env python3
"""Fit the confidence of damage to regions whose truth is known, with every source left out in turn.

scripts/fit_confidence.py NAME=FILE.json [NAME=FILE.json …]

FILE.json is what `roadstereo evaluate damage … --json FILE.json` wrote; files of one NAME are one source. Prints the
coefficients of the logistic regression (src/damage/evidence.cpp), and for each source how many of its regions are judged
rightly by the fit to all sources, by the fit to the others, and by the confidence of the program.
"""

import json
import math
import sys

import numpy as np

MAX_SIGNIFICANCE = 100
MIN_SLOPE = 0.05
EVEN_SLOPE = 0.3
RIDGE = 0.05
REGIONS_PER_SOURCE = 20  # real and false ones of a source weigh as much as so many


def log_steepness(slope):
    return math.log(min(max(slope, MIN_SLOPE), 1) / EVEN_SLOPE)


def gentle_share(region):
    """As in src/damage/evidence.cpp: what lies in a rut may be gentle, wide and cut by the border."""
    half_share = 10
    return half_share**2 / (region["rut_significance"]**2 + half_share**2)


def even_surface_significance(windows):
    of_chosen_disparities, of_one_window = 0.6, 1.85
    return of_chosen_disparities + (of_one_window - of_chosen_disparities) / math.sqrt(windows)


def surface_log_odds(region):
    """As in src/damage/evidence.cpp; it is not fitted."""
    per_standard_error, max_of_protrusion = 4.7, 0.5
    per_standard_error_of_hollow, max_standard_errors = 1, 2
    significance, slope = region["surface_significance"], region["likely_wall_slope"]
    if significance is None:
        return 0.0
    contrast = region["contrast_sigmas"]
    windows = (region["significance"] / contrast)**2 if contrast > 0 else 1
    lacking = significance - even_surface_significance(windows)
    if lacking < 0:
        return per_standard_error * math.sqrt(windows) * lacking
    above = max(0, significance - even_surface_significance(1))
    if slope is None:
        return min(max_of_protrusion, per_standard_error * above)
    slope_log_odds = gentle_share(region) * min(above, 1) * min(0, log_steepness(slope))
    return per_standard_error_of_hollow * min(above, max_standard_errors) + slope_log_odds


def clutter_log_odds(clutter):
    """As in src/damage/evidence.cpp; it is not fitted."""
    usual = 2
    return -math.log1p(max(0, clutter - usual))


def range_log_odds(vote):
    """As in src/damage/evidence.cpp; it is not fitted."""
    per_vote, even_odds = 20, 0.3
    return 0.0 if vote is None else per_vote * min(0, vote - even_odds)


def specular_log_odds(excess):
    """As in src/damage/evidence.cpp; it is not fitted."""
    per_excess, even_odds = -50, 0.03
    return 0.0 if excess is None else per_excess * max(0, excess - even_odds)


def texture_log_odds(share):
    """As in src/damage/evidence.cpp; it is not fitted."""
    per_share, even_odds = -15, 0.25
    return 0.0 if share is None else per_share * max(0, share - even_odds)


def pixel_log_odds(significance):
    """As in src/damage/evidence.cpp; it is not fitted."""
    per_log_significance, even_odds = 1.5, 5
    return 0.0 if significance is None else per_log_significance * min(0, math.log(max(significance, 1) / even_odds))


def features(region):
    significance = min(max(region["significance"], 1), MAX_SIGNIFICANCE)
    share, slope = region["border_share"], region["likely_wall_slope"]
    steeper = 0 if slope is None else log_steepness(slope)
    of_wall = [share**4 if slope is not None else 0, share**2 * steeper, min(0, steeper)]
    wider = math.log(max(1, region["extent"] or 0))
    shape = [gentle_share(region) * value for value in (share**2, *of_wall, wider)]
    return [1, math.log(significance), region["road_share"], region["unseen_share"], *shape]


def fit(x, y, offset, weight):
    """Newton's method for logistic regression with a fixed offset and a small ridge."""
    coefficients = np.zeros(x.shape[1])
    ridge = RIDGE * np.eye(x.shape[1])
    ridge[0, 0] = 1e-6
    for _ in range(100):
        p = predict(x, offset, coefficients)
        hessian = (x * (weight * p * (1 - p))[:, None]).T @ x + ridge
        coefficients = coefficients + np.linalg.solve(hessian, x.T @ (weight * (y - p)) - ridge @ coefficients)
    return coefficients


def predict(x, offset, coefficients):
    return 1 / (1 + np.exp(-np.clip(x @ coefficients + offset, -30, 30)))


def read(arguments):
    sources, rows = [], []
    for argument in arguments:
        name, separator, path = argument.partition("=")
        if not separator:
            sys.exit(f"{argument}: must be NAME=FILE.json")
        with open(path, encoding="utf-8") as file:
            document = json.load(file)
        usable = [region for region in document["found_regions"] if region["significance"] is not None]
        rows += usable
        sources += [name] * len(usable)
    if not rows:
        sys.exit("usage: scripts/fit_confidence.py NAME=FILE.json …")
    return np.array(sources), rows


def main():
    sources, rows = read(sys.argv[1:])
    x = np.array([features(row) for row in rows])
    y = np.array([float(row["is_damage"]) for row in rows])
    offset = np.array([surface_log_odds(row) +
                       range_log_odds(row["range_vote"]) + specular_log_odds(row["specular_excess"]) +
                       texture_log_odds(row["texture_share"]) + clutter_log_odds(row["clutter"]) +
                       pixel_log_odds(row["pixel_significance"]) for row in rows])
    program = np.array([row["confidence"] for row in rows])
    weight = np.ones(len(rows))
    for name in set(sources):
        for truth in (0, 1):
            of_kind = (sources == name) & (y == truth)
            weight[of_kind] = min(1, REGIONS_PER_SOURCE / max(1, of_kind.sum()))
    coefficients = fit(x, y, offset, weight)
    print("intercept, ln significance, road share, unseen share, border share²; of a slope s: border share⁴, border share² ×"
          " ln(s/0.3), min(0, ln(s/0.3)); ln extent beyond 1:", np.round(coefficients, 2))
    taking_part = predict(x, offset, coefficients)
    print(f"{'source':<12}{'damage':>7}{'found: all':>12}{'left out':>10}{'program':>9}"
          f"{'others':>8}{'wrong: all':>12}{'left out':>10}{'program':>9}")
    for name in sorted(set(sources)):
        of_source = sources == name
        left_out = predict(x[of_source], offset[of_source],
                           fit(x[~of_source], y[~of_source], offset[~of_source], weight[~of_source]))
        is_damage = y[of_source] > 0
        judged = [values > 0.5 for values in (taking_part[of_source], left_out, program[of_source])]
        found = [int((yes & is_damage).sum()) for yes in judged]
        wrong = [int((yes & ~is_damage).sum()) for yes in judged]
        print(f"{name:<12}{int(is_damage.sum()):>7}{found[0]:>12}{found[1]:>10}{found[2]:>9}"
              f"{int((~is_damage).sum()):>8}{wrong[0]:>12}{wrong[1]:>10}{wrong[2]:>9}")


if __name__ == "__main__":
    main()
