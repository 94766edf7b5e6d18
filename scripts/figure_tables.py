"""The tables of README.md and docs/ as Markdown, made from the results in docs/accuracy.json by figures.py.

A function per table: it takes the results by experiment, and under "dates" the day of each, and returns the lines, or None
while an experiment is missing.
"""
OPENCV = ("SGBM", "3WAY", "HH4", "BM")
METHODS = {"default": "`default`", "fast": "`fast`", "paper": "`paper`"} | {name: f"OpenCV {name}" for name in OPENCV}
BASELINES = {"default": "3WAY", "paper": "SGBM", "fast": "BM"}


def needs(*experiments):
    """A table that is left alone unless the results of all these experiments are there."""
    def decorate(function):
        def table(results):
            if not all(name in results for name in experiments):
                return None
            return function(*(results[name] for name in experiments))
        return table
    return decorate


def rows_where(rows, **values):
    return [row for row in rows if all(row.get(key) == value for key, value in values.items())]


def row_where(rows, **values):
    found = rows_where(rows, **values)
    if len(found) != 1:
        raise SystemExit(f"{len(found)} rows are {values}")
    return found[0]


def number(value, decimals):
    return "" if value is None else f"{value:.{decimals}f}".replace("-", "−")


def significant(value, digits=2):
    """A number with so many digits that count, without an exponent."""
    if not value:
        return "0" if value == 0 else ""
    text = f"{value:.{digits}g}"
    return (f"{float(text):.10f}".rstrip("0").rstrip(".") if "e" in text else text).replace("-", "−")


def markdown(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + " --- |" * len(header)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows]


def best(rows, key):
    """The smallest value of OpenCV's matchers."""
    return min(row[key] for row in rows if row["method"] in OPENCV)


@needs("kitti")
def kitti(result):
    keys = [("density_percent", 1), ("e_r_px", 3), ("e_p_1px_percent", 1), ("e_p_2px_percent", 3),
            ("e_p_3px_percent", 3), ("e_p_or_missing_2px_percent", 2)]
    table = [[METHODS[name]] + [number(row_where(result["road"]["mean"], method=name)[key], decimals)
                                for key, decimals in keys] for name in METHODS]
    table += [[row["method"].replace(" (", ", ").rstrip(")")] + [number(row[key], 3) for key, _ in keys]
              for row in result["published"]]
    return markdown(["", "density %", "e_r px", "e_p(1) %", "e_p(2) %", "e_p(3) %", "e_p+(2) %"], table)


@needs("kitti")
def kitti_lane(result):
    keys = [("density_percent", 1), ("e_r_px", 3), ("e_p_2px_percent", 3), ("e_p_3px_percent", 3)]
    regions = [("road mask", "road"), ("lane", "lane"), ("lane without edges along the rows", "lane_without_edges")]
    table = [[title, METHODS[name]] + [number(row_where(result[region]["mean"], method=name)[key], decimals)
                                       for key, decimals in keys]
             for title, region in regions for name in ("paper", "default", "3WAY")]
    published = row_where(result["published"], method="paper (published)")
    table.append(["regions drawn by hand", "paper, published"] + [number(published[key], 3) for key, _ in keys])
    return markdown(["region", "", "density %", "e_r px", "e_p(2) %", "e_p(3) %"], table)


@needs("kitti")
def kitti_regions(result):
    regions = [("road, where every method but BM gives a disparity", "road_common"), ("all labelled pixels", "all"),
               ("all labelled, where every method but BM gives one", "all_common")]
    keys = [("e_r_px", 3), ("e_p_2px_percent", 2), ("e_p_3px_percent", 2), ("e_p_or_missing_2px_percent", 2)]
    table = [[title, METHODS[name]] + [number(row_where(result[region]["mean"], method=name)[key], decimals)
                                       for key, decimals in keys]
             for title, region in regions for name in ("default", "paper", "3WAY")]
    return markdown(["region", "", "e_r px", "e_p(2) %", "e_p(3) %", "e_p+(2) %"], table)


