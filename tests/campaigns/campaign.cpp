// tests/campaigns/campaign.cpp
#include "tests/campaigns/campaign.h"

#include <atomic>
#include <cstdio>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace cordis::test {

int play_all(const CampaignOptions& options, const PlaySession& play) {
  std::mutex mutex;
  std::map<std::string, int> counts;
  int played = 0;
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int index = next++; index < options.sessions; index = next++) {
      Outcome outcome;
      try {
        outcome = play(options, index);
      } catch (const std::exception& error) {
        outcome = {"not played", error.what()};
      }
      const std::lock_guard lock(mutex);
      ++counts[outcome.word];
      if (outcome.word != "ok") {
        std::printf("---- session %d, seed %u: %s\n%s\n", index, options.seed, outcome.word.c_str(),
                    outcome.log.c_str());
      }
      std::string line;
      for (const auto& [word, count] : counts) {
        line.append(" ").append(std::to_string(count)).append(" ").append(word);
      }
      std::printf("%d of %d:%s\n", ++played, options.sessions, line.c_str());
      std::fflush(stdout);
    }
  };
  std::vector<std::thread> workers;
  for (int i = 0; i < options.parallel; ++i) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  return options.sessions - counts["ok"];
}

}  // namespace cordis::test
