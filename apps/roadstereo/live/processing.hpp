#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "auto_mask.hpp"
#include "flight/rectified_source.hpp"
#include "live/captured_pair.hpp"
#include "live/latest_value.hpp"
#include "live/live_board.hpp"
#include "live/live_messages.hpp"
#include "live/path_finder.hpp"
#include "roadstereo/lens_spots.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// Options of Processing.
struct ProcessingOptions {
  PipelineOptions pipeline;
  bool find_white_level = true;             ///< determines it from the pairs of a 16-bit source
  bool auto_mask = true;                    ///< leaves out what never moves
  std::optional<std::uint32_t> dds_domain;  ///< publishes the results there as ROS 2 messages
  bool trajectory = false;                  ///< follows the camera
};

/// Converts captured pairs to views in stages, which run concurrently on successive pairs.
class Processing {
 public:
  /// `rectifier`: only its `rectify` is used. Throws Error if an option is out of range.
  Processing(const ProcessingOptions& options, std::unique_ptr<RectifiedSource> rectifier, LiveBoard& board,
             LatestValue<CapturedPair>& captured);

  /// First stage: rectifies and matches until `captured` is closed and empty.
  void match();

  /// Second stage: finds damage and publishes until the first stage has ended.
  void finish();

  /// Third stage: follows the camera, if asked for, until the second stage has ended. It never delays the others: a
  /// frame that it cannot take in time is skipped.
  void follow();

 private:
  struct Matched {
    CapturedPair captured;
    FrameResult result;
    PairSpots spots;
    std::optional<StereoCalibration> calibration;
  };

  void match_pairs();
  std::optional<Matched> match(CapturedPair captured);
  Pipeline& pipeline();
  LiveView view_of(Matched& matched);
  void hand_over(Matched matched);
  void publish_messages(const Matched& matched, const DamageMap& map);

  ProcessingOptions options_;
  std::unique_ptr<RectifiedSource> rectifier_;
  LiveBoard& board_;
  LatestValue<CapturedPair>& captured_;
  LatestValue<Matched> matched_;
  LatestValue<FollowedFrame> followed_;
  std::optional<Pipeline> pipeline_;
  std::int64_t pairs_ = 0;  ///< that were given to the pipeline
  AutoMask auto_mask_;
  PairWatch watch_;
  std::optional<LiveMessages> messages_;  ///< of the second stage
};

}  // namespace roadstereo::cli