@needs("kitti", "kitti_scene", "kitti_wider", "kitti_wider_scene")
def kitti_scope(ten, ten_scene, wider, wider_scene):
    def row(title, name, result, method):
        road, off_road, everything = (row_where(result[region]["mean"], method=method)
                                      for region in ("road", "off_road", "all"))
        return [title, name, number(road["e_r_px"], 2), number(off_road["density_percent"], 1),
                number(off_road["e_p_3px_percent"], 1), number(everything["e_p_or_missing_2px_percent"], 1)]

    table = []
    for title, road, scene in (("ten frames", ten, ten_scene), ("wider/kitti2015", wider, wider_scene)):
        table += [row(title, "`default`", road, "default"), row(title, "`default`, `--scope scene`", scene, "default"),
                  row(title, METHODS["3WAY"], road, "3WAY"), row(title, METHODS["HH4"], road, "HH4")]
    return markdown(["frames", "", "road: e_r px", "off it: density %", "off it: e_p(3) %", "all: e_p+(2) %"], table)


def synth_rows(rows, keys):
    for group in dict.fromkeys(row["group"] for row in rows):
        of_group = rows_where(rows, group=group)
        ours = row_where(of_group, method="default")
        cells = []
        for key, form in keys:
            other = best(of_group, key)
            text = form(other)
            cells.append(f"{form(ours[key])} ({f'**{text}**' if other < ours[key] else text})")
        yield group, ours, cells


SYNTH_KEYS = [("e_r_px", lambda value: number(value, 3)), ("e_p_or_missing_0.5px_percent", significant),
              ("e_p_or_missing_1px_percent", significant)]


@needs("synth")
def synth(result):
    table = [[group, number(ours["median_error_px"], 3), *cells]
             for group, ours, cells in synth_rows(result["visible"], SYNTH_KEYS)]
    return markdown(["group", "median px", "e_r px", "e_p+(0.5) %", "e_p+(1) %"], table)


@needs("synth")
def synth_damage(result):
    table = [[group, *cells] for group, _, cells in synth_rows(result["damage"], SYNTH_KEYS)]
    return markdown(["group", "e_r px", "e_p+(0.5) %", "e_p+(1) %"], table)


@needs("robustness")
def robustness(result):
    table = [[row["source"], number(row["frame_count"], 0), number(row["found_percent"], 1), number(row["weak_percent"], 1),
              number(row["plane_px"], 2), row["worst_frame"]] for row in result["roads"]]
    return markdown(["source", "frames", "found %", "weak %", "plane px", "worst frame"], table)


@needs("robustness")
def accuracy_sources(result):
    table = []
    for row in result["roads"]:
        of_source = rows_where(result["disparities"], source=row["source"])
        keys = [(f"e_p_or_missing_{limit}px_percent", 1) for limit in ("0.5", "1", "2")]
        ours = row_where(of_source, method="default")
        table.append([row["source"], number(row["frame_count"], 0), number(row["found_percent"], 0),
                      *(f"{number(ours[key], decimals)} ({number(best(of_source, key), decimals)})"
                        for key, decimals in keys)])
    return markdown(["source", "frames", "roads found %", "e_p+(0.5) %", "e_p+(1) %", "e_p+(2) %"], table)


@needs("robustness")
def robustness_disparities(result):
    keys = [("density_percent", 1), ("e_r_px", 3), ("error_sd_px", 3), ("e_p_2px_percent", 2), ("e_p_3px_percent", 2),
            ("e_p_or_missing_0.5px_percent", 1), ("e_p_or_missing_1px_percent", 2),
            ("e_p_or_missing_2px_percent", 2)]
    table = [[row["source"], METHODS[row["method"]]] + [number(row[key], decimals) for key, decimals in keys]
             for row in result["disparities"]]
    return markdown(["source", "", "density %", "e_r px", "less bias px", "e_p(2) %", "e_p(3) %", "e_p+(0.5) %", "e_p+(1) %",
                     "e_p+(2) %"], table)


