// sim_node/scene/liaisons/liaison.cpp
#include "sim_node/scene/liaisons/liaison.h"

#include <algorithm>
#include <utility>

#include "node/config/key_log.h"
#include "node/config/nearest_word.h"
#include "sim_node/scene/language/name.h"
#include "sim_node/scene/liaisons/include.h"
#include "sim_node/scene/liaisons/liaison_reader.h"

namespace cordis::scene {

namespace {

using config::Value;

constexpr std::size_t kMaxLikenesses = 64;  // of liaisons that are like each other

/// `base` with `own` laid on it: mappings merge unless they are of different kinds, everything else
/// is replaced.
Value laid_on(const Value& base, const Value& own, bool is_whole) {
  const bool mappings = base.kind() == Value::Kind::kMapping && own.kind() == Value::Kind::kMapping;
  const bool other_kind =
      own.find("kind").exists() && own.find("kind").text() != base.find("kind").text() && !is_whole;
  if (!mappings || other_kind) return own;
  std::vector<Value::Entry> entries = base.entries();
  for (const Value::Entry& entry : own.entries()) {
    if (is_whole && entry.key == "like") continue;
    const auto same = std::find_if(entries.begin(), entries.end(),
                                   [&](const auto& other) { return other.key == entry.key; });
    if (same == entries.end()) {
      entries.push_back(entry);
    } else {
      *same = {entry.key, entry.key_place, laid_on(same->value, entry.value, false)};
    }
  }
  return Value::mapping(std::move(entries), own.place());
}

}  // namespace

/// Reads the sections of the files, then puts the definitions together.
class Liaisons::Reader {
 public:
  Reader(Liaisons& result, config::Problems& problems)
      : result_(result), problems_(problems), includes_(problems) {}

  void read_section(const Value& section, const std::string& file) {
    const Includes::Open open(includes_, file);
    if (section.exists() && section.kind() != Value::Kind::kMapping) {
      problems_.error(section.place(),
                      "'liaisons' must be a mapping of keys, got " + section.described());
    }
    for (const Value::Entry& entry : section.entries()) {
      if (entry.key != "include") {
        add(entry);
        continue;
      }
      for (const Includes::File& included : includes_.read(entry.value, file)) {
        config::MappingReader reader(included.root, "file of liaisons", problems_);
        reader.required_integer("cordis", 1, 1);
        read_section(reader.required_mapping("liaisons"), included.path);
        reader.finish();
      }
    }
  }

  /// Completes the definitions of all liaisons.
  void complete_all() {
    for (const std::string& name : result_.names_) complete(name);
  }

 private:
  void add(const Value::Entry& entry) {
    const bool named = check_name(entry.key, entry.key_place, problems_);
    const auto [known, is_new] = result_.liaisons_.try_emplace(entry.key);
    if (!is_new) {
      const config::Place& first = known->second.place;
      problems_.error(entry.key_place, "the liaison '" + entry.key + "' is defined twice",
                      "first defined at " + first.file + ":" + std::to_string(first.line));
      return;
    }
    result_.names_.push_back(entry.key);
    Liaison& liaison = known->second;
    liaison.place = entry.key_place;
    liaison.definition = entry.value;
    liaison.sound = named;
    if (entry.value.kind() == Value::Kind::kMapping) return;
    problems_.error(
        entry.value.place(),
        "liaison '" + entry.key + "' must be a mapping of keys, got " + entry.value.described());
    liaison.sound = false;
  }

  /// Completes the definition of a liaison, after that of the one it is like.
  void complete(const std::string& name) {
    Liaison& liaison = result_.liaisons_.at(name);
    if (liaison.complete || !liaison.sound) return;
    const Value like = liaison.definition.find("like");
    waiting_.push_back(name);
    const auto cycle = std::find(waiting_.begin(), waiting_.end(), like.text());
    if (like.exists() && cycle != waiting_.end()) {
      std::string circle;
      for (auto word = cycle; word != waiting_.end(); ++word) circle += *word + " -> ";
      problems_.error(like.place(), "the liaison '" + name + "' is like itself",
                      circle + like.text());
      liaison.sound = false;
    } else if (waiting_.size() > kMaxLikenesses) {
      problems_.error(like.place(), "more than 64 liaisons are like each other");
      liaison.sound = false;
    } else if (like.exists()) {
      if (result_.find(like.text()) != nullptr) complete(like.text());
      liaison.definition = result_.completed(liaison.definition, problems_);
      liaison.sound = liaison.definition.exists();
    }
    liaison.complete = true;
    waiting_.pop_back();
  }

  Liaisons& result_;
  config::Problems& problems_;
  Includes includes_;
  std::vector<std::string> waiting_;  // liaisons that wait for one they are like
};

void Liaisons::read(const std::vector<LiaisonSection>& sections, int space,
                    std::set<std::string> signals, config::Problems& problems) {
  signals_ = std::move(signals);
  Reader reader(*this, problems);
  for (const LiaisonSection& section : sections) reader.read_section(section.section, section.file);
  reader.complete_all();
  for (const std::string& name : names_) {
    Liaison& liaison = liaisons_.at(name);
    if (!liaison.sound) continue;
    std::optional<LinkLaw> law =
        read_liaison(liaison.definition, name, {}, *this, space, true, problems);
    liaison.sound = law.has_value();
    if (law) liaison.law = std::move(*law);
  }
}

Value Liaisons::completed(const Value& definition, config::Problems& problems) const {
  const Value like = definition.find("like");
  if (config::KeyLog* const log = config::KeyLog::current())
    log->add({"like", config::KeyKind::kText, false, {}, {}, 0, {}, definition.place()});
  if (!like.exists()) return definition;
  const Liaison* const base = find(like, problems);
  return base == nullptr ? Value{} : laid_on(base->definition, definition, true);
}

const Liaison* Liaisons::find(const std::string& name) const noexcept {
  const auto found = liaisons_.find(name);
  return found == liaisons_.end() ? nullptr : &found->second;
}

const Liaison* Liaisons::find(const Value& name, config::Problems& problems, bool with_hint) const {
  const Liaison* const known = name.kind() == Value::Kind::kScalar ? find(name.text()) : nullptr;
  if (known != nullptr) return known->sound ? known : nullptr;
  if (name.kind() != Value::Kind::kScalar) {
    problems.error(name.place(), "a liaison is called by its name, got " + name.described());
  } else {
    problems.error(name.place(), "no liaison is named '" + name.text() + "'",
                   with_hint && !problems.is_full() ? config::did_you_mean(name.text(), names_)
                                                    : std::string());
  }
  return nullptr;
}

}  // namespace cordis::scene
