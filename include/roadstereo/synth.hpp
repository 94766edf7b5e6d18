#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/road_model.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::synth {

/// Pose and optics of a rig over the road. Road frame: X to the right, Y forward along the road, Z up, metres. The left
/// camera is at (x_m, y_m, camera_height_m), the right camera on its x axis.
struct Rig {
  int width = 640;               ///< pixels, 32 … 8192
  int height = 360;              ///< pixels, 32 … 8192
  double focal_px = 350;         ///< 0.2 … 50 image widths
  double baseline_m = 0.12;      ///< 0.005 … 10
  double camera_height_m = 2.0;  ///< above the plane of the road, 0.05 … 500
  double pitch_deg = 60;         ///< of the optical axis below the horizon, 0 … 90; 90 looks straight down
  double roll_deg = 0;           ///< about the optical axis, −60 … 60; positive rotates the image clockwise
  double yaw_deg = 0;            ///< of the rig about the vertical, −360 … 360; 90 looks to the left, along −X
  double x_m = 0;                ///< position of the left camera on the road, −1e5 … 1e5
  double y_m = 0;

  /// Throws Error naming the first value out of range.
  void validate() const;
  StereoCalibration calibration() const;
  /// Pose of the left camera: 3×4, row-major, from the camera frame (x right, y down, z forward) to the road frame.
  std::array<double, 12> camera_to_road() const;
};

/// Pothole or bump with an irregular outline and a steep wall.
struct Blob {
  double x_m = 0, y_m = 0;    ///< centre on the road
  double radius_m = 0.2;      ///< mean radius, 0.005 … 20
  double depth_m = 0.05;      ///< −2 … 2, not 0; positive below the road, negative above it
  double irregularity = 0.2;  ///< relative variation of the radius and of the floor, 0 … 0.5
  double wall_share = 0.25;   ///< share of the radius that the wall takes, 0.02 … 1
  std::uint32_t seed = 1;     ///< of the outline and the floor
  bool is_damage = true;      ///< false for scenery, such as bushes: no label and no truth
};

/// Crack: a groove with a V-shaped profile along a polyline.
struct Crack {
  std::vector<std::array<double, 2>> points_m;  ///< at least 2 distinct points (x, y)
  double width_m = 0.01;                        ///< maximum width, 0.0005 … 1
  double depth_m = 0.02;                        ///< 0.0001 … 1
  double irregularity = 0;                      ///< relative variation of the width, 0 … 0.9; the ends are narrowest
  std::uint32_t seed = 1;                       ///< of the width
};

/// Rut: a groove along a straight line, with a parabola as its section; it runs out over its width at both ends.
struct Rut {
  std::array<double, 2> from_m{0, -10}, to_m{0, 60};  ///< ends (x, y), at least `width_m` apart
  double width_m = 0.7;                               ///< 0.05 … 5
  double depth_m = 0.015;                             ///< 0.0001 … 1
};

/// Kerb: the road right of x_m is higher by height_m.
struct Kerb {
  double x_m = 1.5;
  double height_m = 0.12;  ///< −1 … 1
  double width_m = 0.02;   ///< of the slanted face, 0.001 … 10
};

/// Box that stands on the road, upright: a part of a parked car, a house front, a traffic island.
struct Box {
  double x_m = 3, y_m = 10;          ///< centre on the road
  double width_m = 1.8;              ///< along X, 0.01 … 1000
  double length_m = 4.2;             ///< along Y, 0.01 … 1000
  double bottom_m = 0, top_m = 1.4;  ///< heights above Z = 0, −100 … 100; top_m at least bottom_m
  double grey = 112;                 ///< mean brightness, 8-bit grey levels, 0 … 1000
  double texture_contrast = 0.3;     ///< relative to ordinary asphalt, 0 … 4
  double panel_m = 0;                ///< size of dark panels, such as windows, 0 … 100; 0: none
  std::uint32_t seed = 1;
};

