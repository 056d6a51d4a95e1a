// sim_node/scene/sections/signals.cpp
#include "sim_node/scene/sections/signals.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "node/config/nearest_word.h"
#include "sim_node/scene/language/name.h"
#include "sim_node/scene/language/point.h"
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

/// The direction of a quantity of a group, which has none by itself but in 1-D.
void read_direction_of_group(int space, config::MappingReader& reader, Signal& signal) {
  signal.direction = Vec3::UnitX();
  if (space == 1 && !reader.has("axis")) return;
  signal.direction = Vec3::Unit(reader.required_choice("axis", axis_words(space)).front() - 'x');
}

/// @return its number in the network
std::uint32_t add_group(Assembly& assembly, engine::VariableGroup group) {
  std::vector<engine::VariableGroup>& groups = assembly.scene.network.groups;
  groups.push_back(std::move(group));
  return static_cast<std::uint32_t>(groups.size() - 1);
}

/// True if a liaison of sets acts between MATs of two groups.
bool are_joined(const engine::NetworkDescription& network, const std::vector<std::uint32_t>& on,
                const std::vector<std::uint32_t>& by) {
  std::vector<bool> is_on(network.mats.size());
  std::vector<bool> is_by(network.mats.size());
  for (const std::uint32_t mat : on) is_on[mat] = true;
  for (const std::uint32_t mat : by) is_by[mat] = true;
  const auto has = [](const std::vector<std::uint32_t>& set, const std::vector<bool>& group) {
    return std::ranges::any_of(set, [&](std::uint32_t mat) { return group[mat]; });
  };
  return std::ranges::any_of(network.sets, [&](const engine::SetLiaison& set) {
    const std::vector<std::uint32_t>& other = set.set_q.empty() ? set.set_p : set.set_q;
    return (has(set.set_p, is_on) && has(other, is_by)) ||
           (has(set.set_p, is_by) && has(other, is_on));
  });
}

/// Reads by which body the contact force is.
void read_contact(Assembly& assembly, config::MappingReader& reader, const Selection& on,
                  Signal& signal) {
  const Value whose = reader.required_value("by");
  if (!whose.exists()) return;
  const std::optional<Selection> by =
      select(whose, reader.name_of("by"), false, assembly.names, assembly.problems);
  if (!by) return;
  engine::NetworkDescription& network = assembly.scene.network;
  std::vector<bool> is_on(network.mats.size());
  for (const std::uint32_t mat : on.indices) is_on[mat] = true;
  for (const std::uint32_t mat : by->indices) {
    if (!is_on[mat]) continue;
    reader.error_at("by", "'" + assembly.names.word_of(mat, false) + "' is in both bodies");
    return;
  }
  if (assembly.problems.has_errors()) return;  // a liaison may be missing for it
  if (!are_joined(network, on.indices, by->indices)) {
    reader.error_at("by", "no liaison of sets acts between these bodies",
                    "the force of a link is its quantity force");
    return;
  }
  network.kept_awake.insert(network.kept_awake.end(), on.indices.begin(), on.indices.end());
  const std::uint32_t group = add_group(assembly, {false, LinkKind::kLinear, on.indices});
  const std::uint32_t other = add_group(assembly, {false, LinkKind::kLinear, by->indices});
  signal.index = static_cast<std::uint32_t>(network.contacts.size());
  network.contacts.push_back({group, other});
}

/// Reads what the momentum of a turning body is about.
void read_turn(int space, config::MappingReader& reader, Signal& signal) {
  signal.is_about_point = reader.has("about_m");
  signal.point = optional_point(reader, "about_m", Vec3::Zero(), space);
  signal.direction = Vec3::UnitZ();
  if (space == 1) reader.error_at("quantity", "nothing turns in 1-D");
  if (space == 3) read_direction_of_group(space, reader, signal);
}

