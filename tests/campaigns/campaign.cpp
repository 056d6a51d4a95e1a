// tests/campaigns/campaign.cpp
#include "tests/campaigns/campaign.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>
#include <vector>

namespace cordis::test {

namespace {

/// Count, mean, median and largest of each.
void print(std::map<std::string, std::vector<double>>& figures) {
  for (auto& [name, values] : figures) {
    std::ranges::sort(values);
    const double mean =
        std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    std::printf("%-62s %5zu times, mean %8.3f, median %8.3f, largest %8.3f\n", name.c_str(),
                values.size(), mean, values[values.size() / 2], values.back());
  }
}

}  // namespace

int play_all(const CampaignOptions& options, const PlaySession& play) {
  std::mutex mutex;
  std::map<std::string, int> counts;
  std::map<std::string, std::vector<double>> figures;
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
      for (const auto& [name, values] : outcome.figures)
        figures[name].insert(figures[name].end(), values.begin(), values.end());
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
  print(figures);
  return options.sessions - counts["ok"];
}

}  // namespace cordis::test