/// Shape, texture and damage of a road.
struct Road {
  double camber = 0.0;            ///< Z = −camber · X² − crest · Y², 1/m, −0.1 … 0.1
  double crest = 0.0;             ///< 1/m, −0.1 … 0.1; above 0: the top of a hill, below 0: a dip
  double texture_contrast = 1.0;  ///< relative to ordinary asphalt, 0 … 4; 0.1 is almost textureless
  bool lane_marking = true;       ///< whether there are white dashes at X = −1.5 m and an edge line at X = −5 m
  double paint_grey = 205;        ///< brightness of the lane marking, 8-bit grey levels, 0 … 1000; clips above 255
  double shade = 0;               ///< share of the light that shadows of trees take, 0 … 0.95
  double wet_share = 0;           ///< share of the road under a film of water that mirrors the sky, 0 … 1
  double verge_left_m = -5.4;     ///< X of the left edge of the road, −1e5 … 1e5; earth and grass beyond
  double verge_right_m = 1e5;     ///< X of the right edge of the road
  std::vector<Blob> blobs;
  std::vector<Crack> cracks;
  std::vector<Rut> ruts;
  std::vector<Kerb> kerbs;
  std::vector<Box> boxes;
  std::uint32_t seed = 1;
};

/// Image degradation by the cameras.
struct Degradation {
  double noise_grey = 0;             ///< standard deviation of the noise, 8-bit grey levels, 0 … 100
  double full_well_electrons = 0;    ///< electrons at white, for the photon noise, 0 … 1e6; 0: none
  double blur_px = 0;                ///< standard deviation of a Gaussian blur, pixels, 0 … 50
  double motion_blur_px = 0;         ///< length of a linear motion blur, pixels, 0 … 200
  double motion_blur_angle_deg = 0;  ///< direction of the motion, from the rows, −360 … 360
  double gain_difference = 0;        ///< the right image is scaled by 1 + gain_difference, −0.95 … 10
  double exposure = 1;               ///< scale of both images before they are clipped at white, 0.01 … 100
  double row_offset_px = 0;          ///< vertical rectification error: shifts the right image down, −100 … 100
  double row_rotation_deg = 0;       ///< rotates the right image clockwise about its centre, −10 … 10
  int snowflakes = 0;                ///< white dots, each in one image only, 0 … 100000
  double bonnet_share = 0;           ///< share of the rows that a bonnet hides in the middle column, 0 … 0.9
  int jpeg_quality = 0;              ///< of the recorded images, 0 … 100; 0: lossless. Not applied by render()
  std::uint32_t noise_seed = 1;
};

/// How the pose of a rig changes from the first row of a picture to the last, while its shutters roll; 0: they are
/// global. The `Rig` is that of the middle row.
struct ShutterMotion {
  double x_m = 0, y_m = 0, height_m = 0;            ///< −100 … 100
  double pitch_deg = 0, roll_deg = 0, yaw_deg = 0;  ///< −45 … 45
};

struct Scene {
  std::string name;
  Rig rig;
  ShutterMotion shutter;
  Road road;
  Degradation degradation;
  int supersampling = 3;  ///< rays per pixel and axis, 1 … 8

  /// Throws Error naming the first value out of range, and if a camera is less than 2 cm above the surface.
  void validate() const;
};

/// Ground truth of one damage.
struct DamageTruth {
  int id = 0;               ///< value in `SyntheticPair::labels`
  std::string kind;         ///< "pothole", "bump", "crack" or "rut"
  double x_m = 0, y_m = 0;  ///< centroid on the road
  double depth_m = 0;       ///< maximum depth below the undamaged road; height above it for a bump
  double mean_depth_m = 0;
  double area_m2 = 0;  ///< in the plane of the road
  double volume_m3 = 0;
};

