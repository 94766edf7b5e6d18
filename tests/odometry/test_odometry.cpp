// Rendered frames whose poses and disparities are known.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "odometry/direct_alignment.hpp"
#include "roadstereo/error.hpp"
#include "tests/odometry/known_frame.hpp"

namespace roadstereo {
namespace {

using test::known_frame;
using test::KnownFrame;

/// Frames of a flight that moves, rolls, pitches and climbs.
const std::vector<KnownFrame>& flight() {
  static const std::vector<KnownFrame> frames = [] {
    synth::FlightPath path;
    path.roll_period = path.pitch_period = path.climb_period = 40;
    std::vector<KnownFrame> rendered;
    synth::Scene scene = test::smaller_scene("uav", 2);
    scene.degradation.noise_grey = 3;
    for (int i = 0; i < 8; ++i) rendered.push_back(known_frame(synth::flight_frame(scene, path, i)));
    return rendered;
  }();
  return frames;
}

/// Error of a pose against that of the first frame.
Twist pose_error(const FramePose& pose, const KnownFrame& first, const KnownFrame& frame) {
  return twist_of(inverse(motion_of(pose.camera_to_world)) * inverse(first.pose) * frame.pose);
}

double distance(const Twist& error) {
  return std::hypot(error[0], error[1], error[2]);
}

double angle(const Twist& error) {
  return std::hypot(error[3], error[4], error[5]);
}

TEST(Odometry, FollowsFlight) {
  const std::vector<KnownFrame>& frames = flight();
  Odometry odometry(test::smaller_scene("uav", 2).rig.calibration());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FramePose& pose = odometry.add(static_cast<int>(i), frames[i].maps());
    EXPECT_EQ(pose.piece, 0);
    const Twist error = pose_error(pose, frames[0], frames[i]);
    // A pixel covers 12 mm of the road: 0.1 px is 1.2 mm, and 0.6 mrad.
    EXPECT_LT(distance(error), 1.2e-3) << i;
    EXPECT_LT(angle(error), 0.6e-3) << i;
  }
  ASSERT_EQ(odometry.links().size(), frames.size() - 1);
  for (const FrameLink& link : odometry.links()) {
    EXPECT_EQ(link.status, LinkStatus::good);
    EXPECT_EQ(link.offset_px, 0);
  }
}

/// The same cameras and disparities, counted from another zero.
TEST(Odometry, DisparityOffsetChangesNoPose) {
  constexpr double offset_px = 40;
  const StereoCalibration calibration = test::smaller_scene("uav", 2).rig.calibration();
  StereoCalibration shifted = calibration;
  shifted.disparity_offset_px = offset_px;
  Odometry odometry(calibration), from_other_zero(shifted);
  for (std::size_t i = 0; i < 4; ++i) {
    KnownFrame frame = flight()[i];
    const Twist usual = twist_of(motion_of(odometry.add(static_cast<int>(i), frame.maps()).camera_to_world));
    std::transform(frame.disparity.row(0), frame.disparity.row(0) + frame.disparity.pixels(), frame.disparity.row(0),
                   [](float d) { return d - static_cast<float>(offset_px); });
    frame.plane.a0 -= offset_px;
    const Twist other = twist_of(motion_of(from_other_zero.add(static_cast<int>(i), frame.maps()).camera_to_world));
    for (std::size_t k = 0; k < usual.size(); ++k) EXPECT_NEAR(other[k], usual[k], 1e-5) << i << " " << k;
  }
  EXPECT_EQ(from_other_zero.links().size(), 3U);
}

TEST(Odometry, StandsStill) {
  Odometry odometry(test::smaller_scene("uav", 2).rig.calibration());
  for (int i = 0; i < 3; ++i) {
    const FramePose& pose = odometry.add(i, flight()[0].maps());
    EXPECT_LT(distance(pose_error(pose, flight()[0], flight()[0])), 1e-6);
  }
}

TEST(Odometry, CovarianceIsThatOfErrors) {
  // The same view with other noise: whatever moves is error.
  synth::Scene scene = test::smaller_scene("uav", 2);
  scene.degradation.noise_grey = 6;
  const KnownFrame first = known_frame(scene);
  Vector<6> chi_square{};
  constexpr int trials = 6;
  for (int i = 1; i <= trials; ++i) {
    scene.degradation.noise_seed = static_cast<std::uint32_t>(1000 * i);
    const KnownFrame second = known_frame(scene);
    Odometry odometry(scene.rig.calibration());
    odometry.add(0, first.maps());
    const FramePose& pose = odometry.add(1, second.maps());
    const Twist error = pose_error(pose, first, second);
    for (std::size_t k = 0; k < 6; ++k) chi_square[k] += error[k] * error[k] / pose.covariance[7 * k];
  }
  for (std::size_t k = 0; k < 6; ++k) {  // mean 1, 99.9 % of χ² with 6 degrees of freedom
    EXPECT_GT(chi_square[k] / trials, 0.06) << k;
    EXPECT_LT(chi_square[k] / trials, 3.8) << k;
    RecordProperty("chi_square_" + std::to_string(k), std::to_string(chi_square[k] / trials));
  }
}

TEST(Odometry, FindsJumpByPhaseCorrelation) {
  // Half of the view further, at once: no prediction helps.
  Odometry odometry(test::smaller_scene("uav", 2).rig.calibration());
  synth::Scene scene = test::smaller_scene("uav", 2);
  const KnownFrame first = known_frame(scene);
  scene.rig.y_m += 0.8;
  scene.rig.x_m += 0.3;
  const KnownFrame second = known_frame(scene);
  odometry.add(0, first.maps());
  const FramePose& pose = odometry.add(1, second.maps());
  EXPECT_EQ(pose.piece, 0);
  EXPECT_LT(distance(pose_error(pose, first, second)), 2e-3);
}

TEST(Odometry, CutStartsNewPiece) {
  synth::Scene elsewhere = test::smaller_scene("uav", 2);
  elsewhere.road.seed = 99;
  elsewhere.rig.y_m = 50;
  const KnownFrame other = known_frame(elsewhere);
  Odometry odometry(elsewhere.rig.calibration());
  odometry.add(0, flight()[0].maps());
  odometry.add(1, flight()[1].maps());
  EXPECT_EQ(odometry.add(2, other.maps()).piece, 1);
  // What follows is linked with the first piece again.
  const FramePose& back = odometry.add(3, flight()[3].maps());
  EXPECT_EQ(back.piece, 0);
  EXPECT_LT(distance(pose_error(back, flight()[0], flight()[3])), 1.2e-3);
  EXPECT_EQ(odometry.links().size(), 2U);
}

// Two frames in succession that show nothing of the road, and not the same, as in glare.
TEST(Odometry, PieceGoesOnAfterSeveralUnusableFrames) {
  synth::Scene elsewhere = test::smaller_scene("uav", 2);
  elsewhere.rig.y_m = 50;
  Odometry odometry(elsewhere.rig.calibration());
  odometry.add(0, flight()[0].maps());
  odometry.add(1, flight()[1].maps());
  for (const int frame : {2, 3}) {
    elsewhere.road.seed = 97 + static_cast<std::uint32_t>(frame);
    EXPECT_EQ(odometry.add(frame, known_frame(elsewhere).maps()).piece, frame - 1);
  }
  const FramePose& back = odometry.add(4, flight()[3].maps());
  EXPECT_EQ(back.piece, 0);
  EXPECT_LT(distance(pose_error(back, flight()[0], flight()[3])), 1.2e-3);
}

TEST(Odometry, BlurredFrameIsLinked) {
  synth::Scene scene = test::smaller_scene("uav", 2);
  scene.rig.y_m = 0.1;
  scene.degradation.motion_blur_px = 6;
  const KnownFrame blurred = known_frame(scene);
  Odometry odometry(scene.rig.calibration());
  odometry.add(0, flight()[0].maps());
  const FramePose& pose = odometry.add(1, blurred.maps());
  EXPECT_EQ(pose.piece, 0);
  EXPECT_LT(distance(pose_error(pose, flight()[0], blurred)), 6e-3);  // half a pixel
}

TEST(Odometry, FollowsPureRotation) {
  synth::Scene scene = test::smaller_scene("uav", 2);
  scene.rig.pitch_deg += 3;
  scene.rig.roll_deg -= 2;
  const KnownFrame turned = known_frame(scene);
  Odometry odometry(scene.rig.calibration());
  odometry.add(0, flight()[0].maps());
  const Twist error = pose_error(odometry.add(1, turned.maps()), flight()[0], turned);
  EXPECT_LT(distance(error), 2e-3);
  EXPECT_LT(angle(error), 1e-3);
}

TEST(Odometry, IgnoresWhatMoves) {
  // Two fifths of the picture are a lorry with its own texture, 0.15 m ahead of where it was.
  synth::Scene lorry = test::smaller_scene("uav", 2);
  lorry.road.seed = 99;
  KnownFrame first = flight()[0], second = flight()[1];
  for (KnownFrame* frame : {&first, &second}) {
    const KnownFrame moving = known_frame(lorry);
    for (int v = 0; v < frame->grey.height(); ++v) {
      std::copy_n(moving.grey.row(v), 2 * frame->grey.width() / 5, frame->grey.row(v));
      std::copy_n(moving.disparity.row(v), 2 * frame->grey.width() / 5, frame->disparity.row(v));
    }
    lorry.rig.y_m -= 0.15;
  }
  Odometry odometry(lorry.rig.calibration());
  odometry.add(0, first.maps());
  EXPECT_LT(distance(pose_error(odometry.add(1, second.maps()), first, second)), 4.5e-3);  // a third of a pixel
}

TEST(Odometry, FramesWithoutDisparitiesAreNotLinked) {
  KnownFrame nothing = flight()[0];
  std::fill_n(nothing.disparity.row(0), nothing.disparity.pixels(), NAN);
  Odometry odometry(test::smaller_scene("uav", 2).rig.calibration());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(odometry.add(i, nothing.maps()).piece, i);
  EXPECT_EQ(odometry.add(3, flight()[0].maps()).piece, 3);
  EXPECT_EQ(odometry.add(4, flight()[1].maps()).piece, 3);
  EXPECT_EQ(odometry.add(5, nothing.maps()).piece, 3);  // its grey levels are linked
  EXPECT_EQ(odometry.add(6, flight()[2].maps()).piece, 3);
}

TEST(Odometry, OffsetAtInfinityIsUndone) {
  // A street, 0.6 m a frame; the right camera is yawed so that disparities are 0.6 px short in the middle.
  constexpr double offset_px = 0.6;
  synth::Scene scene = test::smaller_scene("street", 2);
  const StereoCalibration calibration = scene.rig.calibration();
  std::vector<KnownFrame> frames;
  for (int i = 0; i < 5; ++i) {
    scene.rig.y_m = 0.6 * i;
    frames.push_back(known_frame(scene));
    Image<float>& map = frames.back().disparity;
    for (int v = 0; v < map.height(); ++v) {
      for (int u = 0; u < map.width(); ++u) {
        const double shape = offset_shape(calibration, u, double{map(u, v)});
        map(u, v) -= static_cast<float>(offset_px * shape);
      }
    }
  }
  const auto last_error = [&](bool estimate) {
    OdometryOptions options;
    options.estimate_offset = estimate;
    Odometry odometry(calibration, options);
    for (std::size_t i = 0; i < frames.size(); ++i) odometry.add(static_cast<int>(i), frames[i].maps());
    if (estimate) {
      EXPECT_NEAR(odometry.links().back().offset_px, offset_px, 0.12);
    }
    return distance(pose_error(odometry.trajectory().frames.back(), frames.front(), frames.back()));
  };
  const double with = last_error(true), without = last_error(false);
  RecordProperty("error_with_mm", std::to_string(1e3 * with));
  RecordProperty("error_without_mm", std::to_string(1e3 * without));
  EXPECT_LT(with, 0.1 * without);
}

/// Frames of a street, `step_m` further each.
std::vector<KnownFrame> street_frames(const synth::Scene& street, double step_m, int count) {
  synth::Scene scene = street;
  std::vector<KnownFrame> frames;
  for (int i = 0; i < count; ++i) {
    scene.rig.y_m = step_m * i;
    frames.push_back(known_frame(scene));
  }
  return frames;
}

TEST(Odometry, FollowsStreetBackwards) {
  // All that the reference shows stays in view and becomes smaller.
  const synth::Scene street = test::smaller_scene("street", 2);
  constexpr double step_m = -0.8;
  constexpr int count = 12;
  const std::vector<KnownFrame> frames = street_frames(street, step_m, count);
  Odometry odometry(street.rig.calibration());
  for (int i = 0; i < count; ++i) {
    const FramePose& pose = odometry.add(i, frames[static_cast<std::size_t>(i)].maps());
    EXPECT_EQ(pose.piece, 0) << i;
    EXPECT_LT(distance(pose_error(pose, frames.front(), frames[static_cast<std::size_t>(i)])), 0.02) << i;
  }
  EXPECT_GT(odometry.reference(), 0);
  for (const FrameLink& link : odometry.links()) {
    EXPECT_EQ(link.status, LinkStatus::good) << link.to;
    EXPECT_LT(link.overlap, 0.98) << link.to;
  }
}

/// A bag that has lost five pairs numbers the next one as if nothing was missing. Its time tells how far the camera
/// went.
TEST(Odometry, TimesTellOfMissingFrames) {
  const synth::Scene street = test::smaller_scene("street", 2);
  constexpr double step_m = 1.2, period_s = 0.1;
  std::vector<KnownFrame> frames = street_frames(street, step_m, 4);
  synth::Scene later = street;
  constexpr int step_after_gap = 9;
  later.rig.y_m = step_m * step_after_gap;
  frames.push_back(known_frame(later));
  const auto last_of = [&](bool has_times) {
    Odometry odometry(street.rig.calibration());
    for (int i = 0; i < 5; ++i) {
      OdometryFrame maps = frames[static_cast<std::size_t>(i)].maps();
      if (has_times) maps.time_s = 1000 + period_s * (i < 4 ? i : step_after_gap);
      odometry.add(i, maps);
    }
    return std::pair{odometry.trajectory().frames.back(), odometry.links().back()};
  };
  EXPECT_EQ(last_of(false).second.status, LinkStatus::weak) << "it may find it all the same";
  const auto& [pose, link] = last_of(true);
  EXPECT_EQ(pose.piece, 0);
  EXPECT_EQ(link.status, LinkStatus::good);
  EXPECT_LT(distance(pose_error(pose, frames.front(), frames.back())), 0.05);
}

TEST(Odometry, ThreadsDoNotMatter) {
  const StereoCalibration calibration = test::smaller_scene("uav", 2).rig.calibration();
  OdometryOptions options;
  options.threads = 1;
  Odometry one(calibration, options);
  options.threads = 3;
  Odometry many(calibration, options);
  for (int i = 0; i < 3; ++i) {
    const auto frame = flight()[static_cast<std::size_t>(i)].maps();
    const FramePose expected = one.add(i, frame), pose = many.add(i, frame);
    EXPECT_EQ(pose.camera_to_world, expected.camera_to_world) << i;
    EXPECT_EQ(pose.covariance, expected.covariance) << i;
  }
  EXPECT_EQ(one.trajectory().frames.back().piece, 0);
  ASSERT_EQ(one.links().size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const FrameLink &expected = one.links()[i], &link = many.links()[i];
    EXPECT_EQ(link.overlap, expected.overlap);
    EXPECT_EQ(link.measured_offset_px, expected.measured_offset_px);
    EXPECT_EQ(link.shutter_sd, expected.shutter_sd);
  }
}

TEST(Odometry, ForgetsOldFramesOnly) {
  Odometry all(test::smaller_scene("uav", 2).rig.calibration());
  OdometryOptions options;
  options.kept_frames = 2;
  Odometry few(test::smaller_scene("uav", 2).rig.calibration(), options);
  for (std::size_t i = 0; i < flight().size(); ++i) {
    const FramePose& expected = all.add(static_cast<int>(i), flight()[i].maps());
    const FramePose& pose = few.add(static_cast<int>(i), flight()[i].maps());
    EXPECT_EQ(pose.camera_to_world, expected.camera_to_world);
    EXPECT_EQ(pose.covariance, expected.covariance);
    EXPECT_LE(few.trajectory().frames.size(), 4U);
    EXPECT_LE(few.links().size(), 4U);
  }
  EXPECT_EQ(all.trajectory().frames.size(), flight().size());
  EXPECT_EQ(few.links().back().to, 7);
}

/// Mean of a number over links.
double mean_of(const std::vector<FrameLink>& links, const std::function<double(const FrameLink&)>& number) {
  double sum = 0;
  for (const FrameLink& link : links) sum += number(link);
  return sum / static_cast<double>(links.size());
}

TEST(Odometry, RigIsMeasuredByEveryLink) {
  constexpr int count = 5;
  const synth::Scene scene = test::smaller_scene("uav", 2);
  synth::FlightPath path;
  path.step_m = 0.3;
  for (const double shutter : {0.0, 0.4}) {
    path.shutter_frames = shutter;
    std::vector<KnownFrame> frames;
    for (int i = 0; i < count; ++i) frames.push_back(known_frame(synth::flight_frame(scene, path, i)));
    for (const double offset_px : {0.0, 1.5}) {  // of the calibration
      StereoCalibration calibration = scene.rig.calibration();
      calibration.disparity_offset_px = offset_px;
      Odometry odometry(calibration);
      for (int i = 0; i < count; ++i) odometry.add(i, frames[static_cast<std::size_t>(i)].maps());
      const std::vector<FrameLink>& links = odometry.links();
      ASSERT_EQ(links.size(), std::size_t{count - 1});
      const double time = mean_of(links, [](const FrameLink& link) { return (link.to - link.from) * link.shutter; });
      EXPECT_NEAR(time, shutter, 0.03) << offset_px;
      EXPECT_NEAR(mean_of(links, [](const FrameLink& link) { return link.rig_offset_px; }), -offset_px, 0.05)
          << shutter;
      for (const FrameLink& link : links) {
        EXPECT_LT(link.rig_offset_sd_px, 0.05);
        EXPECT_LT((link.to - link.from) * link.shutter_sd, 0.1);
      }
    }
  }
}

TEST(Odometry, RejectsInvalidFrames) {
  const KnownFrame& frame = flight()[0];
  Odometry odometry(test::smaller_scene("uav", 2).rig.calibration());
  odometry.add(5, frame.maps());
  EXPECT_THROW(odometry.add(5, frame.maps()), Error);
  const Image<float> narrow(10, 10);
  OdometryFrame odd = frame.maps();
  odd.sigma = narrow;
  EXPECT_THROW(odometry.add(6, odd), Error);
  OdometryOptions options;
  options.min_overlap = 1.5;
  EXPECT_THROW(Odometry(test::smaller_scene("uav", 2).rig.calibration(), options), Error);
  options = {};
  options.kept_frames = -1;
  EXPECT_THROW(Odometry(test::smaller_scene("uav", 2).rig.calibration(), options), Error);
  options = {};
  options.threads = -1;
  EXPECT_THROW(Odometry(test::smaller_scene("uav", 2).rig.calibration(), options), Error);
}

}  // namespace
}  // namespace roadstereo
