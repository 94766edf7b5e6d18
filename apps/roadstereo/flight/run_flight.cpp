#include "flight/run_flight.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "auto_mask.hpp"
#include "core/parallel.hpp"
#include "first_exception.hpp"
#include "flight/bounded_queue.hpp"
#include "flight/finish_frame.hpp"
#include "flight/flight_job.hpp"
#include "flight/flight_motion.hpp"
#include "flight/match_frame.hpp"
#include "flight/sequencer.hpp"
#include "mask_file.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/flight_pictures.hpp"

namespace roadstereo::cli {

namespace {

using JobPointer = std::unique_ptr<FlightJob>;

/// Threads of a flight: reader → matcher → finishers → writer in order.
class FlightPipeline {
 public:
  FlightPipeline(const FlightSettings& settings, Flight& flight);
  bool run();

 private:
  void require_unchanged(const std::optional<io::SourcePair>& again) const;
  void seek();
  void read();
  void match();
  AutoMask make_mask() const;
  void reject_other_size(io::SourcePair& pair) const;
  void match_again(const io::SourcePair& pair, Pipeline& pipeline, FlightJob& job);
  void add_pose(FlightJob& job);
  void finish();
  void commit_frame(FlightJob& job);
  void add_pictures(FlightJob& job, const std::vector<std::int64_t>& road_damages);
  void stop_all();
  template <class Work>
  void run_stage(const Work& work);

  const FlightSettings& settings_;
  Flight& flight_;