/// Stereo pair with ground truth. All maps are W×H of the left image.
struct SyntheticPair {
  Frame left;  ///< 8-bit grey
  Frame right;
  StereoCalibration calibration;
  Image<double> disparity;  ///< exact, pixels; NaN for sky (above the horizon, or road farther than 1 km), and where
                            ///< the bonnet hides the road
  Image<std::uint8_t> visible;  ///< 255 where the right camera sees the point, too
  Image<std::uint16_t> labels;  ///< id of the damage at the pixel; 0: none
  Image<std::uint8_t> road;     ///< 255 on the carriageway, damage included; 0 on kerbs, verges, boxes and the bonnet
  DisparityPlane plane;  ///< exact plane Z = 0 in disparity space: the road without camber, crest and damage; with
                         ///< a shutter that rolls, as the middle row sees it
  double roll_rad = 0;   ///< ψ of that plane as in the paper; 0 if the camera looks straight down
  std::vector<DamageTruth> damages;
};

/// Render a stereo pair by casting rays at the height field of the road. The result does not depend on `threads`; 0
/// uses all cores. Throws Error when the scene is not valid.
SyntheticPair render(const Scene& scene, int threads = 0);

/// Names of the predefined scenes ("demo", "uav", "street", "nadir", "close", "low_texture", "noise", …).
std::vector<std::string> scene_names();

/// Predefined scene of that name. Throws Error suggesting the nearest name if there is none.
Scene named_scene(const std::string& name);

/// Draw a random scene: rig, road, damage and, if `degraded`, image degradation. The same seed gives the same scene.
Scene random_scene(std::uint64_t seed, bool degraded = false);

/// Draw a random scene of a wider kind: streets with parked cars and house fronts, hills, kerbs, verges, islands,
/// shade, wet and saturated patches, snow, a bonnet, photon noise, defocus, motion and bad rectification. The same seed
/// gives the same scene.
Scene random_wide_scene(std::uint64_t seed);

/// Frame `frame` of a short flight: the rig is `frame` steps of `step_m` further along the road and sways slightly. The
/// road and its damage do not move. Frame 0 is the scene itself. Throws Error if `frame` is negative or `step_m` is not
/// finite.
Scene next_frame(const Scene& scene, int frame, double step_m = 0.1);

/// Flight of a rig along the road or in a circle, relative to its pose in the scene. Roll and pitch are sine waves; the
/// height rises from that of the scene and returns. Periods are in frames. Each frame in `jumps` toggles an additional
/// offset of the pose: the first jump adds it, the second removes it, and so on.
struct FlightPath {
  double roll_deg = 6;        ///< amplitude, 0 … 45
  double roll_period = 100;   ///< 2 … 1e6
  double pitch_deg = 4;       ///< amplitude, 0 … 45; the pitch is clamped to 0 … 90°
  double pitch_period = 130;  ///< 2 … 1e6
  double climb_m = 0.5;       ///< maximum height above that of the scene, 0 … 100
  double climb_period = 170;  ///< 2 … 1e6
  double step_m = 0.1;        ///< along the road per frame, −10 … 10
  double loop_period = 0;     ///< frames after which the rig, on a circle to the right, is back; 0: straight; 2 … 1e6
  double turn_frame = 0;      ///< frame at which a straight flight turns back, 0.3 m to the side; 0: never; 1 … 1e6;
                              ///< requires loop_period 0
  std::vector<int> jumps;     ///< frames, ≥ 1, without duplicates
  double jump_roll_deg = 5;   ///< offset of the roll, −45 … 45
  double jump_pitch_deg = 4;  ///< offset of the pitch, −45 … 45
  double jump_climb_m = 0.3;  ///< offset of the height, −100 … 100
  double jump_step_m = 0;     ///< added along the road at every jump, −1000 … 1000
  double shutter_frames = 0;  ///< time from the first row of a picture to its last, in periods of the frames; 0: global
                              ///< shutters; 0 … 1

  /// Throws Error naming the first value out of range.
  void validate() const;
};

/// Scene at frame `frame` of the flight. The road and its damage do not move. Frame 0 is the scene itself. Throws Error
/// if the path is not valid, `frame` is negative, or the pose is out of range, for example below the ground.
Scene flight_frame(const Scene& scene, const FlightPath& path, int frame);

}  // namespace roadstereo::synth
#pragma GCC visibility pop
