// sim_node/scene/parameters.cpp
#include "sim_node/scene/parameters.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "node/config/nearest_word.h"
#include "sim_node/scene/language/formula.h"
#include "sim_node/scene/language/point.h"
#include "sim_node/scene/liaisons/liaison_reader.h"

namespace cordis::scene {

namespace {

using Outcome = Parameters::Outcome;
using Origin = StateMachinePool::Origin;

constexpr const char* kWorld = "world";
constexpr const char* kMediumViscosity = "viscosity_n_s_per_m";

Outcome refused(std::string problem, std::string hint = {}) {
  return {{}, std::move(problem), std::move(hint)};
}

/// Later values go before earlier ones.
ParameterOverrides merged(ParameterOverrides values, const ParameterOverrides& later) {
  for (const auto& [name, value] : later) values[name] = value;
  return values;
}

const LinkLaw* part_of(const LinkLaw& law, const std::string& part) {
  if (law.part == part) return &law;
  const auto found = std::find_if(law.beside.begin(), law.beside.end(),
                                  [&](const LinkLaw& other) { return other.part == part; });
  return found == law.beside.end() ? nullptr : &*found;
}

bool is_of(const LinkGroup& group, const std::string& name) {
  return group.name == name || (!group.part.empty() && group.name == name + "." + group.part);
}

void add_words(std::vector<std::string>& words, const std::vector<std::string>& more) {
  for (const std::string& word : more) {
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
  }
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// The state machine of a link; none where it has numbers of its own.
std::optional<std::uint32_t> state_machine_of(const engine::NetworkDescription& network,
                                              LinkKind kind, std::uint32_t link) {
  switch (kind) {
    case LinkKind::kLinear:
      break;
    case LinkKind::kState:
      return network.state_links[link].state_machine;
    case LinkKind::kMaxwell:
      if (network.maxwell_links[link].follows_variables())
        return network.maxwell_links[link].state_machine;
      break;
    case LinkKind::kBend:
      if (network.bends[link].has_states()) return network.bends[link].state_machine;
      break;
  }
  return std::nullopt;
}

bool has_states(const engine::NetworkDescription& network, const LinkGroup& group) {
  if (group.kind == LinkKind::kState) return true;
  return group.count > 0 && state_machine_of(network, group.kind, group.first).has_value();
}

/// The parameters that links of a group may override.
std::vector<std::string> parameters_of_group(const LinkGroup& group, const Scene& scene) {
  const Liaison* const liaison =
      group.liaison.empty() ? nullptr : scene.liaisons->find(group.liaison);
  if (liaison != nullptr) return parameters_of(liaison->definition);
  if (has_states(scene.network, group)) return {};
  return {kStiffness, kViscosity};
}

/// The words for the axes of gravity: one in 1-D, which is what a scene writes there.
std::vector<std::string> gravity_words(int space) {
  if (space == 1) return {"gravity_m_per_s2"};
  std::vector<std::string> words;
  for (const std::string& axis : axis_words(space))
    words.push_back("gravity_" + axis + "_m_per_s2");
  return words;
}

Outcome unknown_parameter(const std::string& name, const std::string& parameter,
                          const std::vector<std::string>& words) {
  std::string hint = config::did_you_mean(parameter, words);
  if (hint.empty()) hint = words.empty() ? "it has none" : "it has " + listed(words);
  return refused("'" + name + "' has no parameter '" + parameter + "'", hint);
}

/// A name that is similar, or that goes on behind a dot: the coupling of a port.
std::string hint_for(const std::string& name, const std::vector<std::string>& known) {
  const auto longer = std::ranges::find_if(
      known, [&](const std::string& other) { return other.starts_with(name + "."); });
  if (!name.empty() && longer != known.end()) return "did you mean '" + *longer + "'?";
  return config::did_you_mean(name, known);
}

}  // namespace

void apply(const Change& change, engine::NetworkDescription& network) {
  if (change.kind == Change::Kind::kStateMachine) {
    network.state_machines[change.first] = change.state_machine;
    return;
  }
  if (change.kind == Change::Kind::kWorld) {
    network.gravity = change.gravity;
    network.medium_viscosity = change.medium_viscosity;
    return;
  }
  const auto put = [&](auto& links) {
    for (std::uint32_t l = change.first; l < change.first + change.count; ++l) {
      if (change.stiffness) links[l].stiffness = *change.stiffness;
      if (change.viscosity) links[l].viscosity = *change.viscosity;
    }
  };
  if (change.kind == Change::Kind::kLinks) put(network.links);
  if (change.kind == Change::Kind::kMaxwellLinks) put(network.maxwell_links);
  if (change.kind == Change::Kind::kBends) put(network.bends);
}

Change::Kind change_of(LinkKind kind) {
  if (kind == LinkKind::kBend) return Change::Kind::kBends;
  return kind == LinkKind::kLinear ? Change::Kind::kLinks : Change::Kind::kMaxwellLinks;
}

/// What is changed together: the state machines and the linear or Maxwell links of a name.
struct Parameters::Target {
  std::vector<std::pair<Origin, std::uint32_t>> state_machines;
  std::vector<const LinkGroup*> groups;