@needs("robustness")
def robustness_drives(result):
    table = [[row["drive"], number(row["frame_count"], 0), number(row["tracked_percent"], 1), number(row["found_percent"], 1),
              number(row["none_percent"], 1), number(row["damages"], 0)] for row in result["drives"]]
    return markdown(["drive", "frames", "tracked %", "found anew %", "none %", "damages"], table)


@needs("ablation")
def ablation(result):
    keys = [("kitti_density_percent", 1), ("kitti_e_r_px", 3), ("kitti_e_p_2px_percent", 2),
            ("kitti_e_p_or_missing_2px_percent", 2), ("clean_median_error_px", 4),
            ("damage_e_p_or_missing_0.5px_percent", 2)]
    table, bases = [], {}
    for row in result["variants"]:
        name = row["variant"]
        base = bases.get("paper" if name.startswith("paper") else "default")
        if base is None:
            bases[name] = row
            cells = [number(row[key], decimals) for key, decimals in keys]
            name = f"`{name}`"
        else:
            changes = [round(row[key] - base[key], decimals) + 0.0 for key, decimals in keys]
            cells = [("+" if change > 0 else "") + (number(change, decimals) if change else "0")
                     for change, (_, decimals) in zip(changes, keys)]
        table.append([name, *cells])
    return markdown(["", "KITTI density %", "e_r px", "e_p(2) %", "e_p+(2) %", "clean median px", "damage %"], table)


@needs("sigma")
def sigma(result):
    table = []
    for group in dict.fromkeys(row["group"] for row in result["groups"]):
        cells = [group]
        for where in ("visible", "damage"):
            row = row_where(result["groups"], group=group, where=where)
            cells += [number(row["within_1_sigma_percent"], 1), number(row["within_2_sigma_percent"], 1)]
        table.append(cells)
    return markdown(["group", "within σ %", "within 2σ %", "on damage, within σ %", "within 2σ %"], table)


@needs("subpixel")
def subpixel(result):
    table = [[number(row["noise_grey"], 0), METHODS[row["method"]], number(row["max_bias_px"], 4),
              number(row["noise_px"], 4), number(row["support_px"], 1), number(row["bound_px"], 4),
              number(row["ratio"], 2)] for row in result["methods"]]
    return markdown(["noise, grey levels", "", "largest bias px", "noise px", "window px", "bound px", "noise / bound"], table)


@needs("roll")
def roll(result):
    table = [[row["maps"], row["solver"].replace("_", " "), *(f"{row[key]:.6f}" for key in ("mean_rad", "max_rad"))]
             for row in result["rows"] if "damage" in row["maps"] and row["solver"] != "closed_form"]
    return markdown(["maps", "solver", "mean", "largest"], table)


def flight_table(result):
    table = [[row["estimate"], row["start"], *(f"{row[key]:.4f}" for key in ("roll_p95_rad", "roll_max_rad")),
              *(number(row[key], 3) for key in ("plane_p95_px", "plane_max_px"))] for row in result["rows"]]
    return markdown(["estimate", "start", "ψ 95 %, rad", "max", "plane 95 %, px", "max"], table)


flight = needs("flight")(flight_table)
flight_jumps = needs("flight_jumps")(flight_table)


@needs("odometry_drive")
def odometry(drive):
    table = [[row["method"].strip(), number(row["translation_percent"], 3), number(row["turned_percent"], 3),
              number(row["rotation_deg_per_m"], 4), number(row["ate_percent"], 3), number(row["link_median_px"], 3),
              number(row["link_p95_px"], 3)]
             for row in drive["rows"]]
    return markdown([f"drive, {drive['path_m']:.0f} m", "translation %", "turned %", "rotation °/m", "ATE %", "link px",
                     "95 %"], table)


