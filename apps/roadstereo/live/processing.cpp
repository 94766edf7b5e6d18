#include "live/processing.hpp"

#include <utility>

#include "find_damage_or_warn.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {

Processing::Processing(const ProcessingOptions& options, std::unique_ptr<RectifiedSource> rectifier, LiveBoard& board,
                       LatestValue<CapturedPair>& captured)
    : options_(options),
      rectifier_(std::move(rectifier)),
      board_(board),
      captured_(captured),
      auto_mask_(options.auto_mask) {
  options_.pipeline.validate();
  if (!options_.find_white_level) rectifier_->ignore_white_level();
}

/// Creates the pipeline on first use, when the calibration is known.
Pipeline& Processing::pipeline() {
  if (!pipeline_) {
    pipeline_.emplace(options_.pipeline, rectifier_->calibration());
  }
  return *pipeline_;
}

std::optional<Processing::Matched> Processing::match(CapturedPair captured) {
  if (seconds_between(captured.arrival, Clock::now()) > board_.max_age_s()) {
    board_.count_too_old();
    return std::nullopt;
  }
  rectifier_->rectify(captured.pair);
  if (!captured.pair.error.empty()) {
    board_.count_rejected(captured.pair.error);
    return std::nullopt;
  }
  if (options_.trajectory && !rectifier_->calibration()) fail("--trajectory needs --calibration");
  Matched matched;
  const FrameView left = captured.pair.left.view(), right = captured.pair.right.view();
  try {
    if (captured.pair.white_level > 0) pipeline().set_white_level(captured.pair.white_level);
    if (auto_mask_.apply(pairs_++, left, right, pipeline())) board_.set_static_mask(auto_mask_.record());
    pipeline().process(left, right, matched.result);
    captured.pair.white_level = pipeline().options().white_level;
  } catch (const SystemError&) {
    throw;
  } catch (const Error& error) {
    board_.count_rejected(error.what());
    return std::nullopt;
  }
  const bool is_first_masked = auto_mask_.record().share > 0 && auto_mask_.record().frame + 1 == pairs_;
  if (is_first_masked) matched.result.warnings.push_back(static_mask_warning(auto_mask_.record()));
  matched.spots = watch_.add(matched.result.grey, matched.result.right);
  matched.calibration = rectifier_->calibration();
  matched.captured = std::move(captured);
  return matched;
}

void Processing::match_pairs() {
  while (std::optional<CapturedPair> captured = captured_.take()) {
    std::optional<Matched> matched = match(std::move(*captured));
    if (matched && matched_.put(std::move(*matched))) board_.count_dropped();
  }
}

void Processing::match() {
  try {
    match_pairs();
  } catch (...) {
    matched_.close();
    throw;
  }
  matched_.close();
}

/// Joins the domain on first use, when the calibration is known.
void Processing::publish_messages(const Matched& matched, const DamageMap& map) {
  if (!options_.dds_domain) return;
  if (!messages_) messages_.emplace(*options_.dds_domain, matched.calibration);
  const io::SourcePair& pair = matched.captured.pair;
  messages_->publish(pair.left.view(), pair.white_level, matched.captured.clock_s, matched.result, map);
}

LiveView Processing::view_of(Matched& matched) {
  LiveView view;
  FrameResult& result = matched.result;
  view.warnings = std::move(result.warnings);
  view.health.spots = matched.spots;
  DamageMap map;
  find_damage_or_warn(result, matched.calibration, options_.pipeline.damage, options_.pipeline.threads, map,
                      view.health, view.warnings);
  publish_messages(matched, map);
  view.damages = std::move(map.damages);
  view.ids = std::move(map.ids);
  view.name = std::move(matched.captured.pair.name);
  view.arrival = matched.captured.arrival;
  view.clock_s = matched.captured.clock_s;
  view.left = std::move(matched.captured.pair.left);
  view.white_level = matched.captured.pair.white_level;
  view.transformed = std::move(result.transformed);
  view.delta_t = result.delta_t;
  if (!result.roll_found) return view;
  view.geometry = result.geometry;
  if (matched.calibration) view.plane = ground_plane(result.geometry.plane, *matched.calibration);
  return view;
}

/// What the view has left, to the third stage.
void Processing::hand_over(Matched matched) {
  if (!options_.trajectory) return;
  FrameResult& result = matched.result;
  FollowedFrame frame{std::move(result.grey), std::move(result.disparity), std::move(result.sigma), std::nullopt,
                      matched.captured.arrival};
  if (result.roll_found) frame.road = result.geometry.plane;
  static_cast<void>(followed_.put(std::move(frame)));
}

void Processing::finish() {
  try {
    while (std::optional<Matched> matched = matched_.take()) {
      board_.publish(view_of(*matched));
      hand_over(std::move(*matched));
    }
  } catch (...) {
    followed_.close();
    throw;
  }
  followed_.close();
}

void Processing::follow() {
  std::optional<PathFinder> finder;
  while (const std::optional<FollowedFrame> frame = followed_.take()) {
    if (!finder) finder.emplace(*rectifier_->calibration());
    if (SharedPath path = finder->add(*frame)) board_.set_path(std::move(path));
  }
}

}  // namespace roadstereo::cli
