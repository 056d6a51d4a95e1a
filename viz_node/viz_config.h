// viz_node/viz_config.h -- the section of a viz_node in a launch file.
#pragma once

#include <string>
#include <vector>

#include "node/config/launch.h"
#include "node/config/problem.h"
#include "viz_node/page_text.h"

namespace cordis::viz {

/// Where the page is served, and how often it receives what moved.
struct VizConfig {
  std::string address = "127.0.0.1";  ///< IPv4 or IPv6 address to listen on; loopback keeps other
                                      ///< machines out
  config::Place address_place;        ///< where the address is written, or the section
  int port = 8080;                    ///< 0 takes any free port
  double rate_hz = 25.0;              ///< most frames per second that pages get
  PageRights rights;                  ///< rights of pages
  std::vector<config::Place> scene_places;  ///< where each of rights.scenes is written
  bool foxglove = false;                    ///< Foxglove may read the topics of the session
};

/// Reads the section, in which every key is optional. What is wrong goes to `problems`.
VizConfig read_viz_config(const config::LaunchNode& node, config::Problems& problems);

/// A problem where the address is none of this machine.
void check_address(const VizConfig& viz, config::Problems& problems);

/// A problem for each of `scenes` that does not lie below the folder of the launch file, or whose file
/// cannot be read. Where the launch file has a `network`, sim_node may load the scene on another host:
/// a file that cannot be read is a warning there, and its folder is not looked at.
void check_scene_files(const config::Launch& launch, const VizConfig& viz,
                       config::Problems& problems);

}  // namespace cordis::viz
