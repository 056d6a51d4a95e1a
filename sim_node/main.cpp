// sim_node/main.cpp -- the physics process.
#include "node/instance_lock.h"
#include "node/node_main.h"
#include "sim_node/session.h"
#include "sim_node/sim_config.h"

namespace {

int run(const cordis::node::NodeStart& start, cordis::config::Problems& problems) {
  cordis::sim::SimConfig config = cordis::sim::read_sim_config(start.launch, *start.node, problems);
  cordis::node::report(problems);
  if (start.check_only) return 0;

  const std::string session = std::to_string(start.domain) + "/" + start.launch.session;
  cordis::node::lock_instance("cordis/" + session + "/sim_node",
                              "another sim_node already runs the session '" + start.launch.session +
                                  "' in domain " + std::to_string(start.domain) +
                                  "; stop it, or give this one session=NAME");
  return cordis::sim::Session(start, std::move(config)).run();
}

}  // namespace

int main(int argc, char** argv) {
  return cordis::node::node_main(argc, argv, "sim_node", run);
}
