#include "flight/flight_record.hpp"

#include <filesystem>

#include "flight/provenance.hpp"

namespace roadstereo::cli {

FlightRecord::FlightRecord(const FlightSettings& settings, const FlightPlan& plan, bool metric, FlightFolder& folder)
    : folder_(folder),
      made_with_(provenance(settings, plan.options)),
      with_mcap_(plan.mcap),
      topics_(io::flight_topics(metric, settings.trajectory)) {
  if (!settings.resume || !std::filesystem::exists(folder.journal())) return;
  journal_.emplace(io::FlightJournal::resume(folder.journal(), made_with_));
}

void FlightRecord::for_each(const std::function<void(const io::FlightFrame&)>& visit) const {
  if (journal_) journal_->for_each(visit);
}

void FlightRecord::resume_mcap(std::int64_t good) {
  if (!with_mcap_ || !journal_) return;
  mcap_.emplace(frames() == 0 ? io::McapWriter::begin(folder_.mcap(), topics_)
                              : io::McapWriter::resume(folder_.mcap(), topics_, good));
}

void FlightRecord::begin() {
  if (journal_) return;
  folder_.remove_earlier_flight();
  journal_.emplace(io::FlightJournal::begin(folder_.journal(), made_with_));
  if (with_mcap_) mcap_.emplace(io::McapWriter::begin(folder_.mcap(), topics_));
}

void FlightRecord::append(const io::FlightFrame& frame, std::span<const std::uint8_t> chunk) {
  if (!chunk.empty()) mcap_->append(chunk);
  journal_->append(frame);
}

void FlightRecord::finish() {
  if (mcap_) mcap_->finish();
}

}  // namespace roadstereo::cli
