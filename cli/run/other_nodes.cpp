// cli/run/other_nodes.cpp
#include "cli/run/other_nodes.h"

#include <utility>

#include "node/status_words.h"

namespace cordis::cli {

OtherNodes::OtherNodes(const std::vector<OtherNode>& nodes, std::string launch_words, Time now)
    : launch_words_(std::move(launch_words)), begun_(now) {
  for (const OtherNode& node : nodes) nodes_[node.name].required = node.required;
}

std::optional<std::string> OtherNodes::take(const msg::NodeStatus& status, Time now) {
  const auto found = nodes_.find(status.node());
  if (found == nodes_.end()) return std::nullopt;
  Known& node = found->second;
  node.last = now;
  const bool is_there = !node::has_ended(status.phase());
  const bool was_there = std::exchange(node.is_there, is_there);
  // The last status of an earlier life is kept for late joiners: that is no life seen.
  const bool was_seen = std::exchange(node.seen, node.seen || is_there);
  if (is_there == was_there) return std::nullopt;
  if (!is_there) return status.node() + " has ended on " + status.host();
  return status.node() + (was_seen ? " is back on " : " runs on ") + status.host();
}

std::vector<std::string> OtherNodes::update(Time now) {
  std::vector<std::string> sentences;
  std::string missing;
  for (auto& [name, node] : nodes_) {
    if (node.is_there && now >= node.last + kSilentAfter) {
      node.is_there = false;
      sentences.push_back(name + ": no status for " + std::to_string(kSilentAfter.count()) +
                          " s; its process, its host or the network is gone");
    }
    if (node.required && !node.seen) missing += (missing.empty() ? "" : ",") + name;
  }
  if (now < begun_ + kMissedAfter || std::exchange(has_reported_missing_, true)) return sentences;
  if (!missing.empty())
    sentences.push_back("no launcher has started " + missing +
                        " yet: start the rest with `cordis run " + launch_words_ + " --only " +
                        missing + "`, here or on another host");
  return sentences;
}

}  // namespace cordis::cli
