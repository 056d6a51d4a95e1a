// sim_node/run/command.cpp
#include "sim_node/run/command.h"

#include <algorithm>
#include <stdexcept>

#include "node/config/mapping_reader.h"
#include "node/config/yaml_reader.h"
#include "node/control_verbs.h"
#include "node/time_scale.h"

namespace cordis::sim {
namespace {

/// @throws std::invalid_argument with the first problem, as one sentence
void throw_first(const config::Problems& problems) {
  if (!problems.has_errors()) return;
  const config::Problem& first = problems.all().front();
  throw std::invalid_argument(first.message + (first.hint.empty() ? "" : "; " + first.hint));
}

std::uint64_t read_steps(const config::Value& argument, config::Problems& problems) {
  if (argument.kind() == config::Value::Kind::kNothing) return 1;
  const long steps =
      config::read_integer(argument, "the number of steps", 1, 1, kMaxSingleSteps, problems);
  return static_cast<std::uint64_t>(steps);
}

std::string read_file(const config::Value& argument, config::Problems& problems) {
  if (argument.kind() == config::Value::Kind::kScalar && !argument.text().empty())
    return argument.text();
  problems.error(argument.place(), "'load' needs the path of a scene");
  return {};
}

std::vector<NewValue> read_values(const config::Value& argument, config::Problems& problems) {
  if (argument.kind() != config::Value::Kind::kMapping || argument.entries().empty())
    problems.error(argument.place(), "'set' needs NAME.PARAMETER and a value");
  std::vector<NewValue> values;
  for (const config::Value::Entry& entry : argument.entries()) {
    // Names may have dots, parameters have none.
    const std::size_t dot = entry.key.rfind('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == entry.key.size()) {
      problems.error(entry.key_place, "'" + entry.key + "' is not of the form NAME.PARAMETER");
      continue;
    }
    values.push_back({entry.key.substr(0, dot), entry.key.substr(dot + 1),
                      config::read_number(entry.value, "'" + entry.key + "'", 0.0, {}, problems)});
  }
  return values;
}

std::vector<std::string> read_names(const config::Value& argument, config::Problems& problems) {
  std::vector<std::string> names;
  if (argument.kind() == config::Value::Kind::kScalar) names.push_back(argument.text());
  for (const config::Value& item : argument.items()) names.push_back(item.text());
  if (std::find(names.begin(), names.end(), std::string()) != names.end())
    problems.error(argument.place(), "'get' needs NAME or NAME.PARAMETER");
  return names;
}

void read_state(const config::Value& argument, Command& command, config::Problems& problems) {
  const std::vector<config::Value>& items = argument.items();
  if (items.size() != 2 || items[0].text().empty() || items[1].text().empty()) {
    problems.error(argument.place(), "'state' needs links and the state they are put into");
    return;
  }
  command.links = items[0].text();
  command.state = items[1].text();
}

}  // namespace

Command read_command(msg::ControlVerb verb, const std::string& argument) {
  Command command;
  command.verb = verb;
  const std::string word = node::word_of(verb);
  config::Problems problems;
  const config::Value value = config::load_word(argument, "'" + word + "'", problems);
  throw_first(problems);
  const bool empty = value.kind() == config::Value::Kind::kNothing;
  switch (verb) {
    case msg::VERB_STEP:
      command.steps = read_steps(value, problems);
      break;
    case msg::VERB_LOAD:
      command.scene_file = read_file(value, problems);
      break;
    case msg::VERB_SET:
      command.values = read_values(value, problems);
      break;
    case msg::VERB_GET:
      if (!empty) command.names = read_names(value, problems);
      break;
    case msg::VERB_STATE:
      read_state(value, command, problems);
      break;
    case msg::VERB_RATE:
      command.time_scale = config::read_number(
          value, "the rate of a simulation", node::kFullTimeScale,
          config::Range::between(node::kSlowestTimeScale, node::kFullTimeScale), problems);
      break;
    case msg::VERB_PAUSE:
    case msg::VERB_RESUME:
    case msg::VERB_RESET:
      if (!empty)
        problems.error(value.place(),
                       "'" + word + "' stands alone, got " + value.described() + " behind it");
      break;
    default:
      throw std::invalid_argument("a sim_node knows no command '" + word + "'");
  }
  throw_first(problems);
  return command;
}

}  // namespace cordis::sim
