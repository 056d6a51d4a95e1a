// device_node/main.cpp -- the gesture process: one device of a session.
#include <string>
#include <utility>

#include "device_node/device.h"
#include "device_node/device_config.h"
#include "node/claim.h"
#include "node/command_listener.h"
#include "node/dds/participant.h"
#include "node/node_main.h"

namespace {

int run(const cordis::node::NodeStart& start, cordis::config::Problems& problems) {
  cordis::device::LoadedDevice device =
      cordis::device::load_device(start.launch, *start.node, problems);
  cordis::node::report(problems);
  if (start.check_only) return 0;

  const std::string& name = start.node->name;
  const std::string session =
      "cordis/" + std::to_string(start.launch.domain) + "/" + start.launch.session + "/";
  const std::string where = "' already runs in session '" + start.launch.session + "' of domain " +
                            std::to_string(start.launch.domain);
  cordis::node::claim(session + name, "a node named '" + name + where);
  const std::string strength = std::to_string(device.config.strength);
  cordis::node::claim(
      session + std::to_string(device.config.device_id) + "/" + strength,
      "a node that plays '" + device.config.name + "' with strength " + strength + where.substr(1));
  cordis::dds::Participant participant = start.join_for_force_loop();
  cordis::node::CommandListener commands(
      participant, "device_node", [](const cordis::msg::ControlCommand& command) {
        return cordis::node::nothing_to_do(command, "device_node");
      });
  commands.start();
  return cordis::device::Device(std::move(device), participant, start.launch.clock, start.run)
      .live();
}

}  // namespace

int main(int argc, char** argv) {
  return cordis::node::node_main(argc, argv, "device_node", &run);
}
