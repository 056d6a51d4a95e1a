// device_node/main.cpp -- the gesture process: one device of a session.
#include <string>
#include <utility>

#include "device_node/device.h"
#include "device_node/device_config.h"
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
  cordis::node::claim(
      "cordis/" + std::to_string(start.launch.domain) + "/" + start.launch.session + "/" + name,
      "a node named '" + name + "' already runs in session '" + start.launch.session +
          "' of domain " + std::to_string(start.launch.domain));
  cordis::dds::Participant participant(start.membership());
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
