// record_node/scene_words.h -- what a take says of the scenes of its session, in words.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "record_node/mcap/records.h"

namespace cordis::record {

/// Reads scene/description and scene/inputs as they are recorded: metadata `cordis.scene` hold the
/// name, file, size and rates of a scene, `cordis.plan` the integrator and step rate it is played
/// with and the versions of the engine and of its hashes.
class SceneWords {
 public:
  /// The metadata that a message gives rise to: none where nothing in them is new. Cost: that of
  /// decoding for these two topics, else a comparison of words.
  std::vector<mcap::Metadata> read(const std::string& topic, std::span<const std::byte> payload);

 private:
  void read_description(std::span<const std::byte> payload);
  void read_inputs(std::span<const std::byte> payload);
  void add(const std::string& name, std::map<std::string, std::string> values);

  std::map<std::string, std::map<std::string, std::string>> last_;  // by the name of the metadata
  std::vector<mcap::Metadata> found_;
};

}  // namespace cordis::record
