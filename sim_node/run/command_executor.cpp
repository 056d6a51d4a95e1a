// sim_node/run/command_executor.cpp
#include "sim_node/run/command_executor.h"

#include <stdexcept>
#include <thread>
#include <utility>

#include "node/config/count_text.h"
#include "node/config/mapping_reader.h"
#include "sim_node/plan/reduction/reduce.h"
#include "sim_node/run/link_states.h"

namespace cordis::sim {
namespace {

constexpr auto kLook = std::chrono::milliseconds(1);  // for the end of single steps

std::string at_step(const Request& request) {
  return " at step " + std::to_string(request.step);
}

/// A scene as its file says it: liaisons have their links there, merged or not.
std::shared_ptr<const scene::Scene> whole_of(const std::shared_ptr<const scene::Scene>& scene) {
  return scene->whole ? scene->whole : scene;
}

/// All that is wrong in files, for who need not be allowed to read them: without their lines.
std::string text_without_lines(const config::Problems& problems) {
  std::string text;
  for (config::Problem problem : problems.in_order()) {
    problem.source_line.clear();
    if (!text.empty()) text += '\n';
    text += problem.text();
  }
  return text;
}

/// All that is wrong in the files of a scene, behind one sentence.
std::string refusal_of(const std::string& path, const config::Problems& problems) {
  return "'" + path + "' cannot be played (" + config::count_text(problems.error_count(), "error") +
         "), the present scene goes on\n" + text_without_lines(problems);
}

}  // namespace

CommandExecutor::CommandExecutor(RequestMailbox& orders, std::shared_ptr<const scene::Scene> scene,
                                 std::uint64_t epoch, Load load, Check check, Publish publish)
    : mailbox_(orders),
      scene_(std::move(scene)),
      parameters_(whole_of(scene_)),
      epoch_(epoch),
      load_(std::move(load)),
      check_(std::move(check)),
      publish_(std::move(publish)) {}

node::Answer CommandExecutor::execute(const msg::ControlCommand& message) {
  Command command;
  try {
    command = read_command(message.verb(), message.argument());
  } catch (const std::invalid_argument& refusal) {
    return {false, refusal.what()};
  }
  Request request;
  switch (command.verb) {
    case msg::VERB_PAUSE:
      request.kind = Request::Kind::kPause;
      return give(request, "paused");
    case msg::VERB_RESUME:
      request.kind = Request::Kind::kResume;
      return give(request, "goes on");
    case msg::VERB_STEP:
      return step(command.steps);
    case msg::VERB_RESET:
      return restart(scene_, "'" + scene_->name + "' restarts");
    case msg::VERB_LOAD:
      return load(command.scene_file);
    case msg::VERB_SET:
      return set(command.values);
    case msg::VERB_STATE:
      return force(command.links, command.state);
  }
  return {};
}

node::Answer CommandExecutor::give(Request& request, const std::string& done) {
  if (!mailbox_.give(request)) return {false, "too late, the simulation is ending"};
  if (request.kind == Request::Kind::kPause && request.was_paused)
    return {true, "was paused already" + at_step(request)};
  if (request.kind == Request::Kind::kResume && !request.was_paused)
    return {true, "was running already" + at_step(request)};
  return {true, done + at_step(request)};
}

node::Answer CommandExecutor::step(std::uint64_t count) {
  Request request;
  request.kind = Request::Kind::kStep;
  request.steps = count;
  if (!mailbox_.give(request)) return {false, "too late, the simulation is ending"};
  const auto limit = std::chrono::steady_clock::now() + kPatience;
  while (mailbox_.steps_left() > 0 && !mailbox_.is_closed()) {
    if (std::chrono::steady_clock::now() > limit)
      return {true, config::count_text(count, "step") + " begun" + at_step(request)};
    std::this_thread::sleep_for(kLook);
  }
  return {true, "paused at step " + std::to_string(request.step + count - mailbox_.steps_left())};
}

node::Answer CommandExecutor::restart(std::shared_ptr<const scene::Scene> scene,
                                      const std::string& done) {
  Request request;
  request.kind = Request::Kind::kRestart;
  request.stage = std::make_unique<LoadedScene>(scene, epoch_, version_ + 1);
  if (!mailbox_.give(request)) return {false, "too late, the simulation is ending"};
  scene_ = std::move(scene);
  publish_(*scene_, ++version_);
  const std::string paused = request.was_paused ? ", paused" : "";
  return {true, done + paused + "; the scene before ended" + at_step(request)};
}

node::Answer CommandExecutor::load(const std::string& path) {
  config::Problems problems;
  auto scene = std::make_shared<scene::Scene>(load_(path, problems));
  if (problems.has_errors()) return {false, refusal_of(path, problems)};
  const std::string warnings = text_without_lines(problems);
  node::Answer answer = restart(scene, "'" + scene->name + "' begins");
  if (answer.accepted) parameters_ = scene::Parameters(whole_of(scene));
  if (answer.accepted && !warnings.empty()) answer.text += "\n" + warnings;
  return answer;
}

node::Answer CommandExecutor::set(const std::vector<NewValue>& values) {
  scene::Parameters parameters = parameters_;
  auto scene = std::make_shared<scene::Scene>(*whole_of(scene_));
  std::string done;
  for (const NewValue& wanted : values) {
    const auto outcome = parameters.set(wanted.name, wanted.parameter, wanted.value);
    if (!outcome.problem.empty())
      return {false, outcome.problem + (outcome.hint.empty() ? "" : "; " + outcome.hint)};
    for (const scene::Change& change : outcome.changes) scene::apply(change, scene->network);
    done += (done.empty() ? "" : ", ") + wanted.name + "." + wanted.parameter + " = " +
            config::number_text(wanted.value);
  }
  config::Problems problems;
  if (scene_->whole) {
    *scene = plan::reduce(std::move(*scene), problems);
    if (problems.has_errors()) return {false, problems.all().front().message};
    scene::set_step(*scene, scene_->step_rate_hz, scene_->network.integrator);
  }
  check_(*scene, problems);
  if (problems.has_errors())
    return {false, "the values stay as they are\n" + text_without_lines(problems)};
  Request request;
  request.kind = Request::Kind::kExchange;
  try {
    request.stage = std::make_unique<LoadedScene>(scene, epoch_, version_);
  } catch (const std::invalid_argument& refusal) {
    return {false, std::string("this cannot be simulated: ") + refusal.what()};
  }
  request.room.reserve(request.stage->simulation.world().max_values_of_state());
  node::Answer answer = give(request, done);
  if (!request.done) return {false, "this changes more than parameters; load the scene again"};
  if (!answer.accepted) return answer;
  scene_ = std::move(scene);
  parameters_ = std::move(parameters);
  if (!problems.all().empty()) answer.text += "\n" + text_without_lines(problems);
  return answer;
}

node::Answer CommandExecutor::force(const std::string& links, const std::string& state) {
  Request request;
  request.kind = Request::Kind::kForceStates;
  try {
    request.forced = find_states(*scene_, links, state);
  } catch (const std::invalid_argument& refusal) {
    return {false, refusal.what()};
  }
  return give(request,
              config::count_text(request.forced.size(), "link") + " put into '" + state + "'");
}

}  // namespace cordis::sim