@needs("middlebury")
def middlebury(result):
    table = [[scene, METHODS[name], *(number(row_where(rows, method=name)[key], decimals) for key, decimals in
              (("density_percent", 1), ("e_r_px", 2), ("e_p_or_missing_1px_percent", 1),
               ("e_p_or_missing_2px_percent", 1)))]
             for scene, rows in result.items() for name in ("default", "fast", "paper", "SGBM", "3WAY", "HH4")]
    return markdown(["scene", "", "density %", "e_r px", "e_p+(1) %", "e_p+(2) %"], table)


@needs("flatness")
def flatness(result):
    table = [[row["disparities"] if row["frame"] == "mean" else "the paper, on regions chosen by hand",
              number(row["without_roll_px"], 3), number(row["gradient_descent_px"], 3), number(row["robust_px"], 3)]
             for row in result["rows"] if row["frame"].startswith(("mean", "published"))]
    return markdown(["disparities", "ψ = 0", "gradient descent", "robust"], table)


@needs("blur")
def blur(result):
    lengths = sorted({row["length_px"] for row in result["rows"]})
    table = [[METHODS[name], number(length, 0), number(row["rms_px"], 3), number(row["e_p_or_missing_1px_percent"], 1)]
             for name in ("default", "paper", "SGBM") for length in lengths[::max(1, len(lengths) // 2)]
             for row in rows_where(result["rows"], method=name, length_px=length)]
    return markdown(["", "motion px", "e_r px", "e_p+(1) %"], table)


@needs("lambda")
def descent(result):
    rows = sorted(result["rows"], key=lambda row: row["lambda"])
    table = [[significant(row["lambda"], 3), number(row["mean_iterations"], 2), number(row["max_iterations"], 0)]
             for row in rows[::4]]
    return markdown(["λ(0)", "mean iterations", "max"], table)


@needs("damage_maps", "damage_wider_maps", "damage_pairs")
def damage(maps, wider, pairs):
    table = [[name, row["frame"], *(number(row[key], 3) for key in ("precision", "recall", "f")),
              number(row["false_positives"], 0)]
             for name, result in (("maps", maps), ("wider maps", wider), ("pairs", pairs)) for row in result["rows"]]
    return markdown(["transformed", "frame", "precision", "recall", "F", "false positives"], table)


@needs("damage_maps", "damage_wider_maps", "damage_pairs", "damage_kitti", "damage_scenes", "damage_degraded", "damage_wide",
       "damage_ruts", "damage_other")
def damage_sources(maps, wider_maps, pairs, kitti, clean, degraded, wide, ruts, other):
    def labelled(title, result):
        row = row_where(result["rows"], frame="all pixels")
        return [title, *(number(row[key], 0) for key in ("labels", "found", "false_positives"))]

    def rendered(title, result):
        row = row_where(result["detection"], kind="without cracks")
        return [title, *(number(value, 0) for value in (row["deeper_than_3_std_errors"], row["found_of_those"],
                                                        result["false_positives"]))]
    intact = [row for row in kitti["rows"] if row["frame"] != "mean"]
    false = sum(row["false_depressions"] + row["false_protrusions"] for row in intact)
    return markdown(["source", "clear", "found", "false"], [
        labelled("real potholes, stereo pairs", pairs), labelled("real potholes, transformed maps", maps),
        labelled("the same, wider set", wider_maps), [f"intact KITTI streets, {len(intact)} frames", "", "", number(false, 0)],
        rendered("own roads, clean", clean), rendered("own roads, degraded", degraded), rendered("own roads, wide", wide),
        rendered("own roads with ruts", ruts), rendered("roads of another renderer", other)])


@needs("damage_kitti")
def damage_kitti(result):
    table = [[row["frame"].removesuffix("_10"), *(number(row[key], 3) for key in ("iou", "precision", "recall")),
              significant(row["false_depressions"] + row["false_protrusions"])] for row in result["rows"]]
    return markdown(["frame", "IoU", "precision", "recall", "false regions"], table)


@needs("damage_scenes", "damage_degraded", "damage_wide", "damage_ruts", "damage_other")
def damage_scenes(clean, degraded, wide, ruts, other):
    sources = (("clean", clean), ("degraded", degraded), ("wide", wide), ("ruts", ruts), ("another renderer", other))
    table = [[name, row["kind"], number(row["in_view"], 0), number(row["deeper_than_3_std_errors"], 0),
              number(row["found_of_those"], 0), number(100 * row["recall"], 0) if row["recall"] is not None else ""]
             for name, result in sources for row in result["detection"]]
    table += [[name, "false positives", "", "", f"{result['false_positives']:.0f} of {result['regions']:.0f}", ""]
              for name, result in sources]
    return markdown(["images", "kind", "in view", "deeper than 3 standard errors", "found of those", "recall %"], table)


@needs("damage_scenes", "damage_wide", "damage_other")
def damage_confidence(clean, wide, other):
    def cells(row):
        return [number(row["regions"], 0), number(row["damage_share"], 2)]
    table = [[rows[0]["confidence"], *(cell for row in rows for cell in cells(row))]
             for rows in zip(clean["confidence"], wide["confidence"], other["confidence"])]
    return markdown(["confidence", "clean: regions", "damage", "wide: regions", "damage", "another renderer: regions", "damage"],
                    table)


FAULTS = ("none", "20 streaks", "60 streaks", "150 streaks", "100 snow dots", "0.5 % dead pixels", "6 specks, left",
          "right k = 0.01", "right turned 0.5°", "right 1 rows lower", "right 3 rows lower", "right vibrates 0.5 px",
          "both skewed 10 px", "doffs +5", "doffs -5", "focal +20 %", "JPEG 75", "JPEG 20", "noise 8", "noise 25")


@needs("faults")
def faults(result):
    keys = ("found", "false_invented", "false_graded", "depths", "within_2_std_errors", "warned")
    table = []
    for row in result["rows"]:
        if row["fault"] not in FAULTS:
            continue
        found, invented, graded, depths, within, warned = (number(row[key], 0) for key in keys)
        table.append([row["fault"], found, invented, graded, f"{within} of {depths}", warned])
    return markdown(["fault", "found of 21", "invented", "graded", "within 2", "warned of 10"], table)


@needs("damage_scenes", "damage_wide", "damage_ruts", "damage_other")
def damage_errors(clean, wide, ruts, other):
    table = [[name, row["quantity"], number(row["within_2_std_errors_percent"], 0), number(row["median_error_percent"], 0),
              number(row["mean_abs_error_percent"], 1),
              number(row["precise"], 0)]
             for name, result in (("clean", clean), ("wide", wide), ("ruts", ruts), ("another renderer", other))
             for row in result["measurement"]]
    return markdown(["roads", "quantity", "within 2 standard errors %", "median error %", "mean error of precise ones %",
                     "precise ones"], table)


SCAN_KEYS = [("completeness_percent", 1), ("rms_mm", 2), ("median_mm", 2), ("rms_missing_10mm", 2)]


@needs("scan")
def scan(result):
    table = []
    for pair in dict.fromkeys(row["pair"] for row in result):
        ours, other = (row_where(result, pair=pair, method=method) for method in ("default", "SGBM"))
        table.append([pair, *(f"{number(ours[key], decimals)} ({number(other[key], decimals)})"
                              for key, decimals in SCAN_KEYS)])
    return markdown(["pair", "complete %", "RMS mm", "median mm", "RMS, missing 10 mm"], table)


def benchmarks(results):
    """Times of the pipeline beside OpenCV's matchers."""
    table, machines = [], set()
    for name, result in results.items():
        if not name.startswith("benchmark "):
            continue
        machines.add(f"{result['threads']} threads of {result['cpu']}")
        _, preset, size, disparities = name.split()
        peers = {peer["name"]: peer for peer in result["peers"]}
        other = peers[BASELINES[preset]]
        table.append([METHODS[preset], f"{size.replace('x', '×')}, D {disparities}",
                      number(result["total"]["median_ms"], 1), number(result["mde_per_s"], 0),
                      *(number(peers[peer]["median_ms"], 1) for peer in OPENCV),
                      BASELINES[preset], number(other["ratio"], 2)])
    if not table:
        return None
    dates = sorted({date for name, date in results["dates"].items() if name.startswith("benchmark ")})
    return markdown(["preset", "work", "total ms", "Mde/s", *(f"{peer} ms" for peer in OPENCV), "against", "ratio"],
                    table) + ["", f"Measured on {', '.join(dates)}, {', '.join(sorted(machines))}."]


def raw_pairs(results):
    """Times of the pipeline beside OpenCV's matchers on the pair without the perspective transformation."""
    table, machines, dates = [], set(), set()
    for name, result in results.items():
        if not name.startswith("raw "):
            continue
        machines.add(f"{result['threads']} threads of {result['cpu']}")
        dates.add(results["dates"][name])
        peers = {peer["name"]: peer for peer in result["peers"]}
        table.append([name.removeprefix("raw "), f"{result['width']}×{result['height']}", str(result["disparities"]),
                      number(result["total"]["median_ms"], 1), str(result["raw_disparities"]),
                      *(f"{number(peers[peer]['median_ms'], 1)} ({number(peers[peer]['ratio'], 2)})" for peer in OPENCV)])
    if not table:
        return None
    return markdown(["pair", "pixels", "D", "total ms", "D of OpenCV", *(f"{peer} ms (ratio)" for peer in OPENCV)], table) + [
        "", f"Measured on {', '.join(sorted(dates))}, {', '.join(sorted(machines))}."]


def span(values, decimals):
    return f"{number(min(values), decimals)}–{number(max(values), decimals)}"


def percents(rows, key):
    return ", ".join(number(row[key], 0) for row in rows)


# What README says, a line per experiment: the experiments, what it is, and the figures.
SUMMARY = [
    (("kitti",), "KITTI road masks, ten frames: density, e_r, e_p(2), e_p(3)",
     lambda kitti: kitti_summary(kitti, "default")),
    (("kitti",), "The same of OpenCV's 3WAY", lambda kitti: kitti_summary(kitti, "3WAY")),
    (("synth",), "Synthetic roads, 8 groups of 10 scenes from clean to blurred: median error",
     lambda synth: span([row["median_error_px"] for row in rows_where(synth["visible"], method="default")], 3) + " px"),
    (("synth",), "The same, wrong by more than 0.5 px or missing; OpenCV's best in each group",
     lambda synth: "; ".join(
         span(values, 1) + " %" for values in (
             [row["e_p_or_missing_0.5px_percent"] for row in rows_where(synth["visible"], method="default")],
             [best(rows_where(synth["visible"], group=group), "e_p_or_missing_0.5px_percent")
              for group in {row["group"] for row in synth["visible"]}]))),
    (("robustness",), "Roads of another renderer, 20 scenes with noise, blur, JPEG, misaligned rows: roads found; wrong by more "
     "than 0.5 px or missing; OpenCV's best",
     lambda result: "{:.0f} %; {} %; {} %".format(
         row_where(result["roads"], source="wider/synthetic")["found_percent"],
         number(row_where(result["disparities"], source="wider/synthetic", method="default")
                ["e_p_or_missing_0.5px_percent"], 1),
         number(best(rows_where(result["disparities"], source="wider/synthetic"), "e_p_or_missing_0.5px_percent"), 1))),
    (("robustness",), "Drive of 51 frames over an intact street: frames with a new search for the road, frames without a road; false damages",
     lambda result: (lambda row: "{:.0f} frame, {:.0f}; {:.0f}".format(
         row["found_percent"] * row["frame_count"] / 100, row["none_percent"] * row["frame_count"] / 100,
         row["damages"]))(row_where(result["drives"], drive="wider/odometry"))),
    (("subpixel",), "Largest sub-pixel bias, largest ratio of the noise to its Cramér–Rao bound; the best of OpenCV's for each",
     lambda result: "{} px, {}; {} px, {}".format(
         *(number(max(row[key] for row in rows_where(result["methods"], method="default")), decimals)
           for key, decimals in (("max_bias_px", 3), ("ratio", 2))),
         *(number(best(result["methods"], key), decimals) for key, decimals in (("max_bias_px", 3), ("ratio", 2))))),
    (("sigma",), "Disparity errors within two of their predicted standard errors, the synthetic roads",
     lambda sigma: number(row_where(sigma["groups"], group="all", where="visible")["within_2_sigma_percent"], 1) + " %"),
    (("damage_maps", "damage_pairs"),
     "Damage, pixel by pixel: F on six published transformed maps, on five pothole pairs (published on such maps: 0.89)",
     lambda maps, pairs: "; ".join(number(row_where(result["rows"], frame="all pixels")["f"], 3)
                                   for result in (maps, pairs))),
    (("scan",), "Potholes against laser scans, five pairs: RMS, labelled pixels measured; OpenCV SGBM",
     lambda scan: "; ".join(f"{number(row['rms_mm'], 1)} mm, {number(row['completeness_percent'], 1)} %"
                            for row in rows_where(scan, pair="mean"))),
    (("damage_scenes",),
     "Damage of matched synthetic roads: potholes and bumps deeper than 3 standard errors found; false positives",
     lambda scenes: f"{100 * row_where(scenes['detection'], kind='without cracks')['recall']:.0f} %; "
                    f"{scenes['false_positives']:.0f} of {scenes['regions']:.0f}"),
    (("damage_scenes",),
     "Errors of maximum depth, mean depth, area, volume within two standard errors, the same roads",
     lambda scenes: percents(scenes["measurement"], "within_2_std_errors_percent") + " %"),
    (("damage_kitti",), "False damage on intact KITTI road, ten frames; road region against the mask (IoU)",
     lambda kitti: "{} a frame; {}".format(
         *(lambda row: (significant(row["false_depressions"] + row["false_protrusions"]), number(row["iou"], 2)))(
             row_where(kitti["rows"], frame="mean")))),
    (("roll",), "Roll angle of matched synthetic pairs, mean error",
     lambda roll: f"{rows_where(roll['rows'], maps='matched pair, damage')[0]['mean_rad']:.4f} rad"),
    (("flatness",), "σ_d of the transformed road, KITTI truth, without and with roll correction",
     lambda flatness: "{}, {} px".format(
         *(number(row_where(flatness["rows"], frame="mean", disparities="truth")[key], 2)
           for key in ("without_roll_px", "gradient_descent_px")))),
    (("flight",),
     "Flight of 300 frames that rolls, pitches and climbs: largest error of the roll ψ, with tracking and with every frame on its own",
     lambda flight: ", ".join(f"{row['roll_max_rad']:.4f}"
                              for row in rows_where(flight["rows"], estimate="after matching")) + " rad"),
]


def kitti_summary(kitti, method):
    row = row_where(kitti["road"]["mean"], method=method)
    return (f"{number(row['density_percent'], 1)} %, {number(row['e_r_px'], 2)} px, "
            f"{number(row['e_p_2px_percent'], 2)} %, {number(row['e_p_3px_percent'], 2)} %")


def summary(results):
    """The results of README."""
    if not all(name in results for names, _, _ in SUMMARY for name in names):
        return None
    return markdown(["", "`default`"], [[text, value(*(results[name] for name in names))] for names, text, value in SUMMARY])
