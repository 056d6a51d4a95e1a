// tests/integration/status_watch.cpp
#include "tests/integration/status_watch.h"

#include <cstdio>

#include "tests/support/eventually.h"

namespace cordis::test {

void StatusWatch::take_all() {
  msg::NodeStatus status;
  while (reader_.take(status)) newest_[status.node()] = status;
}

bool StatusWatch::wait_for(const std::string& node,
                           const std::function<bool(const msg::NodeStatus&)>& condition) {
  const bool is_fulfilled = eventually([&] {
    take_all();
    const auto found = newest_.find(node);
    return found != newest_.end() && condition(found->second);
  });
  if (!is_fulfilled) print(node);
  return is_fulfilled;
}

/// What is known of a node that never fulfilled a condition: whether it was silent, or what it said.
void StatusWatch::print(const std::string& node) const {
  std::fprintf(stderr, "%d writers of node/status;", reader_.matched_count());
  const auto found = newest_.find(node);
  if (found == newest_.end()) {
    std::fprintf(stderr, " none has come of '%s'\n", node.c_str());
    return;
  }
  const msg::NodeStatus& status = found->second;
  std::fprintf(stderr, " the newest of '%s': number %llu, phase %d, %llu ticks, \"%s\"\n",
               node.c_str(), static_cast<unsigned long long>(status.sequence_number()),
               status.phase(), static_cast<unsigned long long>(status.ticks()),
               status.text().c_str());
}

bool StatusWatch::wait_for_phase(const std::string& node, msg::NodePhase phase) {
  return wait_for(node, [&](const msg::NodeStatus& status) { return status.phase() == phase; });
}

}  // namespace cordis::test