void read_signal_of_body(Assembly& assembly, config::MappingReader& reader, Signal signal,
                         const Selection& picked, std::vector<Signal>& signals) {
  const std::vector<engine::Mat>& mats = assembly.scene.network.mats;
  const int space = assembly.scene.space();
  const auto is_mass = [&](std::uint32_t mat) { return mats[mat].kind == engine::MatKind::kMass; };
  const bool has_mass = std::ranges::any_of(picked.indices, is_mass);
  if (signal.quantity == Quantity::kContactForce) {
    read_contact(assembly, reader, picked, signal);
  } else if (!has_mass) {
    reader.error_at(
        "of", "it has no mass that moves, so it has no " + reader.optional_text("quantity", ""));
  } else {
    signal.index = add_group(assembly, {false, LinkKind::kLinear, picked.indices});
  }
  if (signal.quantity == Quantity::kAngularMomentum) {
    read_turn(space, reader, signal);
  } else {
    read_direction_of_group(space, reader, signal);
  }
  read_rate(reader, signal);
  reader.finish();
  signals.push_back(std::move(signal));
}

/// What may be taken of many, in the order of engine::Take.
const std::vector<std::string>& words_of_take() {
  static const std::vector<std::string> kTakes{"largest", "smallest", "mean", "sum"};
  return kTakes;
}

/// Reads what is taken of the values of many MATs, or of many links of one kind.
void read_signal_of_many(Assembly& assembly, config::MappingReader& reader, Signal signal,
                         const Selection& picked, std::vector<Signal>& signals) {
  const std::vector<std::string>& takes = words_of_take();
  const auto take = std::ranges::find(takes, reader.required_choice("take", takes));
  signal.take = static_cast<engine::Take>(take - takes.begin() + 1);
  engine::VariableGroup group;
  group.is_of_links = picked.kind == Named::kLinks;
  Owner owner = Owner::kMat;
  if (group.is_of_links) {
    group.kind = kind_of_link(picked.indices.front());
    owner = owner_of(assembly.scene.network, picked.indices.front());
  }
  bool is_of_one_kind = true;
  for (const std::uint32_t member : picked.indices) {
    is_of_one_kind = is_of_one_kind && (!group.is_of_links || kind_of_link(member) == group.kind);
    group.members.push_back(group.is_of_links ? index_of_link(member) : member);
    if (owner == Owner::kStateBend) owner = owner_of(assembly.scene.network, member);
  }
  signal.kind = group.kind;
  if (!is_of_one_kind) reader.error_at("of", "these links are of several kinds", "pick one kind");
  const QuantityWord* quantity = read_quantity(reader, owner);
  if (quantity != nullptr) {
    signal.quantity = quantity->quantity;
    signal.unit = quantity->unit;
    if (is_count(signal.quantity))
      reader.error_at("take", "a number of " + std::string(quantity->word) + " is one value");
    if (quantity->has_direction) read_direction_of_group(assembly.scene.space(), reader, signal);
  }
  if (signal.quantity == Quantity::kForce) {
    std::vector<std::uint32_t>& awake = assembly.scene.network.kept_awake;
    awake.insert(awake.end(), group.members.begin(), group.members.end());
  }
  if (is_of_one_kind) signal.index = add_group(assembly, std::move(group));
  read_rate(reader, signal);
  reader.finish();
  signals.push_back(std::move(signal));
}

/// True if pairs of a liaison of sets may be bound: it has states.
bool binds(const Assembly& assembly, std::uint32_t set) {
  const std::uint32_t state_machine = assembly.scene.network.sets[set].state_machine;
  return assembly.liaisons->pool().state_machines()[state_machine].states.size() > 1;
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
  if (quantity != nullptr && !binds(assembly, set) && !reader.has("near_m")) {
    reader.error_at("quantity", "pairs of a liaison of one state are never bound",
                    "count pieces of balls nearer than near_m");
  }
  read_rate(reader, signal);
  reader.finish();
  signals.push_back(std::move(signal));
}

void read_count_of_links(const Assembly& assembly, config::MappingReader& reader,
                         const std::string& name, const Selection& picked,
                         std::vector<Signal>& signals) {
  Signal signal;
  signal.name = name;
  Owner owner = Owner::kStateLink;
  for (const std::uint32_t link : picked.indices) {
    if (kind_of_link(link) != LinkKind::kState) owner = owner_of(assembly.scene.network, link);
    signal.state_links.push_back(index_of_link(link));
  }
  const QuantityWord* quantity = read_quantity(reader, owner);
  if (quantity != nullptr) signal.quantity = quantity->quantity;
  read_rate(reader, signal);
  reader.finish();
  signals.push_back(std::move(signal));
}

