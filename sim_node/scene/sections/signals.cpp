// sim_node/scene/sections/signals.cpp
#include "sim_node/scene/sections/signals.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "sim_node/scene/language/name.h"
#include "sim_node/scene/matter/point.h"
#include "sim_node/scene/sections/quantity_words.h"

namespace cordis::scene {

namespace {

using config::Value;
using engine::Vec3;

/// What `quantity` asks the owner for; nullptr after a problem.
const QuantityWord* read_quantity(config::MappingReader& reader, Owner owner) {
  const std::string word = reader.required_text("quantity");
  const QuantityWord* quantity = find_quantity(owner, word);
  if (quantity != nullptr || word.empty()) return quantity;
  const bool of_something =
      find_quantity(Owner::kMat, word) != nullptr || find_quantity(Owner::kLink, word) != nullptr;
  const bool forgot_of = owner == Owner::kScene && of_something;
  reader.error_at("quantity", std::string(name_of(owner)) + " has no quantity '" + word + "'",
                  forgot_of ? "say whose it is: of: name[3]"
                            : std::string("it has ") + list_of_quantities(owner));
  return nullptr;
}

/// The direction of a position, velocity or force; a port of one axis needs no `axis`.
void read_direction_of_signal(Assembly& assembly, config::MappingReader& reader, Signal& signal) {
  const std::vector<std::string> words = axis_words(assembly.scene.space());
  if (reader.has("axis")) {
    signal.direction = Vec3::Unit(reader.required_choice("axis", words).front() - 'x');
    return;
  }
  if (!take_own_direction(assembly.scene, signal)) reader.required_choice("axis", words);
}

/// Reads how often a signal is taken, and whether it is a sound.
void read_rate(config::MappingReader& reader, Signal& signal) {
  signal.is_sound = reader.optional_truth("sound", false);
  const std::string rate =
      reader.optional_choice("rate", signal.is_sound ? "step" : "gesture", {"gesture", "step"});
  if (rate == "step") signal.rate = SignalRate::kStep;
  if (signal.is_sound && rate == "gesture") {
    reader.error_at("rate", "a sound is taken after each step",
                    "write 'rate: step', or leave it out");
  }
  if (!reader.has("full_scale")) return;
  signal.full_scale = reader.required_number("full_scale", config::Range::positive());
  if (!signal.is_sound) {
    reader.error_at("full_scale", "'full_scale' is of a sound", "add 'sound: true'");
  }
}

void read_signal_of_set(Assembly& assembly, config::MappingReader& reader, const std::string& name,
                        std::uint32_t set, std::vector<Signal>& signals) {
  const QuantityWord* quantity = read_quantity(reader, Owner::kSet);
  const bool is_pieces = quantity != nullptr && quantity->quantity == Quantity::kPieces;
  Signal signal;
  signal.name = name;
  signal.index = set;
  if (quantity != nullptr) signal.quantity = quantity->quantity;
  if (is_pieces && reader.has("near_m")) {
    signal.near = reader.required_number("near_m", config::Range::positive());
  }
  const engine::SetLiaison& liaison = assembly.scene.network.sets[set];
  if (is_pieces && reader.has("near_m") && assembly.count_surfaces(liaison.set_p) > 0)
    reader.error_at("near_m", "surfaces are no pieces", "count bound pairs, without near_m");
  const std::uint32_t state_machine = liaison.state_machine;
  const bool binds = assembly.liaisons->pool().state_machines()[state_machine].states.size() > 1;
  if (quantity != nullptr && !binds && !reader.has("near_m")) {
    reader.error_at("quantity", "pairs of a liaison of one state are never bound",
                    "count pieces of balls nearer than near_m");
  }
  read_rate(reader, signal);
  reader.finish();
  signals.push_back(std::move(signal));
}

void read_count_of_links(config::MappingReader& reader, const std::string& name,
                         const Selection& picked, std::vector<Signal>& signals) {
  Signal signal;
  signal.name = name;
  Owner owner = Owner::kStateLink;
  for (const std::uint32_t link : picked.indices) {
    if (kind_of_link(link) != LinkKind::kState) owner = owner_of(kind_of_link(link));
    signal.state_links.push_back(index_of_link(link));
  }
  const QuantityWord* quantity = read_quantity(reader, owner);
  if (quantity != nullptr) signal.quantity = quantity->quantity;
  read_rate(reader, signal);
  reader.finish();
  signals.push_back(std::move(signal));
}

void read_signal(Assembly& assembly, const Value::Entry& entry, std::vector<Signal>& signals) {
  check_name(entry.key, entry.key_place, assembly.problems);
  config::MappingReader reader(entry.value, "signal '" + entry.key + "'", assembly.problems);
  const Value subject = reader.optional_value("of");
  const auto set = assembly.named_sets.find(subject.text());
  if (set != assembly.named_sets.end())
    return read_signal_of_set(assembly, reader, entry.key, set->second, signals);
  std::optional<Selection> picked;
  if (subject.exists()) {
    picked = select(subject, "'of' in " + reader.what(), true, assembly.names, assembly.problems);
    if (!picked) return;  // whose signal it is decides what else it may say
  }
  const bool is_link = picked && picked->kind == Named::kLinks;
  const std::string word = reader.optional_text("quantity", "");
  if (is_link && (word == "pieces" || word == "bonds")) {
    return read_count_of_links(reader, entry.key, *picked, signals);
  }
  const bool is_count = picked && !is_link && word == "pieces";
  if (picked && picked->count() != 1 && !is_count) {
    reader.error_at("of",
                    "a signal is of one MAT or one link, and " +
                        (subject.text().empty() ? "this list" : "'" + subject.text() + "'") +
                        " has " + std::to_string(picked->count()),
                    "pick one: " + assembly.names.word_of(picked->indices[0], is_link));
  }
  Owner owner = Owner::kScene;
  if (picked) owner = is_link ? owner_of(kind_of_link(picked->indices[0])) : Owner::kMat;

  Signal signal;
  signal.name = entry.key;
  signal.index = picked ? picked->indices[0] : 0;
  if (is_link) {
    signal.kind = kind_of_link(picked->indices[0]);
    signal.index = index_of_link(picked->indices[0]);
  }
  const QuantityWord* quantity = read_quantity(reader, owner);
  reader.optional_value("axis");
  if (is_count) {
    signal.mats = picked->indices;
    signal.near = reader.required_number("near_m", config::Range::positive());
  }
  if (quantity != nullptr) {
    signal.quantity = quantity->quantity;
    signal.unit = quantity->unit;
    if (quantity->has_direction) {
      read_direction_of_signal(assembly, reader, signal);
    } else if (reader.has("axis")) {
      reader.error_at("axis", std::string("the quantity '") + quantity->word + "' has no axis");
    }
  }
  read_rate(reader, signal);
  reader.finish();
  signals.push_back(std::move(signal));
}

}  // namespace

std::vector<Signal> read_signals(Assembly& assembly, const Value& section) {
  std::vector<Signal> signals;
  for (const Value::Entry& entry : section.entries()) read_signal(assembly, entry, signals);
  for (const Signal& signal : signals) {
    if (signal.quantity == Quantity::kForce)
      assembly.scene.network.kept_awake.push_back(signal.index);
  }
  const auto is_sound = [](const Signal& signal) { return signal.is_sound; };
  if (std::ranges::count_if(signals, is_sound) > static_cast<long>(kMaxSounds)) {
    assembly.problems.error(section.place(), "a scene has at most " + std::to_string(kMaxSounds) +
                                                 " signals with 'sound: true'");
  }
  return signals;
}

}  // namespace cordis::scene
