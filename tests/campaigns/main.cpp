// tests/campaigns/main.cpp -- plays many sessions whose processes stall now and then, and
// counts those that hang, abort or do not recover.
//
//   build/release/bin/stall_campaign lockstep --sessions 400 --parallel 8 --longest 14 --seed 2
//   build/release/bin/stall_campaign realtime --sessions 100 --parallel 4 --longest 12
//
// A realtime session stops each of its three nodes once. A short form of both is part of the tests.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "tests/campaigns/campaign.h"

namespace {

constexpr int kMaxRealtime = 6;  // sessions with launcher, observer, three nodes and their restarts

int usage() {
  std::fputs(
      R"(usage: stall_campaign lockstep|realtime [--sessions N] [--parallel N] [--longest SECONDS]
       [--window SECONDS] [--simulated SECONDS] [--seed N] [--patience SECONDS]
       [--programs FOLDER]
)",
      stderr);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace cordis::test;
  CampaignOptions options;
  if (argc % 2 != 0) return usage();
  const std::string kind = argv[1];
  for (int i = 2; i < argc; i += 2) {
    const std::string option = argv[i];
    const double value = std::strtod(argv[i + 1], nullptr);
    if (option == "--sessions") {
      options.sessions = static_cast<int>(value);
    } else if (option == "--parallel") {
      options.parallel = static_cast<int>(value);
    } else if (option == "--longest") {
      options.longest_s = value;
    } else if (option == "--window") {
      options.window_s = value;
    } else if (option == "--simulated") {
      options.simulated_s = value;
    } else if (option == "--seed") {
      options.seed = static_cast<std::uint32_t>(value);
    } else if (option == "--patience") {
      options.patience = std::chrono::seconds(static_cast<int>(value));
    } else if (option == "--programs") {
      options.programs = argv[i + 1];
    } else {
      return usage();
    }
  }
  if (kind != "lockstep" && kind != "realtime") return usage();
  if (kind == "realtime" && options.parallel > kMaxRealtime) {
    std::fprintf(stderr, "stall_campaign: the domain of the sessions has ports for %d at once\n",
                 kMaxRealtime);
    return 2;
  }
  return play_all(options, kind == "lockstep" ? play_lockstep : play_realtime) == 0 ? 0 : 1;
}
