// sim_node/checks/start_state.cpp
#include "sim_node/checks/start_state.h"

#include <bit>
#include <charconv>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

#include "node/assert.h"
#include "node/config/mapping_reader.h"
#include "node/config/yaml_reader.h"
#include "sim_node/engine/core/state_hash.h"
#include "sim_node/engine/world.h"
#include "sim_node/run/tick_division.h"

namespace cordis::sim {
namespace {

using config::Value;

constexpr std::size_t kDigits = 16;                      // of a value
constexpr std::size_t kValuesOfLine = 64;                // in the file
constexpr std::size_t kMaxBytes = std::size_t{1} << 30;  // 64 values of each of a million MATs
constexpr long kMaxSteps = 1L << 53;

std::string hex_text(std::uint64_t bits) {
  std::string text(kDigits, '0');
  for (std::size_t digit = kDigits; digit-- > 0; bits >>= 4U) {
    text[digit] = "0123456789abcdef"[bits & 15U];
  }
  return text;
}

/// A name as YAML reads it back, but for control characters.
std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char letter : name) {
    if (letter == '"' || letter == '\\') text += '\\';
    text += static_cast<unsigned char>(letter) < ' ' ? '?' : letter;
  }
  return text + "\"";
}

/// Nothing unless the text is 16 hexadecimal digits.
std::optional<std::uint64_t> bits_of(std::string_view text) {
  std::uint64_t bits = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, bits, 16);
  if (text.size() != kDigits || failure != std::errc() || stop != end) return std::nullopt;
  return bits;
}

/// A key that holds 16 hexadecimal digits.
std::uint64_t read_bits(config::MappingReader& reader, const std::string& key) {
  const std::string text = reader.required_text(key);
  const std::optional<std::uint64_t> bits = bits_of(text);
  if (!bits && reader.ok())
    reader.error_at(key, reader.name_of(key) + " must be 16 hexadecimal digits");
  return bits.value_or(0);
}

void read_values(config::MappingReader& reader, std::vector<double>& values) {
  const Value lines = reader.required_sequence("values");
  for (const Value& line : lines.items()) {
    const std::string& text = line.text();
    bool is_whole = line.kind() == Value::Kind::kScalar && text.size() % kDigits == 0;
    for (std::size_t i = 0; is_whole && i < text.size(); i += kDigits) {
      const auto bits = bits_of(std::string_view(text).substr(i, kDigits));
      is_whole = bits.has_value();
      if (bits) values.push_back(std::bit_cast<double>(*bits));
    }
    if (is_whole) continue;
    reader.error_at("values", reader.name_of("values") + " must be 16 hexadecimal digits each");
    return;
  }
}

/// True if a world of the scene can go on from there; if not, a problem.
bool fits(const scene::Scene& scene, const engine::Snapshot& snapshot,
          const std::string& scene_name, config::Problems& problems) {
  const auto network = std::make_shared<const engine::Network>(scene.network);
  if (network->fingerprint() != snapshot.network) {
    const bool has_same_name = quoted(scene.name) == quoted(scene_name);
    problems.error(scene.start_state_place,
                   "'" + scene.start_state_file + "' holds a state of " +
                       (has_same_name ? "'" + scene_name + "', which has changed since"
                                      : "another scene, '" + scene_name + "'"),
                   "a state fits the matter, links, start, step and integrator it was saved with");
    return false;
  }
  try {
    engine::World(network).restore(snapshot);
  } catch (const std::invalid_argument& refusal) {
    problems.error(scene.start_state_place,
                   "'" + scene.start_state_file + "' is damaged: " + refusal.what());
    return false;
  }
  if (!TickDivision(scene.step_rate_hz, scene.gesture_rate_hz).go_behind(snapshot.step)) {
    problems.error(scene.start_state_place,
                   "'" + scene.start_state_file + "' ends within a gesture period of this scene",
                   "write the gesture_rate_hz of the scene it was saved from");
    return false;
  }
  return true;
}

/// The hash of step and values.
std::uint64_t hash_of_all(const engine::Snapshot& snapshot) {
  std::vector<double> all = snapshot.state;
  all.push_back(std::bit_cast<double>(snapshot.step));
  return engine::hash_of(all);
}

}  // namespace

std::string state_file_text(const scene::Scene& scene, const engine::Snapshot& snapshot) {
  std::string text = "cordis_state: 1\nscene: " + quoted(scene.name) + "\nnetwork: \"" +
                     hex_text(snapshot.network) + "\"\nstep: " + std::to_string(snapshot.step) +
                     "\ncheck: \"" + hex_text(hash_of_all(snapshot)) + "\"\nvalues:";
  for (std::size_t i = 0; i < snapshot.state.size(); ++i) {
    if (i % kValuesOfLine == 0) text += i == 0 ? "\n  - \"" : "\"\n  - \"";
    text += hex_text(std::bit_cast<std::uint64_t>(snapshot.state[i]));
  }
  return text + (snapshot.state.empty() ? " []\n" : "\"\n");
}

void read_start_state(scene::Scene& scene, config::Problems& problems) {
  if (scene.start_state_file.empty()) return;
  const config::Problems::Reading reading(problems);
  CORDIS_ASSERT(scene.network.step > 0.0 && scene.step_rate_hz > 0.0);
  const std::filesystem::path file =
      std::filesystem::path(scene.file).parent_path() / scene.start_state_file;
  const std::size_t errors_before = problems.error_count();
  const Value root = config::load_file(file.string(), problems, scene.start_state_place, kMaxBytes);
  if (!root.exists()) return;
  config::MappingReader reader(root, "a file of a state", problems);
  reader.required_integer("cordis_state", 1, 1);
  const std::string scene_name = reader.required_text("scene");
  engine::Snapshot snapshot;
  snapshot.network = read_bits(reader, "network");
  snapshot.step = static_cast<std::uint64_t>(reader.required_integer("step", 0, kMaxSteps));
  const std::uint64_t check = read_bits(reader, "check");
  read_values(reader, snapshot.state);
  reader.finish();
  if (problems.error_count() != errors_before) return;
  if (check != hash_of_all(snapshot)) {
    reader.error_at("check",
                    reader.name_of("check") + " does not fit step and values: it is damaged");
    return;
  }
  if (!fits(scene, snapshot, scene_name, problems)) return;
  scene.start_state = std::make_shared<const engine::Snapshot>(std::move(snapshot));
}

}  // namespace cordis::sim
