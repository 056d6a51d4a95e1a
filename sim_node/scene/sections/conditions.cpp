// sim_node/scene/sections/conditions.cpp
#include "sim_node/scene/sections/conditions.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "node/config/nearest_word.h"
#include "node/config/place_set.h"
#include "sim_node/scene/language/point.h"
#include "sim_node/scene/language/quantity.h"
#include "sim_node/scene/sections/quantity_words.h"

namespace cordis::scene {

namespace {

using config::Problems;
using engine::Instruction;
using engine::Operation;
using engine::Variable;

/// A quantity as a condition asks for it: that of a signal with its axis and unit.
struct ConditionWord {
  std::string text;
  const QuantityWord* quantity;
  int axis;  // -1: none, or the MAT's own
};

/// Any order in which equal variables are neither before each other.
struct InOrder {
  static auto key_of(const Variable& variable) {
    const engine::Vec3& direction = variable.direction;
    const engine::Vec3& point = variable.point;
    return std::tuple(variable.quantity, variable.kind, variable.index, direction.x(),
                      direction.y(), direction.z(), variable.offset, variable.take,
                      variable.is_about_point, point.x(), point.y(), point.z());
  }
  bool operator()(const Variable& a, const Variable& b) const { return key_of(a) < key_of(b); }
};

std::string unit_ending(const std::string& unit) {
  if (unit == "m") return "_m";
  if (unit == "m/s") return "_m_per_s";
  if (unit == "N") return "_n";
  if (unit == "rad") return "_rad";
  if (unit == "rad/s") return "_rad_per_s";
  if (unit == "N m") return "_n_m";
  return unit == "s" ? "_s" : "";
}

std::vector<ConditionWord> words_of(Owner owner, int space) {
  std::vector<ConditionWord> words;
  for (const QuantityWord& known : quantity_words()) {
    if (known.owner != owner || is_count(known.quantity)) continue;
    const std::string ending = unit_ending(known.unit);
    words.push_back({known.word + ending, &known, -1});
    if (!known.has_direction) continue;
    int axis = 0;
    for (const std::string& letter : axis_words(space)) {
      words.push_back({std::string(known.word) + "_" + letter + ending, &known, axis++});
    }
  }
  return words;
}

/// The word of these that may be meant, or all of them.
std::string hint_of(const std::string& word, const std::vector<std::string>& words) {
  std::string hint = config::did_you_mean(word, words);
  if (!hint.empty()) return hint;
  for (const std::string& known : words) hint += (hint.empty() ? "it has " : ", ") + known;
  return hint;
}

class ConditionReader {
 public:
  ConditionReader(Assembly& assembly, const std::vector<Signal>& signals)
      : assembly_(assembly), signals_(signals) {}

  void read(std::uint32_t state_machine, const std::string& scope) {
    const std::vector<VariableReference>& references = pool().references(state_machine);
    const StateMachinePool::Bindings bindings = bindings_of(references, scope);
    for (std::size_t slot = 0; slot < references.size(); ++slot)
      record_use(bindings[slot], references[slot], /*is_function=*/false, state_machine);
    pool().bind(state_machine, bindings);
  }

  void read(const FunctionReferences& asked) {
    const StateMachinePool::Bindings bindings = bindings_of(asked.references, asked.scope);
    engine::TimeFunction& function = assembly_.scene.network.time_functions[asked.function];
    for (engine::Program& formula : function.formula) {
      for (Instruction& instruction : formula.code) {
        if (instruction.operation != Operation::kVariable) continue;
        const VariableReference& reference = asked.references[instruction.slot];
        instruction = bindings[instruction.slot];
        record_use(instruction, reference, /*is_function=*/true, asked.function);
      }
    }
  }

 private:
  /// Keeps where a state machine or a function asks for a variable, unless that is where it is asked for first.
  void record_use(const Instruction& bound, const VariableReference& reference, bool is_function,
                  std::uint32_t index) {
    if (bound.operation != Operation::kVariable) return;
    AskedVariable& asked = assembly_.scene.asked_variables[bound.slot];
    const std::pair user{is_function, index};
    last_users_.resize(assembly_.scene.asked_variables.size());
    if (last_users_[bound.slot] == user) return;
    last_users_[bound.slot] = user;
    if (reference.place == asked.place) return;
    asked.uses.push_back({is_function, index, name_of_reference(reference), reference.place});
  }

