#include "flight/run_flight.hpp"

#include <algorithm>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "flight/bounded_queue.hpp"
#include "flight/finish_frame.hpp"
#include "flight/flight_job.hpp"
#include "flight/in_turn.hpp"
#include "flight/match_frame.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/flight_pictures.hpp"

namespace roadstereo::cli {

namespace {

using JobPointer = std::unique_ptr<FlightJob>;

/// The first thing that went wrong in any thread.
class FirstFailure {
 public:
  void keep(std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
  }
  void rethrow() {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr failure_;
};

/// The threads of one flight and what goes to and fro between them.
class Line {
 public:
  Line(const FlightSettings& settings, Flight& flight);
  bool run();

 private:
  void seek(io::FrameSource& source) const;
  void read();
  void match();
  void finish();
  void commit_frame(FlightJob& job);
  void add_pictures(FlightJob& job, const std::vector<std::int64_t>& road_damages);
  void stop_all();
  template <class Work>
  void guarded(const Work& work);

  const FlightSettings& settings_;
  Flight& flight_;
  std::vector<FrameFile> write_;
  int finishers_;
  bool reached_end_ = false;
  BoundedQueue<io::SourcePair> pairs_;  ///< read, to be matched
  BoundedQueue<JobPointer> matched_;    ///< to be finished
  BoundedQueue<JobPointer> free_;       ///< jobs whose memory is not in use
  Sequencer in_turn_;
  FirstFailure failure_;
};

/// Makes memory and threads before the first frame, which would else take longer than the others.
void warm_up(Pipeline& pipeline, const io::SourcePair& pair) {
  try {
    pipeline.warm_up(pair.left.width, pair.left.height);
  } catch (const Error&) {  // of a size that the pair itself is about to be refused for, with its name
  }
}

int finisher_count(const PipelineOptions& options) {
  constexpr int most = 4;
  return std::clamp(used_threads(options) / 2, 1, most);
}

Line::Line(const FlightSettings& settings, Flight& flight)
    : settings_(settings),
      flight_(flight),
      finishers_(finisher_count(flight.options)),
      pairs_(3),
      matched_(static_cast<std::size_t>(finishers_)),
      free_(static_cast<std::size_t>(2 * finishers_) + 1),
      in_turn_(flight.journal.frames()) {
  for (const std::string& name : settings.write) write_.push_back(frame_file(name));
  for (int i = 0; i < 2 * finishers_ + 1; ++i) free_.put(std::make_unique<FlightJob>());
}

void Line::stop_all() {
  pairs_.abandon();
  matched_.abandon();
  free_.abandon();
  in_turn_.break_off();
}

/// A thread that fails takes the others with it.
template <class Work>
void Line::guarded(const Work& work) {
  try {
    work();
  } catch (...) {
    failure_.keep(std::current_exception());
    stop_all();
  }
}

/// Behind the last frame of an earlier run, which must still be what it was.
void Line::seek(io::FrameSource& source) const {
  const std::optional<io::FlightFrame>& last = flight_.journal.last();
  if (!last) return source.skip(settings_.from);
  source.skip(last->index);
  const std::optional<io::SourcePair> again = source.next();
  if (!again || again->name != last->name) {
    fail(settings_.source[0], ": has changed since this flight was begun: frame ", last->index, " was \"", last->name,
         "\" and is now ", again ? "\"" + again->name + "\"" : "missing", "; begin anew without --resume");
  }
  source.skip(settings_.every - 1);
}

void Line::read() {
  io::FrameSource& source = flight_.source.source();
  seek(source);
  while (!flight_.stop.wait(0)) {
    std::optional<io::SourcePair> pair = flight_.source.next();
    if (!pair || (settings_.to && pair->index > *settings_.to)) {
      reached_end_ = true;
      break;
    }
    if (!pairs_.put(std::move(*pair))) break;
    if (settings_.every > 1) source.skip(settings_.every - 1);
  }
  pairs_.close();
}

void Line::match() {
  const std::optional<io::FlightFrame> before = flight_.journal.last();  // the journal grows from here on
  std::optional<Pipeline> pipeline;
  std::int64_t place = flight_.journal.frames();
  while (std::optional<io::SourcePair> pair = pairs_.take()) {
    std::optional<JobPointer> job = free_.take();
    if (!job) break;
    if (!pipeline && pair->refused.empty()) {  // white and the size are known from the first good pair on
      if (!sets_white_level(settings_.processing)) flight_.options.white_level = flight_.source.white_level();
      pipeline.emplace(flight_.options, flight_.source.calibration());
      warm_up(*pipeline, *pair);
      if (before) pipeline->restore(before->carried);
    }
    (*job)->place = place++;
    (*job)->pair = std::move(*pair);
    if (pipeline) {
      match_frame(*pipeline, flight_.source.calibration(), **job);
    } else {
      record_refused(before, **job);
    }
    if (!matched_.put(std::move(*job))) break;
  }
  matched_.close();
}

void Line::finish() {
  while (std::optional<JobPointer> job = matched_.take()) {
    finish_frame(flight_.source.calibration(), flight_.options, write_, **job);
    in_turn_.run_in_order((*job)->place, [&] { commit_frame(**job); });
    free_.put(std::move(*job));
  }
}

/// Files first: what the journal has is whole.
void Line::commit_frame(FlightJob& job) {
  add_pictures(job, flight_.inventory.add(job.frame));
  flight_.folder.write(job.files);
  flight_.journal.append(job.frame);
  flight_.progress.frame_done(job.frame.status == io::FrameStatus::good);
}

/// A small picture now and then, and one of each damage from the frame that shows it best so far.
void Line::add_pictures(FlightJob& job, const std::vector<std::int64_t>& road_damages) {
  if (job.frame.status != io::FrameStatus::good) return;
  const FrameView left = job.pair.left.view();
  if (const auto name = thumbnail_name(job.place)) {
    job.files.push_back({*name, io::frame_thumbnail(left, job.damage)});
  }
  for (std::size_t i = 0; i < road_damages.size(); ++i) {
    const io::RoadDamage& known = flight_.inventory.damages()[static_cast<std::size_t>(road_damages[i]) - 1];
    if (known.frame != job.frame.index) continue;
    job.files.push_back({damage_picture_name(known.id), io::damage_picture(left, job.damage, job.frame.damages[i])});
  }
}

bool Line::run() {
  std::vector<std::thread> threads;
  threads.emplace_back([this] { guarded([this] { read(); }); });
  for (int i = 0; i < finishers_; ++i) {
    threads.emplace_back([this] { guarded([this] { finish(); }); });
  }
  guarded([this] { match(); });
  for (std::thread& thread : threads) thread.join();
  failure_.rethrow();
  return reached_end_;
}

}  // namespace

bool run_flight(const FlightSettings& settings, Flight& flight) {
  return Line(settings, flight).run();
}

}  // namespace roadstereo::cli
