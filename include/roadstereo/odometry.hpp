#pragma once

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/disparity_plane.hpp"
#include "roadstereo/image_view.hpp"
#include "roadstereo/trajectory.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

struct FrameResult;

struct OdometryOptions {
  double min_correlation = 0.3;    ///< below it there is no link, 0 … 1
  double weak_correlation = 0.5;   ///< below it a link is weak, min_correlation … 1
  double min_overlap = 0.15;       ///< share of the view that a link needs, 0 … 1
  double reference_overlap = 0.7;  ///< below it the frame becomes the reference of the next ones, 0 … 1
  bool estimate_offset = true;     ///< estimate and undo an offset of the disparities at infinity
  int kept_frames = 0;             ///< minimum number of the last poses and links that are kept; 0: all
  int threads = 0;                 ///< worker threads, 0: all cores; they do not change the results

  /// Throws Error naming the first option that is out of range.
  void validate() const;
};

/// Quality of a link.
enum class LinkStatus {
  good,
  weak,  ///< little texture matches, or the views overlap little; the covariance shows how accurate the link is
};
const char* name_of(LinkStatus status);

/// Motion between the cameras of two frames.
struct FrameLink {
  int from = 0;  ///< index of the earlier frame
  int to = 0;    ///< index of the later frame
  LinkStatus status = LinkStatus::good;
  std::array<double, 12> motion{1, 0, 0, 0, 0, 1,
                                0, 0, 0, 0, 1, 0};  ///< 3×4, row-major, metres: points of camera `from`
                                                    ///< to camera `to`
  std::array<double, 36> covariance{};              ///< translation, then rotation vector, in the axes of camera `to`
  double correlation = 0;                           ///< median NCC of patches of texture, −1 … 1
  double overlap = 0;                               ///< share of the view of `from` that `to` sees, 0 … 1; parts seen
                                                    ///< from farther away count in proportion to their smaller area
  double offset_px = 0;                             ///< disparity offset at infinity that was undone, pixels
  double offset_sd_px = 0;                          ///< its standard error
  double measured_offset_px = 0;                    ///< offset estimated from this link alone, pixels
  double measured_offset_sd_px = 0;                 ///< its standard error; 0: not measured
  // Estimates for the rig from this link alone, with offset and shutter time as free parameters.
  double rig_offset_px = 0;     ///< disparity offset at the principal point, pixels, estimated together with its growth
                                ///< towards the sides
  double rig_offset_sd_px = 0;  ///< its standard error; 0: not measured
  double shutter = 0;     ///< time from the first to the last row of an image, relative to the time between the two
                          ///< frames; 0: global shutter
  double shutter_sd = 0;  ///< its standard error; 0: not measured
};

/// Maps of one frame, W×H.
struct OdometryFrame {
  ImageView<const std::int16_t> grey;  ///< sixteenths of grey levels
  ImageView<const float> disparity;    ///< pixels, NaN invalid
  ImageView<const float> sigma;        ///< standard error of the disparity, pixels
  bool has_road = false;
  DisparityPlane road;                                       ///< unless `has_road` is false
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< NaN: unknown; by it missing frames are noticed, which
                                                             ///< indices of a bag do not count
};

/// Estimates the motion of a rig from frame to frame: direct alignment of grey levels and disparities. Every frame is
/// aligned with a reference, an earlier frame that is kept as long as enough of its view is seen. Where the prediction
/// from the last motion fails, the road planes of both frames are resampled to a metric grid and registered by phase
/// correlation. A frame that cannot be linked starts a new piece. Images of less than 80 pixels on a side are
/// too small to be linked. Not thread-safe.
class Odometry {
 public:
  explicit Odometry(const StereoCalibration& calibration, const OdometryOptions& options = {});
  ~Odometry();
  Odometry(Odometry&&) noexcept;
  Odometry& operator=(Odometry&&) noexcept;

  /// Adds a frame, with an index above that of the last one. Returns its pose. Throws Error if the maps differ in size
  /// from each other or from earlier frames, if the calibration does not fit that size, or if the index does not grow.
  const FramePose& add(int frame, const OdometryFrame& maps);
  const FramePose& add(int frame, const FrameResult& result, double time_s = std::numeric_limits<double>::quiet_NaN());

  /// Index of the frame that the next one is aligned with; −1 before the first.
  int reference() const;

  /// Links so far, one per frame that has one; with kept_frames the last ones.
  const std::vector<FrameLink>& links() const;

  /// Poses so far, one per frame that was added; with kept_frames the last ones.
  const Trajectory& trajectory() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadstereo
#pragma GCC visibility pop