  /// Adds the changes that follow when each member takes `values_of(liaison, overrides)`.
  template <class ValuesOf>
  Outcome changes(const Scene& scene, ValuesOf values_of) const {
    Outcome outcome;
    const auto add = [&](const std::string& liaison, const ParameterOverrides& overrides,
                         const std::string& part, const std::string& owner, Change change) {
      config::Problems problems;
      const std::optional<LinkLaw> law = read_liaison(
          scene.liaisons->find(liaison)->definition, liaison, values_of(liaison, overrides, owner),
          *scene.liaisons, scene.space(), false, problems);
      const LinkLaw* const own = law ? part_of(*law, part) : nullptr;
      if (own == nullptr) {
        outcome = refused(problems.all().empty() ? "the liaison '" + liaison + "' has changed"
                                                 : problems.all().front().message);
        return false;
      }
      if (change.kind == Change::Kind::kStateMachine) {
        change.state_machine = *state_machine_of(*own);
        scene.liaisons->pool().bind_as(change.first, own->references, change.state_machine);
      } else {
        change.stiffness = own->bend ? own->bend->stiffness : own->stiffness;
        change.viscosity = own->bend ? own->bend->viscosity : own->viscosity;
      }
      outcome.changes.push_back(std::move(change));
      return true;
    };
    for (const auto& [origin, index] : state_machines) {
      Change change;
      change.first = index;
      if (!add(origin.liaison, origin.overrides, origin.part, origin.owner, change)) return outcome;
    }
    for (const LinkGroup* group : groups) {
      Change change;
      change.kind = change_of(group->kind);
      change.first = group->first;
      change.count = group->count;
      if (!add(group->liaison, group->overrides, group->part, group->name, change)) return outcome;
    }
    return outcome;
  }
};

Parameters::Parameters(std::shared_ptr<const Scene> scene)
    : scene_(std::move(scene)),
      gravity_(scene_->network.gravity),
      medium_viscosity_(scene_->network.medium_viscosity) {}

Outcome Parameters::set(const std::string& name, const std::string& parameter, double value) {
  if (!std::isfinite(value)) return refused("a parameter must be a finite number");
  if (scene_->liaisons != nullptr && scene_->liaisons->find(name) != nullptr)
    return set_of_liaison(name, parameter, value);
  const std::vector<std::string> known = names_of_links();
  if (std::find(known.begin(), known.end(), name) != known.end())
    return set_of_links(name, parameter, value);
  if (name == kWorld) return set_of_world(parameter, value);
  return refused("no liaison and no links are named '" + name + "'", hint_for(name, names()));
}

Outcome Parameters::set_of_liaison(const std::string& name, const std::string& parameter,
                                   double value) {
  const Scene& scene = *scene_;
  const std::vector<std::string> words = parameters_of(scene.liaisons->find(name)->definition);
  if (std::find(words.begin(), words.end(), parameter) == words.end())
    return unknown_parameter(name, parameter, words);

  Target target;
  bool used = false;
  for (const auto& [origin, index] : scene.liaisons->pool().origins()) {
    if (origin.liaison != name) continue;
    used = true;
    if (origin.overrides.count(parameter) == 0) target.state_machines.emplace_back(origin, index);
  }
  for (const LinkGroup& group : scene.link_groups) {
    if (group.liaison != name || has_states(scene.network, group)) continue;
    used = true;
    if (group.overrides.count(parameter) == 0) target.groups.push_back(&group);
  }
  ParameterOverrides values = of_liaison_[name];
  values[parameter] = value;
  Outcome outcome = target.changes(
      scene,
      [&](const std::string&, const ParameterOverrides& overrides, const std::string& owner) {
        const auto own = of_links_.find(owner);
        const ParameterOverrides before = merged(values, overrides);
        return own == of_links_.end() ? before : merged(before, own->second);
      });
  if (!outcome.problem.empty()) return outcome;
  if (outcome.changes.empty() && used) {
    return refused("all links of '" + name + "' give their own '" + parameter + "'",
                   "set it by the name of the links");
  }
  if (outcome.changes.empty()) return refused("no link is made of the liaison '" + name + "'");
  of_liaison_[name] = std::move(values);
  return outcome;
}

Outcome Parameters::set_of_links(const std::string& name, const std::string& parameter,
                                 double value) {
  const Scene& scene = *scene_;
  const engine::NetworkDescription& network = scene.network;
  Target target;
  std::vector<std::string> words;
  std::set<std::uint32_t> state_machines;
  std::vector<Change> plain;  // of links without a liaison
  std::map<LinkKind, std::vector<bool>> is_own{
      {LinkKind::kState, std::vector<bool>(network.state_links.size(), false)},
      {LinkKind::kMaxwell, std::vector<bool>(network.maxwell_links.size(), false)},
      {LinkKind::kBend, std::vector<bool>(network.bends.size(), false)}};
  for (const LinkGroup& group : scene.link_groups) {
    if (!is_of(group, name)) continue;
    add_words(words, parameters_of_group(group, scene));
    if (has_states(network, group)) {
      for (std::uint32_t l = group.first; l < group.first + group.count; ++l) {
        state_machines.insert(*state_machine_of(network, group.kind, l));
        is_own[group.kind][l] = true;
      }
    } else if (!group.liaison.empty()) {
      target.groups.push_back(&group);
    } else {
      Change change;
      change.kind = Change::Kind::kLinks;
      change.first = group.first;
      change.count = group.count;
      (parameter == kStiffness ? change.stiffness : change.viscosity) = value;
      plain.push_back(std::move(change));
    }
  }
  for (std::size_t s = 0; s < network.sets.size(); ++s) {
    if (scene.set_names[s] == name) state_machines.insert(network.sets[s].state_machine);
  }
  for (const auto& [origin, index] : scene.liaisons->pool().origins()) {
    if (state_machines.count(index) == 0) continue;
    target.state_machines.emplace_back(origin, index);
    add_words(words, parameters_of(scene.liaisons->find(origin.liaison)->definition));
  }
  if (std::find(words.begin(), words.end(), parameter) == words.end())
    return unknown_parameter(name, parameter, words);
  if (!plain.empty() && value < 0.0) return refused("'" + parameter + "' must be >= 0");

  bool shared = false;
  for (const auto& [kind, is_own_link] : is_own) {
    for (std::uint32_t l = 0; l < is_own_link.size(); ++l) {
      const auto machine = state_machine_of(network, kind, l);
      shared = shared || (!is_own_link[l] && machine && state_machines.count(*machine) != 0);
    }
  }
  for (std::size_t s = 0; s < network.sets.size(); ++s)
    shared = shared || (scene.set_names[s] != name &&
                        state_machines.count(network.sets[s].state_machine) != 0);
  if (shared) {
    return refused("'" + name + "' shares its parameters with other links",
                   "set those of the liaison '" + target.state_machines.front().first.liaison +
                       "', or give these links a name of their own");
  }
  ParameterOverrides values = of_links_[name];
  values[parameter] = value;
  Outcome outcome = target.changes(
      scene,
      [&](const std::string& liaison, const ParameterOverrides& overrides, const std::string&) {
        const auto before = of_liaison_.find(liaison);
        const ParameterOverrides own = merged(overrides, values);
        return before == of_liaison_.end() ? own : merged(before->second, own);
      });
  if (!outcome.problem.empty()) return outcome;
  outcome.changes.insert(outcome.changes.end(), plain.begin(), plain.end());
  of_links_[name] = std::move(values);
  return outcome;
}

Outcome Parameters::set_of_world(const std::string& parameter, double value) {
  std::vector<std::string> words;
  for (const auto& [word, unused] : values_of_world()) words.push_back(word);
  const std::vector<std::string> axes = gravity_words(scene_->space());
  const auto axis = std::find(axes.begin(), axes.end(), parameter);
  if (std::find(words.begin(), words.end(), parameter) == words.end()) {
    if (axis != axes.end()) return refused("gravity follows a formula in this scene");
    if (parameter == kMediumViscosity && scene_->medium_changes)
      return refused("the viscosity of the medium follows a formula in this scene");
    if (parameter == kMediumViscosity)
      return refused("the medium flows, so its viscosity keeps its value while a run goes on");
    return refused("'" + std::string(kWorld) + "' has no parameter '" + parameter + "'",
                   "it has " + listed(words));
  }
  if (axis == axes.end() && value < 0.0) return refused("'" + parameter + "' must be >= 0");
  if (std::abs(value) > kFarthest) return refused("'" + parameter + "' must be within 1e6");
  (axis == axes.end() ? medium_viscosity_ : gravity_[axis - axes.begin()]) = value;
  Change change;
  change.kind = Change::Kind::kWorld;
  change.gravity = gravity_;
  change.medium_viscosity = medium_viscosity_;
  return {{change}, {}, {}};
}

std::vector<std::pair<std::string, double>> Parameters::values_of_world() const {
  std::vector<std::pair<std::string, double>> values;
  if (!scene_->gravity_changes) {
    for (const std::string& word : gravity_words(scene_->space()))
      values.emplace_back(word, gravity_[static_cast<Eigen::Index>(values.size())]);
  }
  if (!scene_->medium_flows && !scene_->medium_changes)
    values.emplace_back(kMediumViscosity, medium_viscosity_);
  return values;
}

Parameters::Values Parameters::get(const std::string& what) const {
  Values found;
  const std::vector<std::string> known = names();
  const auto is_known = [&](const std::string& name) {
    return std::find(known.begin(), known.end(), name) != known.end();
  };
  const std::size_t dot = what.rfind('.');
  const std::string name = is_known(what) || dot == std::string::npos ? what : what.substr(0, dot);
  if (!is_known(name)) {
    found.problem = "no liaison and no links are named '" + name + "'";
    found.hint = hint_for(name, known);
    return found;
  }
  std::vector<std::string> words;
  for (const auto& [parameter, value] : values_of(name)) {
    words.push_back(parameter);
    if (name == what || what == name + "." + parameter)
      found.entries.emplace_back(name + "." + parameter, value);
  }
  if (name != what && found.entries.empty()) {
    const Outcome unknown = unknown_parameter(name, what.substr(dot + 1), words);
    found.problem = unknown.problem;
    found.hint = unknown.hint;
  }
  return found;
}

std::vector<std::pair<std::string, double>> Parameters::values_of(const std::string& name) const {
  const auto set_later = [](const auto& values, const std::string& key) {
    const auto known = values.find(key);
    return known == values.end() ? ParameterOverrides{} : known->second;
  };
  if (scene_->liaisons && scene_->liaisons->find(name) != nullptr)
    return values_of_liaison(name, set_later(of_liaison_, name));

  const ParameterOverrides own = set_later(of_links_, name);
  for (const LinkGroup& group : scene_->link_groups) {
    if (!is_of(group, name)) continue;
    if (!group.liaison.empty()) {
      return values_of_liaison(
          group.liaison,
          merged(merged(set_later(of_liaison_, group.liaison), group.overrides), own));
    }
    const engine::NetworkDescription& network = scene_->network;
    ParameterOverrides values{{kStiffness, network.links[group.first].stiffness},
                              {kViscosity, network.links[group.first].viscosity}};
    values = merged(std::move(values), own);
    return {values.begin(), values.end()};
  }
  for (std::size_t s = 0; s < scene_->network.sets.size(); ++s) {
    if (scene_->set_names[s] != name) continue;
    for (const auto& [origin, index] : scene_->liaisons->pool().origins()) {
      if (index != scene_->network.sets[s].state_machine) continue;
      return values_of_liaison(
          origin.liaison,
          merged(merged(set_later(of_liaison_, origin.liaison), origin.overrides), own));
    }
  }
  if (name == kWorld) return values_of_world();
  return {};
}

std::vector<std::pair<std::string, double>> Parameters::values_of_liaison(
    const std::string& liaison, const ParameterOverrides& overrides) const {
  const config::Value& definition = scene_->liaisons->find(liaison)->definition;
  config::Problems problems;  // none: the scene has been read
  const ParameterValues values(definition.find("parameters"), overrides, nullptr, liaison,
                               problems);
  std::vector<std::pair<std::string, double>> found;
  for (const std::string& name : parameters_of(definition)) {
    const auto own = overrides.find(name);
    const std::optional<double> value = values.find(name);
    if (value) {
      found.emplace_back(name, *value);
    } else if (own != overrides.end()) {
      found.emplace_back(name, own->second);
    } else if (!asks_outside(definition.find(name), values, scene_->liaisons->signals())) {
      found.emplace_back(name,
                         read_formula(definition.find(name), name, 0.0, {}, values, problems));
    }
  }
  return found;
}

std::vector<std::string> Parameters::names_in_use() const {
  std::vector<std::string> names;
  if (scene_->liaisons) {
    std::set<std::string> used;
    for (const auto& [origin, index] : scene_->liaisons->pool().origins())
      used.insert(origin.liaison);
    for (const LinkGroup& group : scene_->link_groups) used.insert(group.liaison);
    for (const std::string& name : scene_->liaisons->names())
      if (used.count(name) != 0) names.push_back(name);
  }
  for (const LinkGroup& group : scene_->link_groups)
    if (group.liaison.empty() && !group.name.empty()) add_words(names, {group.name});
  if (scene_->network.mass_count() > 0) add_words(names, {kWorld});
  return names;
}

std::vector<std::string> Parameters::names() const {
  std::vector<std::string> names = names_of_links();
  add_words(names, {kWorld});
  return names;
}

std::vector<std::string> Parameters::names_of_links() const {
  std::vector<std::string> names =
      scene_->liaisons ? scene_->liaisons->names() : std::vector<std::string>{};
  for (const LinkGroup& group : scene_->link_groups) {
    add_words(names, {group.name});
    const std::size_t ending = group.part.size() + 1;
    if (!group.part.empty() && group.name.size() > ending)
      add_words(names, {group.name.substr(0, group.name.size() - ending)});
  }
  add_words(names, scene_->set_names);
  return names;
}

}  // namespace cordis::scene
