// sim_node/command.cpp
#include "sim_node/command.h"

#include <array>
#include <stdexcept>
#include <utility>

#include "node/config/mapping_reader.h"
#include "node/control_verbs.h"

namespace cordis::sim {
namespace {

constexpr std::array<std::pair<const char*, Verb>, 5> kVerbs{{{"pause", Verb::kPause},
                                                              {"resume", Verb::kResume},
                                                              {"step", Verb::kStep},
                                                              {"reset", Verb::kReset},
                                                              {"load", Verb::kLoad}}};

/// @throws std::invalid_argument with the first problem, as one sentence
void throw_first(const config::Problems& problems) {
  if (!problems.has_errors()) return;
  const config::Problem& first = problems.all().front();
  throw std::invalid_argument(first.message + (first.hint.empty() ? "" : "; " + first.hint));
}

Verb verb_named(const std::string& name) {
  for (const auto& [word, verb] : kVerbs) {
    if (name == word) return verb;
  }
  const std::string near = config::did_you_mean(name, node::control_verb_names());
  throw std::invalid_argument("a sim_node knows no command '" + name + "'" +
                              (near.empty() ? "" : ", " + near));
}

std::uint64_t read_steps(const config::Value& argument, config::Problems& problems) {
  if (argument.kind() == config::Value::Kind::kNothing) return 1;
  const long steps =
      config::read_integer(argument, "the number of steps", 1, 1, kMostSingleSteps, problems);
  return static_cast<std::uint64_t>(steps);
}

std::string read_file(const config::Value& argument, config::Problems& problems) {
  if (argument.kind() == config::Value::Kind::kScalar && !argument.text().empty())
    return argument.text();
  problems.error(argument.place(), "'load' needs the path of a scene");
  return {};
}

}  // namespace

Command read_command(const std::string& verb, const std::string& argument) {
  Command command;
  command.verb = verb_named(verb);
  config::Problems problems;
  const config::Value value = config::load_word(argument, "'" + verb + "'", problems);
  throw_first(problems);
  const bool empty = value.kind() == config::Value::Kind::kNothing;
  switch (command.verb) {
    case Verb::kStep:
      command.steps = read_steps(value, problems);
      break;
    case Verb::kLoad:
      command.scene_file = read_file(value, problems);
      break;
    case Verb::kPause:
    case Verb::kResume:
    case Verb::kReset:
      if (!empty)
        problems.error(value.place(),
                       "'" + verb + "' stands alone, got " + value.described() + " behind it");
      break;
  }
  throw_first(problems);
  return command;
}

}  // namespace cordis::sim
