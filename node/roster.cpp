// node/roster.cpp
#include "node/roster.h"

#include "node/status_words.h"

namespace cordis::node {

void Roster::update() {
  while (reader_.take(taken_)) nodes_[taken_.node()] = {taken_, Clock::now()};
}

std::vector<msg::NodeStatus> Roster::alive() const {
  std::vector<msg::NodeStatus> alive;
  const auto now = Clock::now();
  for (const auto& [name, known] : nodes_) {
    if (!has_ended(known.status.phase()) && now - known.taken <= lately_)
      alive.push_back(known.status);
  }
  return alive;
}

std::string Roster::name_of(msg::NodeKind kind) const {
  for (const msg::NodeStatus& status : alive()) {
    if (status.kind() == kind) return "'" + status.node() + "'";
  }
  return "";
}

}  // namespace cordis::node
