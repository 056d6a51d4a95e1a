// viz_node/viz_config.cpp
#include "viz_node/viz_config.h"

#include <cerrno>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "node/config/mapping_reader.h"
#include "node/config/regular_file.h"
#include "node/config/yaml_reader.h"

namespace cordis::viz {
namespace {

bool is_address(const std::string& text) {
  in6_addr room{};
  return inet_pton(AF_INET, text.c_str(), &room) == 1 ||
         inet_pton(AF_INET6, text.c_str(), &room) == 1;
}

}  // namespace

VizConfig read_viz_config(const config::LaunchNode& node, config::Problems& problems) {
  VizConfig viz;
  config::MappingReader reader(node.section, "viz_node '" + node.name + "'", problems);
  viz.address = reader.optional_text("address", viz.address);
  viz.address_place = reader.has("address") ? reader.place_of("address") : node.place;
  viz.port = static_cast<int>(reader.optional_integer("port", viz.port, 0, 65535));
  viz.rate_hz = reader.optional_number("rate_hz", viz.rate_hz, config::Range::between(1.0, 240.0));
  for (const config::Value& scene : reader.optional_sequence("scenes").items()) {
    if (scene.kind() == config::Value::Kind::kScalar && !scene.text().empty()) {
      viz.rights.scenes.push_back(scene.text());
      viz.scene_places.push_back(scene.place());
    } else {
      problems.error(scene.place(), "scenes lists paths of scenes, got " + scene.described());
    }
  }
  viz.rights.parameters = reader.optional_truth("parameters", false);
  viz.foxglove = reader.optional_truth("foxglove", viz.foxglove);
  if (!is_address(viz.address)) {
    reader.error_at("address",
                    "address must be an IP address of this machine, got '" + viz.address + "'",
                    "127.0.0.1 for this machine alone, 0.0.0.0 for the whole network");
  }
  reader.finish();
  return viz;
}

void check_address(const VizConfig& viz, config::Problems& problems) {
  sockaddr_in v4{};
  v4.sin_family = AF_INET;
  sockaddr_in6 v6{};
  v6.sin6_family = AF_INET6;
  const bool is_v4 = inet_pton(AF_INET, viz.address.c_str(), &v4.sin_addr) == 1;
  if (!is_v4 && inet_pton(AF_INET6, viz.address.c_str(), &v6.sin6_addr) != 1) return;
  const int file = socket(is_v4 ? AF_INET : AF_INET6, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (file < 0) return;
  const int bound = is_v4 ? bind(file, reinterpret_cast<const sockaddr*>(&v4), sizeof v4)
                          : bind(file, reinterpret_cast<const sockaddr*>(&v6), sizeof v6);
  const bool is_elsewhere = bound != 0 && errno == EADDRNOTAVAIL;
  close(file);
  if (is_elsewhere)
    problems.error(viz.address_place, "this machine has no address " + viz.address,
                   "127.0.0.1 for this machine alone, 0.0.0.0 for the whole network");
}

void check_scene_files(const config::Launch& launch, const VizConfig& viz,
                       config::Problems& problems) {
  for (std::size_t i = 0; i < viz.rights.scenes.size(); ++i) {
    const std::string path = launch.resolve(viz.rights.scenes[i]).string();
    if (!launch.network && launch.find_below(viz.rights.scenes[i]).empty()) {
      problems.error(viz.scene_places[i],
                     "'" + viz.rights.scenes[i] + "' is not below '" +
                         launch.real_folder().string() +
                         "', the folder of the launch file, from where alone scenes are loaded");
      continue;
    }
    const std::string reason = config::read_regular_file(path, config::kMaxFileBytes).reason;
    if (reason.empty()) continue;
    const std::string text = "cannot read '" + path + "': " + reason;
    if (launch.network) {
      problems.warning(viz.scene_places[i], text, "sim_node loads it, on its own host");
    } else {
      problems.error(viz.scene_places[i], text);
    }
  }
}

}  // namespace cordis::viz
