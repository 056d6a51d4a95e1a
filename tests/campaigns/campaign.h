// tests/campaigns/campaign.h -- what the campaigns have in common.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace cordis::test {

/// What a person asks of a campaign.
struct CampaignOptions {
  std::string programs = CORDIS_PROGRAM_DIR;  ///< the folder of cordis and its nodes
  int sessions = 1;
  int parallel = 1;
  double longest_s = 14.0;  ///< a process is stopped for
  double window_s = 16.0;   ///< in which processes are stopped, per session
  double simulated_s = 2.0;
  int faults = 20;  ///< number in each session
  std::uint32_t seed = 1;
  std::chrono::seconds patience{120};  ///< after which what does not go on counts as a hang
};

/// How one session ended: "ok", or one or two words for what went wrong.
struct Outcome {
  std::string word;
  std::string log;  ///< all its processes, and when they were stopped; empty when all is well
  std::map<std::string, std::vector<double>> figures{};  ///< what was measured, by its name
};

/// Session `index`, from its start to its end.
using PlaySession = std::function<Outcome(const CampaignOptions&, int index)>;

Outcome play_lockstep(const CampaignOptions& options, int index);
Outcome play_realtime(const CampaignOptions& options, int index);
Outcome play_faults(const CampaignOptions& options, int index);

/// Plays all sessions, prints each failure with its log, a count of all outcomes and the figures.
/// @return the number that was not "ok"
int play_all(const CampaignOptions& options, const PlaySession& play);

}  // namespace cordis::test
