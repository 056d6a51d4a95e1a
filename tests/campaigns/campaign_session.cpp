// tests/campaigns/campaign_session.cpp
#include "tests/campaigns/campaign_session.h"

#include <cstdlib>
#include <fstream>
#include <thread>
#include <utility>

#include "node/status_words.h"
#include "tests/support/test_domain.h"

namespace cordis::test {

using namespace std::chrono_literals;

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "cordis-campaign-XXXXXX").string();
  path_ = mkdtemp(name.data());
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string Folder::add(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name) << text;
  return (path_ / name).string();
}

Statuses::Statuses(const std::string& session, std::vector<std::string> nodes)
    : nodes_(std::move(nodes)),
      participant_({own_domain(), session, "observer"}),
      reader_(participant_, dds::Topic::kStatus) {}

std::string Statuses::wait_until_all_go_on(std::chrono::seconds at_most) {
  const auto limit = std::chrono::steady_clock::now() + at_most;
  take();
  std::map<std::string, msg::NodeStatus> before = newest_;
  std::string missing;
  do {
    std::this_thread::sleep_for(20ms);
    take();
    missing.clear();
    for (const std::string& name : nodes_) {
      const msg::NodeStatus& now = newest_[name];
      msg::NodeStatus& then = before[name];
      if (now.phase() != msg::PHASE_RUNNING) then = now;  // counts from when it runs
      if (now.epoch() != then.epoch()) then = now;
      const bool goes_on = now.phase() == msg::PHASE_RUNNING && now.ticks() > then.ticks() &&
                           now.sequence_number() > then.sequence_number() + 1;
      if (!goes_on)
        missing = std::string(name).append(", which is ").append(node::word_of(now.phase()));
    }
  } while (!missing.empty() && std::chrono::steady_clock::now() < limit);
  return missing;
}

void Statuses::take() {
  msg::NodeStatus status;
  while (reader_.take(status)) newest_[status.node()] = status;
}

}  // namespace cordis::test