  StateMachinePool::Bindings bindings_of(const std::vector<VariableReference>& references,
                                         const std::string& scope) {
    scope_ = scope;
    StateMachinePool::Bindings bindings;
    for (const VariableReference& reference : references) {
      reference_ = &reference;
      bindings.push_back(reference.owner.empty() ? of_scene() : of_something());
    }
    return bindings;
  }

  StateMachinePool& pool() const { return assembly_.liaisons->pool(); }

  /// One problem for each place, however many links a liaison has.
  void fail(const std::string& message, const std::string& hint) {
    const config::Place& place = reference_->place;
    const bool is_first = failed_.add(place);
    if (is_quiet_ || !is_first) return;
    assembly_.problems.error(place, message, hint);
  }

  static std::string name_of_reference(const VariableReference& reference) {
    return reference.owner.empty() ? reference.word : reference.owner + "." + reference.word;
  }

  /// The value of a variable; equal ones share a number.
  Instruction value_of(const Variable& variable) {
    std::vector<Variable>& variables = assembly_.scene.network.variables;
    const auto next = static_cast<std::uint32_t>(variables.size());
    const auto [known, is_new] = numbers_.emplace(variable, next);
    if (is_new) {
      variables.push_back(variable);
      assembly_.scene.asked_variables.push_back(
          {name_of_reference(*reference_), reference_->place});
      if (variable.quantity == engine::VariableKind::kForce && is_of_one_mat(variable))
        assembly_.scene.network.kept_awake.push_back(variable.index);
    }
    return {Operation::kVariable, engine::Quantity::kDistance, 0.0, known->second};
  }

  Instruction of_scene() {
    if (reference_->word == kTimeWord) {
      Variable time;
      time.quantity = engine::VariableKind::kTime;
      return value_of(time);
    }
    const auto named = std::ranges::find(signals_, reference_->word, &Signal::name);
    if (named == signals_.end()) return {};  // its problem has been reported
    if (is_count(named->quantity)) {
      fail("the signal '" + named->name + "' counts pieces or bonds, which no condition asks for",
           "ask for the state of a named link");
      return {};
    }
    return value_of(*named);
  }

  Instruction of_something() {
    if (failed_.has(reference_->place)) return {};  // in another copy
    // of a state, the word beside it reports what is wrong with the link
    is_quiet_ = !reference_->state.empty();
    const Instruction instruction = read_something();
    is_quiet_ = false;
    return instruction;
  }

  Instruction read_something() {
    const std::optional<Selection> picked = pick();
    if (!picked) return {};
    const bool is_link = picked->kind == Named::kLinks;
    const std::uint32_t first = picked->indices.front();
    if (picked->count() != 1) {
      fail("one MAT or one link may be asked for, and '" + reference_->owner + "' has " +
               std::to_string(picked->count()),
           "pick one: " + assembly_.names.word_of(first, is_link) + "." + reference_->word +
               ", the whole expression in quotes");
      return {};
    }
    Variable variable;
    variable.index = first;
    Owner owner = Owner::kMat;
    if (is_link) {
      variable.kind = kind_of_link(first);
      variable.index = index_of_link(first);
      owner = owner_of(assembly_.scene.network, first);
    }
    if (!read_quantity(owner, variable)) return {};
    return reference_->state.empty() ? value_of(variable) : number_of_state(variable);
  }

  bool read_quantity(Owner owner, Variable& variable) {
    const std::vector<ConditionWord> words = words_of(owner, assembly_.scene.space());
    const auto known = std::ranges::find(words, reference_->word, &ConditionWord::text);
    if (known == words.end()) {
      Variable along = variable;
      const bool has_own_axis = take_own_direction(assembly_.scene, along);
      std::vector<std::string> texts;
      for (const ConditionWord& word : words) {
        const bool needs_axis = word.quantity->has_direction && word.axis < 0;
        if (!needs_axis || has_own_axis) texts.push_back(word.text);
      }
      fail(std::string(name_of(owner)) + " has no quantity '" + reference_->word +
               "' that others may ask for",
           hint_of(reference_->word, texts));
      return false;
    }
    variable.quantity = known->quantity->quantity;
    if (!known->quantity->has_direction) return true;
    if (known->axis >= 0) {
      variable.direction = engine::Vec3::Unit(known->axis);
      return true;
    }
    if (take_own_direction(assembly_.scene, variable)) return true;
    fail("'" + reference_->owner + "' has no axis of its own, so '" + reference_->word +
             "' has no direction",
         "write the axis: " + std::next(known)->text);
    return false;
  }

