// tests/campaigns/main.cpp -- plays many sessions whose processes stall or die now and then, and
// counts those that hang, abort or do not recover.
//
//   build/release/bin/session_campaign lockstep --sessions 400 --parallel 8 --longest 14 --seed 2
//   build/release/bin/session_campaign realtime --sessions 100 --parallel 4 --longest 12
//
//   build/release/bin/session_campaign faults --sessions 50 --faults 20 --parallel 3 --longest 12
//
// A realtime session stops each of its three nodes once. A session with faults kills and stops its
// nodes at random; every other one is in lockstep. A short form of each is part of the tests.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "tests/campaigns/campaign.h"
#include "tests/campaigns/leaks.h"

namespace {

constexpr int kMaxRealtime = 6;  // sessions with launcher, observer, three nodes and their restarts

int usage() {
  std::fputs(
      R"(usage: session_campaign lockstep|realtime|faults [--sessions N] [--parallel N] [--longest SECONDS]
       [--window SECONDS] [--simulated SECONDS] [--faults N] [--seed N] [--patience SECONDS]
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
    } else if (option == "--faults") {
      options.faults = static_cast<int>(value);
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
  const std::map<std::string, PlaySession> kinds{
      {"lockstep", play_lockstep}, {"realtime", play_realtime}, {"faults", play_faults}};
  if (!kinds.contains(kind)) return usage();
  if (kind != "lockstep" && options.parallel > kMaxRealtime) {
    std::fprintf(stderr, "session_campaign: the domain of the sessions has ports for %d at once\n",
                 kMaxRealtime);
    return 2;
  }
  const Leaks leaks;
  const int failed = play_all(options, kinds.at(kind));
  const std::string left = leaks.found();
  std::fputs(left.c_str(), stdout);
  return failed == 0 && left.empty() ? 0 : 1;
}
