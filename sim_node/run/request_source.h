// sim_node/run/request_source.h -- what a request was made from, for whoever makes it again.
#pragma once

#include <string>
#include <vector>

#include "idl/control.h"
#include "node/config/problem.h"

namespace cordis::sim {

/// A scene as its files say it.
struct SceneSource {
  std::string scene_file;                 ///< which of the files it is
  std::vector<config::SourceFile> files;  ///< all that were read for it
  std::string integrator;                 ///< integrator in use
  double step_rate_hz = 0.0;              ///< likewise
};

/// The command behind a request.
struct RequestSource {
  msg::ControlVerb verb = msg::VERB_PAUSE;
  std::string argument;  ///< as in ControlCommand
  SceneSource scene;     ///< scene for VERB_LOAD
};

}  // namespace cordis::sim