  Instruction number_of_state(const Variable& link) {
    is_quiet_ = false;
    const engine::NetworkDescription& network = assembly_.scene.network;
    const std::uint32_t index = link.kind == LinkKind::kBend
                                    ? network.bends[link.index].state_machine
                                    : network.state_links[link.index].state_machine;
    const auto& states = pool().state_machines()[index].states;
    const auto named = std::ranges::find(states, reference_->state, &engine::LinkState::name);
    if (named == states.end()) {
      std::vector<std::string> names;
      for (const engine::LinkState& state : states) names.push_back(state.name);
      fail("'" + reference_->owner + "' has no state '" + reference_->state + "'",
           hint_of(reference_->state, names));
    }
    const auto number = static_cast<double>(named - states.begin());
    return {Operation::kConstant, engine::Quantity::kDistance, number, 0};
  }

  /// What the reference is of: a name of the part where the link stands, or one of the scene.
  std::optional<Selection> pick() {
    const std::string first = first_name();
    const NameEntry* const in_scene_alone = assembly_.names.find(first);
    const bool is_in_scene = in_scene_alone != nullptr && !in_scene_alone->is_of_liaison;
    if (!scope_.empty()) {
      Problems in_part;
      std::optional<Selection> picked;
      bool is_there = false;
      {
        const Names::Scope inside(assembly_.names, scope_.substr(0, scope_.size() - 1));
        is_there = assembly_.names.find(first) != nullptr || assembly_.names.is_before_links(first);
        is_there = is_there && !(is_in_scene && is_of_liaison(first));
        if (is_there) picked = select_from(in_part);
      }
      if (picked) return picked;
      if (is_there) return refused(in_part);
    }
    Problems in_scene;
    std::optional<Selection> picked = select_from(in_scene);
    return picked ? picked : refused(in_scene);
  }

  /// True if the present scope has this name only because its links have none.
  bool is_of_liaison(const std::string& first) const {
    const NameEntry* entry = assembly_.names.find(first);
    const std::string& owner = reference_->owner;
    if (entry == nullptr) entry = assembly_.names.find(owner.substr(0, owner.find('[')));
    return entry != nullptr && entry->is_of_liaison;
  }

  std::string first_name() const {
    return reference_->owner.substr(0, reference_->owner.find_first_of(".["));
  }

  std::optional<Selection> select_from(Problems& problems) {
    return select(config::Value::scalar(reference_->owner, reference_->place),
                  "what a condition asks for", true, assembly_.names, problems);
  }

  std::nullopt_t refused(const Problems& problems) {
    if (!problems.has_errors()) return std::nullopt;  // of what has a problem of its own
    const std::string& name = reference_->owner;
    if (assembly_.named_sets.contains(scope_ + name) || assembly_.named_sets.contains(name)) {
      fail("'" + name + "' is a liaison of sets, and one MAT or one link may be asked for", "");
      return std::nullopt;
    }
    const config::Problem& problem = problems.all().front();
    const std::string first = first_name();
    const std::vector<std::string> words = assembly_.names.words(true);
    const auto inner = std::ranges::find_if(
        words, [&](const std::string& word) { return word.ends_with("." + first); });
    const bool is_inner = assembly_.names.find(first) == nullptr && inner != words.end();
    const std::string hint = is_inner ? "it stands in a part: write " + *inner +
                                            name.substr(first.size()) + "." + reference_->word
                                      : problem.hint;
    fail(problem.message, hint);
    return std::nullopt;
  }

  Assembly& assembly_;
  const std::vector<Signal>& signals_;
  std::map<Variable, std::uint32_t, InOrder> numbers_;  // of the variables of the network
  /// Per variable, what asked for it last: true for a function, and its index.
  std::vector<std::optional<std::pair<bool, std::uint32_t>>> last_users_;
  config::PlaceSet failed_;  // reported but for quiet ones
  bool is_quiet_ = false;
  const VariableReference* reference_ = nullptr;  // that is read
  std::string scope_;                             // of its link
};

}  // namespace

void read_conditions(Assembly& assembly, const std::vector<Signal>& signals) {
  ConditionReader reader(assembly, signals);
  std::vector<std::string> scopes(assembly.liaisons->pool().state_machines().size());
  for (const auto& [origin, index] : assembly.liaisons->pool().origins()) {
    scopes[index] = origin.scope;
  }
  for (std::uint32_t index = 0; index < scopes.size(); ++index) reader.read(index, scopes[index]);
  for (const FunctionReferences& asked : assembly.function_references) reader.read(asked);
}

}  // namespace cordis::scene
