// cli/run/running_nodes.cpp
#include "cli/run/running_nodes.h"

#include <stdexcept>

#include <unistd.h>

#include "node/instance_lock.h"

namespace cordis::cli {

void refuse_running_nodes(const RunPlan& plan, const std::string& session, int domain) {
  const std::string place = "cordis/" + std::to_string(domain) + "/" + session + "/";
  for (const PlannedNode& node : plan.nodes) {
    const bool simulates = node.program == "sim_node";
    const int lock = node::try_to_lock((place + (simulates ? "sim_node" : node.name)).c_str());
    if (lock < 0) {
      throw std::runtime_error("session '" + session + "' already runs in DDS domain " +
                               std::to_string(domain) + " with a " +
                               (simulates ? "sim_node" : "node named '" + node.name + "'") +
                               " of another user; stop it, or give this one session=NAME");
    }
    close(lock);
  }
}

}  // namespace cordis::cli
