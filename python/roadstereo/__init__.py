"""Dense stereo for road inspection: disparity, roll, transformed disparity and damage of stereo pairs.

    pipeline = roadstereo.Pipeline("default", roadstereo.read_calibration("calibration.yaml"))
    result = pipeline.process(left, right)
    damage = roadstereo.find_damage(result)

Images are numpy arrays (H, W), row-major; units are part of a name; NaN is invalid. docs/python.md is an introduction.
"""

from ._roadstereo import (
    Calibration,
    Damage,
    DamageEvidence,
    DamageMap,
    DamageMetrics,
    DeviceMap,
    DeviceMaps,
    DisparityPlane,
    Error,
    FrameLink,
    FramePose,
    FrameResult,
    FrameSource,
    GroundPlane,
    Measurement,
    Misalignment,
    Odometry,
    PerspectiveShift,
    Pipeline,
    Rectifier,
    RoadModelEstimate,
    RoadResiduals,
    RollEstimate,
    RowAlignment,
    RowOffset,
    SeverityProbabilities,
    SourcePair,
    StageTimes,
    StereoRig,
    __version__,
    cloud_from_disparity,
    describe_options,
    engine_names,
    find_damage,
    find_white_level,
    open_source,
    preset_names,
    read_calibration,
    read_disparity,
    read_frame,
)

__all__ = [
    "Calibration",
    "Damage",
    "DamageEvidence",
    "DamageMap",
    "DamageMetrics",
    "DeviceMap",
    "DeviceMaps",
    "DisparityPlane",
    "Error",
    "FrameLink",
    "FramePose",
    "FrameResult",
    "FrameSource",
    "GroundPlane",
    "Measurement",
    "Misalignment",
    "Odometry",
    "PerspectiveShift",
    "Pipeline",
    "Rectifier",
    "RoadModelEstimate",
    "RoadResiduals",
    "RollEstimate",
    "RowAlignment",
    "RowOffset",
    "SeverityProbabilities",
    "SourcePair",
    "StageTimes",
    "StereoRig",
    "__version__",
    "cloud_from_disparity",
    "describe_options",
    "engine_names",
    "find_damage",
    "find_white_level",
    "open_source",
    "preset_names",
    "read_calibration",
    "read_disparity",
    "read_frame",
]

for _name in __all__:
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = __name__
del _name