/// Words that are a quantity of something, each once.
std::vector<std::string> known_quantities() {
  std::vector<std::string> known;
  for (const QuantityWord& quantity : quantity_words()) {
    if (std::ranges::find(known, quantity.word) == known.end()) known.emplace_back(quantity.word);
  }
  return known;
}

/// Checks a signal of something that has a problem itself: what is wrong whatever that is.
void check_unowned_signal(Assembly& assembly, config::MappingReader& reader, const Value& subject) {
  const int space = assembly.scene.space();
  const std::string word = reader.required_text("quantity");
  const std::vector<std::string> known = known_quantities();
  if (!word.empty() && std::ranges::find(known, word) == known.end()) {
    reader.error_at("quantity", "nothing has a quantity '" + word + "'",
                    config::did_you_mean(word, known));
  }
  const QuantityWord* of_mat = find_quantity(Owner::kMat, word);
  const NameEntry* name = assembly.names.find(subject.text());
  const bool is_of_matter = name != nullptr && name->kind == Named::kMatter;
  const bool needs_axis = of_mat != nullptr && of_mat->has_direction && is_of_matter && space > 1;
  if (needs_axis || reader.has("axis")) reader.required_choice("axis", axis_words(space));
  if (reader.has("take")) reader.required_choice("take", words_of_take());
  if (reader.has("by")) {
    (void)select(reader.optional_value("by"), reader.name_of("by"), false, assembly.names,
                 assembly.problems);
  }
  if (reader.has("near_m")) reader.required_number("near_m", config::Range::positive());
  if (reader.has("about_m")) optional_point(reader, "about_m", Vec3::Zero(), space);
  Signal signal;
  read_rate(reader, signal);
  for (const char* key : {"axis", "take", "by", "near_m", "about_m", "full_scale"})
    reader.optional_value(key);
  reader.finish();
}

/// What `of` lists, where a liaison of sets is among it.
struct JoinedLiaisons {
  std::vector<std::uint32_t> sets;
  std::vector<Value> others;
};

JoinedLiaisons joined_liaisons(const Assembly& assembly, const Value& subject) {
  const bool is_list = subject.kind() == Value::Kind::kSequence;
  JoinedLiaisons joined;
  for (const Value& item : is_list ? subject.items() : std::vector<Value>{subject}) {
    const std::vector<std::uint32_t> sets = assembly.sets_called(item.text());
    joined.sets.insert(joined.sets.end(), sets.begin(), sets.end());
    if (sets.empty()) joined.others.push_back(item);
  }
  return joined;
}

