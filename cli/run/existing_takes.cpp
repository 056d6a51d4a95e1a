// cli/run/existing_takes.cpp
#include "cli/run/existing_takes.h"

#include <filesystem>

#include "record_node/record_config.h"
#include "record_node/take_files.h"

namespace cordis::cli {

std::vector<std::string> existing_takes(const config::Launch& launch, const RunPlan& plan) {
  std::vector<std::string> sentences;
  for (const PlannedNode& node : plan.nodes) {
    if (node.program != "record_node") continue;
    config::Problems known;  // the node itself has refused its section when it is wrong
    const std::string out = record::read_record_section(*launch.find(node.name), known).out;
    const std::filesystem::path wanted =
        record::wanted_take_path(out, launch.session, launch.directory);
    const std::filesystem::path free = record::free_take_path(wanted);
    if (free != wanted) sentences.push_back(record::existing_take_text(wanted, free));
  }
  return sentences;
}

}  // namespace cordis::cli
