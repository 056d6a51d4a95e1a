// tests/integration/status_watch.cpp
#include "tests/integration/status_watch.h"

#include "tests/support/eventually.h"

namespace cordis::test {

void StatusWatch::take_all() {
  msg::NodeStatus status;
  while (reader_.take(status)) newest_[status.node()] = status;
}

bool StatusWatch::wait_for(const std::string& node,
                           const std::function<bool(const msg::NodeStatus&)>& condition) {
  return eventually([&] {
    take_all();
    const auto found = newest_.find(node);
    return found != newest_.end() && condition(found->second);
  });
}

bool StatusWatch::wait_for_phase(const std::string& node, msg::NodePhase phase) {
  return wait_for(node, [&](const msg::NodeStatus& status) { return status.phase() == phase; });
}

}  // namespace cordis::test
