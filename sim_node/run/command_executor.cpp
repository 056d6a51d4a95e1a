// sim_node/run/command_executor.cpp
#include "sim_node/run/command_executor.h"

#include <stdexcept>
#include <thread>
#include <utility>

#include "node/config/count_text.h"
#include "node/config/mapping_reader.h"

namespace cordis::sim {
namespace {

constexpr auto kPollPeriod = std::chrono::milliseconds(1);  // for the end of single steps

std::string at_step(const Request& request) {
  return " at step " + std::to_string(request.step);
}

/// All that is wrong with a scene, behind one sentence. Every process of the session reads it: of
/// what was found while a file was read it has the places alone.
std::string refusal_of(const std::string& path, const config::Problems& problems) {
  std::string text = "'" + path + "' cannot be played (" +
                     config::count_text(problems.error_count(), "error") +
                     "), the present scene goes on";
  bool is_short = false;
  for (config::Problem problem : problems.in_order()) {
    problem.source_line.clear();
    if (problem.may_quote) {
      problem.message = "something is wrong here";
      problem.hint.clear();
      is_short = true;
    }
    text += '\n' + problem.text();
  }
  if (is_short) text += "\n`cordis check` of the file, and the log of this node, say what is wrong";
  return text;
}

SceneSource source_of(const scene::Scene& scene, const config::Problems& problems) {
  return {scene.file, problems.sources(), engine::to_string(scene.network.integrator),
          scene.step_rate_hz};
}

}  // namespace

CommandExecutor::CommandExecutor(RequestMailbox& mailbox, std::shared_ptr<const scene::Scene> scene,
                                 std::uint64_t epoch, Load load, Check check, Publish publish)
    : mailbox_(mailbox),
      maker_(std::move(scene), epoch),
      load_(std::move(load)),
      check_(std::move(check)),
      publish_(std::move(publish)) {}

node::Answer CommandExecutor::execute(const msg::ControlCommand& message) {
  try {
    const Command command = read_command(message.verb(), message.argument());
    if (command.verb == msg::VERB_LOAD) return work_of(message)()();
    if (command.verb == msg::VERB_GET) return get(command.names);
    return submit(maker_.prepare(command, check_), {message.verb(), message.argument(), {}});
  } catch (const std::invalid_argument& refusal) {
    return {false, refusal.what()};
  }
}

node::Answer CommandExecutor::submit(PreparedRequest prepared, RequestSource source) {
  Request& request = prepared.request;
  request.source = std::make_shared<const RequestSource>(std::move(source));
  if (!mailbox_.submit(request)) return {false, "too late, the simulation is ending"};
  if (!request.done) return {false, "this changes more than parameters; load the scene again"};
  node::Answer answer = answer_of(prepared);
  const bool is_new_version = prepared.is_new_version;
  maker_.commit(std::move(prepared));
  if (is_new_version) publish_(*maker_.scene(), maker_.version());
  return answer;
}

node::Answer CommandExecutor::answer_of(const PreparedRequest& prepared) {
  const Request& request = prepared.request;
  const std::string warnings = prepared.warnings.empty() ? "" : "\n" + prepared.warnings;
  switch (request.kind) {
    case Request::Kind::kPause:
      if (request.steps_dropped > 0)
        return {true, "stopped" + at_step(request) + ", with " +
                          config::count_text(request.steps_dropped, "single step") + " to go"};
      if (request.was_paused) return {true, "was paused already" + at_step(request)};
      break;
    case Request::Kind::kResume:
      if (!request.was_paused) return {true, "was running already" + at_step(request)};
      break;
    case Request::Kind::kStep: {
      const auto limit = std::chrono::steady_clock::now() + kPatience;
      while (mailbox_.steps_left() > 0 && !mailbox_.is_closed()) {
        if (std::chrono::steady_clock::now() > limit)
          return {true, config::count_text(request.steps, "step") + " begun" + at_step(request)};
        std::this_thread::sleep_for(kPollPeriod);
      }
      return {true, "paused at step " +
                        std::to_string(request.step + request.steps - mailbox_.steps_left())};
    }
    case Request::Kind::kRestart:
      return {true, prepared.done + (request.was_paused ? ", paused" : "") +
                        "; the scene before ended" + at_step(request) + warnings};
    case Request::Kind::kExchange:
    case Request::Kind::kForceStates:
      break;
  }
  return {true, prepared.done + at_step(request) + warnings};
}

node::Answer CommandExecutor::get(const std::vector<std::string>& names) const {
  std::string text;
  for (const std::string& name : names.empty() ? maker_.parameters().names_in_use() : names) {
    const scene::Parameters::Values values = maker_.parameters().get(name);
    if (!values.problem.empty())
      return {false, values.problem + (values.hint.empty() ? "" : "; " + values.hint)};
    for (const auto& [parameter, value] : values.entries)
      text += (text.empty() ? "" : "\n") + parameter + " = " + config::number_text(value);
  }
  if (text.empty()) return {true, "no parameters"};
  return {true, text};
}

node::Work CommandExecutor::work_of(const msg::ControlCommand& message) {
  if (message.verb() != msg::VERB_LOAD) return {};
  Command command;
  try {
    command = read_command(message.verb(), message.argument());
  } catch (const std::invalid_argument&) {
    return {};  // execute() says what is wrong
  }
  return [this, load = load_, path = command.scene_file]() -> node::Finish {
    auto problems = std::make_shared<config::Problems>();
    auto scene = std::make_shared<const scene::Scene>(load(path, *problems));
    return [this, path, scene, problems] { return play(path, scene, *problems); };
  };
}

node::Answer CommandExecutor::play(const std::string& path,
                                   std::shared_ptr<const scene::Scene> scene,
                                   const config::Problems& problems) {
  if (problems.has_errors()) return {false, refusal_of(path, problems)};
  const SceneSource source = source_of(*scene, problems);
  PreparedRequest prepared = maker_.load(std::move(scene));
  prepared.warnings = text_without_lines(problems);
  return submit(std::move(prepared), {msg::VERB_LOAD, path, source});
}

}  // namespace cordis::sim
