#include "sim_node/scene/liaison.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "sim_node/scene/selection.h"

namespace cordis::scene {

namespace {

using config::Range;
using config::Value;

/// What each kind of liaison has. [Luc90 III.2.2 Modelisation of the material in its continuous
/// behaviour]
struct LiaisonKind {
  const char* name;
  bool has_stiffness;
  bool has_viscosity;
};
constexpr std::array<LiaisonKind, 3> kKinds{{
    {"spring", true, false},
    {"damper", false, true},
    {"spring_damper", true, true},
}};

constexpr const char* kStiffness = "stiffness_n_per_m";
constexpr const char* kViscosity = "viscosity_n_s_per_m";
constexpr const char* kRest = "rest_m";
constexpr const char* kTension = "tension_n";

const LiaisonKind& kind_named(const std::string& name) {
  return *std::find_if(kKinds.begin(), kKinds.end() - 1,
                       [&](const LiaisonKind& kind) { return name == kind.name; });
}

Range rest_range(int space) {
  return space == 1 ? Range{} : Range::not_negative();
}

std::string whole_path(const std::filesystem::path& path) {
  std::error_code failure;
  const std::filesystem::path whole = std::filesystem::weakly_canonical(path, failure);
  return failure ? path.string() : whole.string();
}

void read_rest(config::MappingReader& reader, LinkLaw& law, int space) {
  reader.optional_value(kRest);
  if (reader.has(kRest)) law.rest_length = reader.required_number(kRest, rest_range(space));
}

void read_tension(config::MappingReader& reader, LinkLaw& law) {
  reader.optional_value(kTension);
  if (!reader.has(kTension)) return;
  if (reader.has(kRest)) {
    reader.error_at(kTension, "either 'tension_n' or 'rest_m' can be given in " + reader.what());
  } else if (law.stiffness <= 0.0 && reader.ok()) {
    reader.error_at(kTension, "'tension_n' in " + reader.what() + " needs a stiffness > 0");
  }
  law.rest_length.reset();
  law.tension = reader.required_number(kTension);
}

/// Overrides of parameters that the kind of the liaison does not have.
void refuse_foreign_parameters(config::MappingReader& reader, const LiaisonKind& kind) {
  const auto refuse = [&](const char* key) {
    if (!reader.has(key)) return;
    reader.error_at(key, std::string("a ") + kind.name + " has no '" + key + "'");
  };
  if (!kind.has_viscosity) refuse(kViscosity);
  if (!kind.has_stiffness) {
    refuse(kStiffness);
    refuse(kRest);
    refuse(kTension);
  }
}

}  // namespace

void Liaisons::read_section(const Value& section, const std::string& file, int space) {
  open_files_.push_back(whole_path(file));
  known_files_.push_back(open_files_.back());
  if (section.exists() && section.kind() != Value::Kind::kMapping) {
    problems_.error(section.place(),
                    "'liaisons' must be a mapping of keys, got " + section.described());
  }
  for (const Value::Entry& entry : section.entries()) {
    if (entry.key != "include") {
      add(entry, space);
      continue;
    }
    const bool sequence = entry.value.kind() == Value::Kind::kSequence;
    for (const Value& path : sequence ? entry.value.items() : std::vector<Value>{entry.value}) {
      read_include(path, file, space);
    }
  }
  open_files_.pop_back();
}

void Liaisons::read_include(const Value& path, const std::string& from_file, int space) {
  if (path.kind() != Value::Kind::kScalar || path.text().empty()) {
    problems_.error(path.place(), "'include' must be the path of a file, got " + path.described());
    return;
  }
  const std::filesystem::path file = std::filesystem::path(from_file).parent_path() / path.text();
  const std::string whole = whole_path(file);
  if (std::find(open_files_.begin(), open_files_.end(), whole) != open_files_.end()) {
    problems_.error(path.place(), "'" + path.text() + "' includes itself");
    return;
  }
  if (std::find(known_files_.begin(), known_files_.end(), whole) != known_files_.end()) return;

  const Value root = config::load_file(file.string(), problems_, path.place());
  if (!root.exists()) {
    known_files_.push_back(whole);
    return;
  }
  config::MappingReader reader(root, "file of liaisons", problems_);
  reader.required_integer("cordis", 1, 1);
  read_section(reader.required_mapping("liaisons"), file.string(), space);
  reader.finish();
}

void Liaisons::add(const Value::Entry& entry, int space) {
  check_name(entry.key, entry.key_place, problems_);
  const auto [known, is_new] = liaisons_.try_emplace(entry.key);
  if (!is_new) {
    const config::Place& first = known->second.place;
    problems_.error(entry.key_place, "the liaison '" + entry.key + "' is defined twice",
                    "first defined at " + first.file + ":" + std::to_string(first.line));
    return;
  }
  Liaison& liaison = known->second;
  liaison.place = entry.key_place;
  config::MappingReader reader(entry.value, "liaison '" + entry.key + "'", problems_);
  std::vector<std::string> words;
  for (const LiaisonKind& kind : kKinds) words.emplace_back(kind.name);
  liaison.kind = reader.required_choice("kind", words);
  if (reader.ok()) {
    const LiaisonKind& kind = kind_named(liaison.kind);
    refuse_foreign_parameters(reader, kind);
    if (kind.has_stiffness)
      liaison.law.stiffness = reader.required_number(kStiffness, Range::not_negative());
    if (kind.has_viscosity)
      liaison.law.viscosity = reader.required_number(kViscosity, Range::not_negative());
    if (kind.has_stiffness) read_rest(reader, liaison.law, space);
    for (const char* key : {kStiffness, kViscosity, kRest}) reader.optional_value(key);
    reader.finish();
  }
  liaison.sound = reader.ok();
}

const Liaison* Liaisons::find(const Value& name) const {
  const auto found = liaisons_.find(name.text());
  if (name.kind() == Value::Kind::kScalar && found != liaisons_.end()) {
    return found->second.sound ? &found->second : nullptr;
  }
  std::vector<std::string> words;
  for (const auto& [word, liaison] : liaisons_) words.push_back(word);
  if (name.kind() != Value::Kind::kScalar) {
    problems_.error(name.place(), "a liaison is called by its name, got " + name.described());
  } else {
    problems_.error(name.place(), "no liaison is named '" + name.text() + "'",
                    config::did_you_mean(name.text(), words));
  }
  return nullptr;
}

std::optional<LinkLaw> read_law(config::MappingReader& reader, LawPlace place,
                                const Liaisons& liaisons, int space) {
  const bool sound_before = reader.ok();
  const Value name = place == LawPlace::kLink ? reader.required_value("liaison")
                                              : reader.optional_value("liaison");
  const Liaison* liaison = name.exists() ? liaisons.find(name) : nullptr;
  LinkLaw law;
  if (liaison != nullptr) {
    law = liaison->law;
    refuse_foreign_parameters(reader, kind_named(liaison->kind));
  }
  if (name.exists() || place == LawPlace::kLink) {
    law.stiffness = reader.optional_number(kStiffness, law.stiffness, Range::not_negative());
  } else {
    law.stiffness = reader.required_number(kStiffness, Range::not_negative());
  }
  law.viscosity = reader.optional_number(kViscosity, law.viscosity, Range::not_negative());
  read_rest(reader, law, space);
  if (place == LawPlace::kMatter) read_tension(reader, law);
  const bool liaison_missing = liaison == nullptr && (name.exists() || place == LawPlace::kLink);
  if (liaison_missing || (sound_before && !reader.ok())) return std::nullopt;
  return law;
}

engine::Link make_link(const LinkLaw& law, std::uint32_t a, std::uint32_t b,
                       const engine::Vec3& position_a, const engine::Vec3& position_b, int space) {
  const engine::Vec3 along = position_b - position_a;
  const double distance = space == 1 ? along.x() : along.norm();
  engine::Link link;
  link.mat_a = a;
  link.mat_b = b;
  link.stiffness = law.stiffness;
  link.viscosity = law.viscosity;
  link.rest_length = law.rest_length.value_or(distance);
  if (law.tension) link.rest_length = distance - *law.tension / law.stiffness;
  return link;
}

}  // namespace cordis::scene
