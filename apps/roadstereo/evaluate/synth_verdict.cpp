#include "evaluate/synth_verdict.hpp"

#include <fmt/core.h>

#include "evaluate/score_columns.hpp"
#include "roadstereo/io/peer_matchers.hpp"

namespace roadstereo::cli {
namespace {

/// A figure that is compared, the smaller the better.
struct Contest {
  Column column;
  double (*figure)(const DisparityScore& score);
  int decimals;
  bool on_common_pixels;
};

const std::vector<Contest>& contests() {
  constexpr double percent = 100;
  static const std::vector<Contest> all{
      {{"e_p+(0.5) %", "e_p_or_missing_0.5px"},
       [](const DisparityScore& score) { return percent * score.bad_or_missing_share[0]; },
       3,
       false},
      {{"e_p+(1) %", "e_p_or_missing_1px"},
       [](const DisparityScore& score) { return percent * score.bad_or_missing_share[1]; },
       3,
       false},
      {{"e_r px", "e_r"}, [](const DisparityScore& score) { return score.rms_px; }, 3, false},
      {{"e_r px, common pixels", "e_r_common"}, [](const DisparityScore& score) { return score.rms_px; }, 3, true},
  };
  return all;
}

/// "best", or who is better and by how much.
std::string outcome(const Contest& contest, const std::vector<DisparityScore>& scores) {
  const double ours = contest.figure(scores[method_index("default")]);
  std::string best_peer;
  double best = ours;
  for (const std::string& peer : io::peer_names()) {
    const double theirs = contest.figure(scores[method_index(peer)]);
    if (!(theirs < best)) continue;
    best = theirs;
    best_peer = peer;
  }
  if (best_peer.empty()) return "best";
  return fmt::format("{} {:.{}f} against {:.{}f}", best_peer, best, contest.decimals, ours, contest.decimals);
}

}  // namespace

SynthVerdict judge_default(const std::string& kind, const ScoresByGroup& scores, const ScoresByGroup& common) {
  SynthVerdict verdict{{"Is the default preset the best among OpenCV's matchers? " + kind, {{"group", "group"}}, {}},
                       ""};
  std::vector<std::size_t> won(contests().size(), 0);
  std::size_t won_whole = 0;
  for (const Contest& contest : contests()) verdict.table.columns.push_back(contest.column);
  for (std::size_t group = 0; group < scores.size(); ++group) {
    verdict.table.rows.push_back({Cell(synth_groups()[group].name)});
    bool whole = true;
    for (std::size_t i = 0; i < contests().size(); ++i) {
      const std::string text = outcome(contests()[i], (contests()[i].on_common_pixels ? common : scores)[group]);
      won[i] += text == "best" ? 1 : 0;
      whole = whole && text == "best";
      verdict.table.rows.back().emplace_back(text);
    }
    won_whole += whole ? 1 : 0;
  }
  verdict.summary = fmt::format("{}: of {} groups, {} won in every figure;", kind, scores.size(), won_whole);
  for (std::size_t i = 0; i < won.size(); ++i) {
    verdict.summary += fmt::format("{} {}: {}", i == 0 ? "" : ",", contests()[i].column.heading, won[i]);
  }
  return verdict;
}

}  // namespace roadstereo::cli