/// Reads a count over several liaisons of sets, and links with states beside them.
void read_count_of_several(Assembly& assembly, config::MappingReader& reader,
                           const std::string& name, JoinedLiaisons joined,
                           std::vector<Signal>& signals) {
  Signal signal;
  signal.name = name;
  for (const Value& other : joined.others) {
    const std::optional<Selection> picked =
        select(other, "'of' in " + reader.what(), true, assembly.names, assembly.problems);
    if (!picked) return check_unowned_signal(assembly, reader, other);
    for (const std::uint32_t link : picked->indices) {
      if (picked->kind == Named::kLinks && kind_of_link(link) == LinkKind::kState) {
        signal.state_links.push_back(index_of_link(link));
        continue;
      }
      assembly.problems.error(other.place(),
                              "beside liaisons of sets a signal is of links with states");
      return check_unowned_signal(assembly, reader, other);
    }
  }
  for (std::vector<std::uint32_t>* list : {&signal.state_links, &joined.sets}) {
    std::ranges::sort(*list);
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  signal.sets = std::move(joined.sets);
  const QuantityWord* quantity = read_quantity(reader, Owner::kSet);
  if (quantity != nullptr) signal.quantity = quantity->quantity;
  const auto is_bound = [&](std::uint32_t set) { return binds(assembly, set); };
  if (reader.has("near_m")) {
    reader.optional_value("near_m");
    reader.error_at("near_m", "pieces over several liaisons are counted by bound pairs alone",
                    "leave near_m out, or count the pieces of one liaison");
  } else if (quantity != nullptr && signal.state_links.empty() &&
             std::ranges::none_of(signal.sets, is_bound)) {
    reader.error_at("quantity", "pairs of liaisons of one state are never bound",
                    "count pieces of one of them, of balls nearer than near_m");
  }
  read_rate(reader, signal);
  reader.finish();
  signals.push_back(std::move(signal));
}

/// Keys that no signal has, before `of` and `quantity` decide which of all it takes.
void refuse_unknown_keys(const Value::Entry& entry, config::MappingReader& reader,
                         config::Problems& problems) {
  const std::vector<std::string> keys{"of",     "quantity", "axis",  "take", "by",
                                      "near_m", "about_m",  "sound", "rate", "full_scale"};
  for (const Value::Entry& key : entry.value.entries()) {
    if (std::ranges::find(keys, key.key) != keys.end()) continue;
    reader.optional_value(key.key);
    std::string hint = config::did_you_mean(key.key, keys);
    if (hint.empty()) {
      hint = "known keys: ";
      for (const std::string& known : keys) hint += (known == "of" ? "" : ", ") + known;
    }
    problems.error(key.key_place, "unknown key '" + key.key + "' in " + reader.what(), hint);
  }
}

void read_signal(Assembly& assembly, const Value::Entry& entry, std::vector<Signal>& signals) {
  check_name(entry.key, entry.key_place, assembly.problems);
  config::MappingReader reader(entry.value, "signal '" + entry.key + "'", assembly.problems);
  refuse_unknown_keys(entry, reader, assembly.problems);
  reader.describe({.key = "quantity",
                   .kind = config::KeyKind::kChoice,
                   .required = true,
                   .choices = known_quantities()});
  const Value subject = reader.optional_value("of");
  JoinedLiaisons joined = joined_liaisons(assembly, subject);
  if (joined.sets.size() == 1 && joined.others.empty())
    return read_signal_of_set(assembly, reader, entry.key, joined.sets.front(), signals);
  if (!joined.sets.empty())
    return read_count_of_several(assembly, reader, entry.key, std::move(joined), signals);
  std::optional<Selection> picked;
  if (subject.exists()) {
    picked = select(subject, "'of' in " + reader.what(), true, assembly.names, assembly.problems);
    if (!picked) return check_unowned_signal(assembly, reader, subject);
  }
  const bool is_link = picked && picked->kind == Named::kLinks;
  const std::string word = reader.optional_text("quantity", "");
  if (is_link && (word == "pieces" || word == "bonds")) {
    return read_count_of_links(assembly, reader, entry.key, *picked, signals);
  }
  if (picked && !is_link) {
    if (const QuantityWord* of_body = find_quantity(Owner::kBody, word)) {
      Signal signal;
      signal.name = entry.key;
      signal.quantity = of_body->quantity;
      signal.unit = of_body->unit;
      return read_signal_of_body(assembly, reader, std::move(signal), *picked, signals);
    }
  }
  if (picked && reader.has("take")) {
    Signal signal;
    signal.name = entry.key;
    return read_signal_of_many(assembly, reader, std::move(signal), *picked, signals);
  }
  const bool is_count = picked && !is_link && word == "pieces";
  if (picked && picked->count() != 1 && !is_count) {
    reader.error_at("of",
                    "a signal is of one MAT or one link, and " +
                        (subject.text().empty() ? "this list" : "'" + subject.text() + "'") +
                        " has " + std::to_string(picked->count()),
                    "pick one: \"" + assembly.names.word_of(picked->indices[0], is_link) +
                        "\", or take: largest, smallest, mean or sum");
  }
  Owner owner = Owner::kScene;
  if (picked) owner = is_link ? owner_of(assembly.scene.network, picked->indices[0]) : Owner::kMat;

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
    if (signal.quantity == Quantity::kForce && is_of_one_mat(signal))
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