  int finishers_;
  bool from_first_;  ///< reads the frames of an earlier run again
  bool reached_end_ = false;
  int width_ = 0, height_ = 0;                 ///< of the first good pair
  const std::optional<io::FlightFrame> last_;  ///< of an earlier run
  FlightMotion motion_;
  BoundedQueue<io::SourcePair> pairs_;  ///< from reader to matcher
  BoundedQueue<JobPointer> matched_;    ///< from matcher to finishers
  BoundedQueue<JobPointer> free_;       ///< unused jobs
  Sequencer sequencer_;
  FirstException failure_;
};

/// Allocates memory and threads before the first frame.
void warm_up(Pipeline& pipeline, const io::SourcePair& pair) {
  try {
    pipeline.warm_up(pair.left.width, pair.left.height);
  } catch (const Error&) {  // an invalid size is reported when the pair is processed
  }
}

int finisher_count(const PipelineOptions& options) {
  constexpr int max_finishers = 4;
  return std::clamp(resolve_threads(options.threads) / 2, 1, max_finishers);
}

/// A trajectory needs the frames of an earlier run again, and so does a static mask until it is known.
bool needs_frames_again(const FlightSettings& settings, const Flight& flight) {
  const std::optional<io::FlightFrame> last = flight.record.last();
  return settings.trajectory || (flight.plan.auto_mask && last && !last->static_mask.judged);
}

FlightPipeline::FlightPipeline(const FlightSettings& settings, Flight& flight)
    : settings_(settings),
      flight_(flight),
      finishers_(finisher_count(flight.plan.options)),
      from_first_(needs_frames_again(settings, flight)),
      last_(flight.record.last()),
      motion_(settings, flight, last_),
      pairs_(3),
      matched_(static_cast<std::size_t>(finishers_)),
      free_(static_cast<std::size_t>(2 * finishers_) + 1),
      sequencer_(flight.record.frames()) {
  for (int i = 0; i < 2 * finishers_ + 1; ++i) free_.put(std::make_unique<FlightJob>());
}

void FlightPipeline::stop_all() {
  pairs_.abandon();
  matched_.abandon();
  free_.abandon();
  sequencer_.cancel();
}

/// Runs `work`; an exception stops all threads.
template <class Work>
void FlightPipeline::run_stage(const Work& work) {
  failure_.run(work, [this] { stop_all(); });
}

/// Throws Error unless the pair is the last one of an earlier run.
void FlightPipeline::require_unchanged(const std::optional<io::SourcePair>& again) const {
  if (again && io::valid_utf8(again->name) == last_->name) return;
  fail(settings_.source[0], ": the source has changed since this flight was started: frame ", last_->index, " was \"",
       last_->name, "\" and is now ", again ? "\"" + again->name + "\"" : "missing", "; start again without --resume");
}

/// Skips to the last frame of an earlier run, which the motion goes on from, unless all its frames are needed again.
void FlightPipeline::seek() {
  io::FrameSource& source = flight_.source.source();
  if (!last_ || from_first_) return source.skip(settings_.from);
  flight_.source.set_white_level(last_->white_level);
  source.skip(last_->index);
  std::optional<io::SourcePair> again = flight_.source.next();
  require_unchanged(again);
  pairs_.put(std::move(*again));
  source.skip(settings_.every - 1);
}

void FlightPipeline::read() {
  io::FrameSource& source = flight_.source.source();
  seek();
  while (!flight_.stop.wait(0)) {
    std::optional<io::SourcePair> pair = flight_.source.next();
    if (!pair || (settings_.to && pair->index > *settings_.to)) {
      reached_end_ = true;
      break;
    }
    if (last_ && pair->index == last_->index) require_unchanged(pair);
    if (!pairs_.put(std::move(*pair))) break;
    if (settings_.every > 1) source.skip(settings_.every - 1);
  }
  pairs_.close();
}

/// The mask that an earlier run has found, unless the frames that showed it are matched again.
AutoMask FlightPipeline::make_mask() const {
  AutoMask mask(flight_.plan.auto_mask);
  if (!last_ || from_first_) return mask;
  const io::StaticMaskRecord& record = last_->static_mask;
  const int white = 255;
  mask.restore(record, record.applied ? read_mask((flight_.folder.path() / static_mask_file).string(), white)
                                      : Image<std::uint8_t>());
  return mask;
}

void FlightPipeline::match() {
  std::optional<Pipeline> pipeline;
  PairWatch watch;
  AutoMask auto_mask = make_mask();
  const std::int64_t done = flight_.record.frames();
  std::int64_t sequence = from_first_ ? 0 : done;  // a trajectory begins anew, with the same results
  while (std::optional<io::SourcePair> pair = pairs_.take()) {
    std::optional<JobPointer> job = free_.take();
    if (!job) break;
    if (!pipeline && pair->error.empty()) {  // the size is known now
      PipelineOptions options = flight_.plan.options;
      const Image<std::uint8_t>& mask = flight_.plan.mask;
      require_mask_size(settings_, mask, pair->left.width, pair->left.height);
      if (options.rig_bias) {
        options.rig_bias->require_rig(pair->left.width, pair->left.height, flight_.source.calibration());
      }
      pipeline.emplace(options, flight_.source.calibration());
      width_ = pair->left.width;
      height_ = pair->left.height;
      if (!mask.empty()) pipeline->set_mask(mask);
      warm_up(*pipeline, *pair);
      if (last_ && (sequence == done || !settings_.trajectory)) pipeline->restore(last_->pipeline_state);
    }
    if (pipeline && pair->white_level > 0) pipeline->set_white_level(pair->white_level);
    const bool is_again = !settings_.trajectory && last_ && pair->index <= last_->index;
    if (is_again && from_first_) {
      if (pair->error.empty()) auto_mask.look(pair->left.view(), pair->right.view(), pipeline->options().white_level);
      ++sequence;
    }
    if (is_again) {
      if (pipeline && pair->index == last_->index) match_again(*pair, *pipeline, **job);
      free_.put(std::move(*job));
      continue;
    }
    (*job)->sequence = sequence++;
    (*job)->pair = std::move(*pair);
    if (pipeline) {
      if (settings_.trajectory) reject_other_size((*job)->pair);
      match_frame(*pipeline, flight_.source.calibration(), watch, auto_mask, **job);
      add_pose(**job);
    } else {
      record_rejected(last_, **job);
    }
    if ((*job)->sequence < done) {
      free_.put(std::move(*job));
      continue;
    }
    if (!matched_.put(std::move(*job))) break;
  }
  matched_.close();
}

/// A trajectory is that of frames of one size.
void FlightPipeline::reject_other_size(io::SourcePair& pair) const {
  if (!pair.error.empty() || (pair.left.width == width_ && pair.left.height == height_)) return;
  pair.error = fmt::format("the image has {}×{} pixels, but the trajectory is that of {}×{}", pair.left.width,
                           pair.left.height, width_, height_);
}

/// Matches the last frame of an earlier run again, so that the motion goes on from it. The state of the pipeline stays.
void FlightPipeline::match_again(const io::SourcePair& pair, Pipeline& pipeline, FlightJob& job) {
  if (!last_->pose || !pair.error.empty()) return;
  pipeline.process(pair.left.view(), pair.right.view(), job.result);
  job.frame = *last_;
  add_pose(job);
  pipeline.restore(last_->pipeline_state);
}

/// The motion is that of frames of one size.
void FlightPipeline::add_pose(FlightJob& job) {
  if (job.frame.status != io::FrameStatus::good) return;
  if (job.result.grey.width() == width_ && job.result.grey.height() == height_) motion_.add_pose(job);
}

void FlightPipeline::finish() {
  while (std::optional<JobPointer> job = matched_.take()) {
    finish_frame(flight_.source.calibration(), flight_.plan, **job);
    sequencer_.run_in_order((*job)->sequence, [&] { commit_frame(**job); });
    free_.put(std::move(*job));
  }
}

/// Writes the files before the journal entry, so that the files of all journal entries are complete.
void FlightPipeline::commit_frame(FlightJob& job) {
  flight_.record.begin();
  add_pictures(job, flight_.results.add(job.frame));
  flight_.folder.write(job.files);
  flight_.record.append(job.frame, job.mcap_chunk);
  flight_.progress.frame_done(job.frame.status == io::FrameStatus::good);
}

/// Adds thumbnails, and image and section of each damage from its best frame so far.
void FlightPipeline::add_pictures(FlightJob& job, const std::vector<std::int64_t>& road_damages) {
  if (job.frame.status != io::FrameStatus::good) return;
  const FrameView left = job.pair.left.view();
  const double white_level = job.frame.white_level;
  if (const auto name = thumbnail_name(job.sequence)) {
    job.files.push_back({*name, io::frame_thumbnail(left, white_level, job.damage)});
  }
  io::DamageReportInput input{job.damage};
  input.left = left;
  input.white_level = white_level;
  input.disparity = job.result.disparity;
  input.calibration = flight_.source.calibration();
  for (std::size_t i = 0; i < job.frame.damages.size(); ++i) {
    const io::RoadDamage& known = flight_.results.inventory().damages()[static_cast<std::size_t>(road_damages[i]) - 1];
    if (known.frame != job.frame.index) continue;
    const Damage& damage = job.frame.damages[i];
    job.files.push_back({damage_picture_name(known.id), io::damage_picture(left, white_level, job.damage, damage)});
    job.files.push_back(text_file(damage_section_name(known.id), io::road_damage_section(input, damage, known.id)));
  }
}

bool FlightPipeline::run() {
  std::vector<std::thread> threads;
  run_stage([&] {  // the system may refuse a thread
    threads.emplace_back([this] { run_stage([this] { read(); }); });
    for (int i = 0; i < finishers_; ++i) {
      threads.emplace_back([this] { run_stage([this] { finish(); }); });
    }
  });
  run_stage([this] { match(); });
  for (std::thread& thread : threads) thread.join();
  failure_.rethrow();
  flight_.record.begin();  // of a source without frames
  return reached_end_;
}

}  // namespace

bool run_flight(const FlightSettings& settings, Flight& flight) {
  return FlightPipeline(settings, flight).run();
}

}  // namespace roadstereo::cli
