#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/road_model.hpp"

namespace roadstereo::synth {

/// Pose and optics of the rig over the road. The road's frame: X to the right, Y forward along the road, Z up,
/// metres; the left camera stands at (x_m, y_m, camera_height_m), the right one on the left camera's x axis.
struct Rig {
  int width = 640;               ///< pixels
  int height = 360;              ///< pixels
  double focal_px = 350;         ///< pixels
  double baseline_m = 0.12;      ///< metres
  double camera_height_m = 2.0;  ///< metres above the road's plane
  double pitch_deg = 60;         ///< below the horizon: 90 looks straight down, 5 is street view
  double roll_deg = 0;           ///< about the optical axis, positive turns the image clockwise
  double x_m = 0;                ///< where on the road the left camera stands
  double y_m = 0;

  void validate() const;
  StereoCalibration calibration() const;
};

/// A depression or a rise with an irregular outline and a steep wall.
struct Blob {
  double x_m = 0, y_m = 0;    ///< centre on the road
  double radius_m = 0.2;      ///< mean radius
  double depth_m = 0.05;      ///< positive below the road, negative above
  double irregularity = 0.2;  ///< relative variation of the radius, 0 … 0.5; roughens the floor, too
  double wall_share = 0.25;   ///< share of the radius over which the wall rises, 0.02 … 1
  std::uint32_t seed = 1;     ///< shape of the outline and of the floor
};

/// A crack: a groove along a polyline, with the profile of a V.
struct Crack {
  std::vector<std::array<double, 2>> points_m;
  double width_m = 0.01;  ///< where it is widest
  double depth_m = 0.02;
  double irregularity = 0;  ///< 0 is as wide everywhere; up to 0.9: width varies by this share, least at the ends
  std::uint32_t seed = 1;   ///< of the width
};

/// A kerb: everything right of x_m is higher by height_m.
struct Kerb {
  double x_m = 1.5;
  double height_m = 0.12;
  double width_m = 0.02;  ///< of the slanted face
};

/// Texture and wear of a road.
struct Road {
  double camber = 0.0;            ///< sideways fall of the crown, m per m²: Z = −camber · X²
  double texture_contrast = 1.0;  ///< 1 is ordinary asphalt; 0.1 is nearly texture-free
  bool lane_marking = true;       ///< white dashes along X = −1.5 m, edge line along X = −5 m
  std::vector<Blob> blobs;
  std::vector<Crack> cracks;
  std::vector<Kerb> kerbs;
  std::uint32_t seed = 1;
};

/// What the cameras do to the picture.
struct Degradation {
  double noise_grey = 0;      ///< standard deviation, 8-bit grey levels
  double blur_px = 0;         ///< Gaussian blur, standard deviation, pixels
  double motion_blur_px = 0;  ///< length of horizontal-and-vertical motion, pixels
  double motion_blur_angle_deg = 0;
  double gain_difference = 0;    ///< right image is (1 + gain_difference) as bright
  double exposure = 1;           ///< multiplies both images before clipping at white
  double row_offset_px = 0;      ///< vertical rectification error: the right image lies this much lower, pixels
  std::uint32_t noise_seed = 1;  ///< other seed, other noise
};

struct Scene {
  std::string name;
  Rig rig;
  Road road;
  Degradation degradation;
  int supersampling = 3;  ///< rays per pixel and side, 1 … 8

  void validate() const;
};

/// One damage as it really is.
struct DamageTruth {
  int id = 0;               ///< its value in `labels`
  std::string kind;         ///< "pothole", "bump" or "crack"
  double x_m = 0, y_m = 0;  ///< centroid on the road
  double depth_m = 0;       ///< largest depth below the undamaged road (height above it for a bump)
  double mean_depth_m = 0;
  double area_m2 = 0;  ///< in the road's plane
  double volume_m3 = 0;
};

/// A pair with its truth. Maps have the image's size and belong to the left camera.
struct SyntheticPair {
  Frame left;  ///< 8-bit grey
  Frame right;
  StereoCalibration calibration;
  Image<double> disparity;      ///< from the ray's intersection with the surface; NaN for sky: above the
                                ///< horizon or more than a kilometre away
  Image<std::uint8_t> visible;  ///< 255 where the right camera sees the point too
  Image<std::uint16_t> labels;  ///< id of the damage at the pixel, 0 = none
  RoadModel plane;              ///< the road's plane in disparity space (without camber and damage), exact
  double roll_rad = 0;          ///< ψ of that plane as the paper defines it; 0 where it is not defined,
                                ///< because the camera looks straight down
  std::vector<DamageTruth> damages;
};

/// Renders one pair by casting rays at the road's height field. Deterministic for any number of threads.
SyntheticPair render(const Scene& scene, int threads = 0);

/// Named scenes ("demo", "uav", "street", "nadir", "close", "low_texture", "noise", "blur", "overexposed", …).
std::vector<std::string> scene_names();

/// Throws Error naming the nearest known scene.
Scene named_scene(const std::string& name);

/// A scene drawn at random: rig, road, damage and (when `degraded`) wear of the picture. Same seed, same scene.
Scene random_scene(std::uint64_t seed, bool degraded = false);

/// The scene `frame` steps of `step_m` further along the road, with the rig swaying a little: frames of one flight.
/// The road with its damage stays where it is; frame 0 is the scene itself.
Scene next_frame(const Scene& scene, int frame, double step_m = 0.1);

/// How a rig flies along the road, relative to the pose it has in the scene. Rolling and pitching are sine waves, the
/// height rises from the scene's and comes back; periods are in frames. From each frame of `jumps` on the pose is
/// another one at once, as after a bump, a turn or a cut: the first jump leads there, the second back, and so on.
struct FlightPath {
  double roll_deg = 6;        ///< amplitude, 0 … 45
  double roll_period = 100;   ///< 2 … 1e6
  double pitch_deg = 4;       ///< amplitude, 0 … 45; the optical axis stays between the horizon and straight down
  double pitch_period = 130;  ///< 2 … 1e6
  double climb_m = 0.5;       ///< highest above the scene's height, 0 … 100
  double climb_period = 170;  ///< 2 … 1e6
  double step_m = 0.1;        ///< along the road per frame, −10 … 10
  std::vector<int> jumps;     ///< frames, at least 1, each at most once
  double jump_roll_deg = 5;   ///< what a jump adds, −45 … 45
  double jump_pitch_deg = 4;  ///< −45 … 45
  double jump_climb_m = 0.3;  ///< −100 … 100
  double jump_step_m = 0;     ///< every jump, along the road; −1000 … 1000

  /// Throws Error naming the first figure that is out of range.
  void validate() const;
};

/// The scene as the rig sees it `frame` frames into the flight. The road with its damage stays where it is; frame 0 is
/// the scene itself. Throws Error when the flight leads where no rig can be, into the ground for example.
Scene flight_frame(const Scene& scene, const FlightPath& path, int frame);

}  // namespace roadstereo::synth
