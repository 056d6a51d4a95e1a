// sim_node/run/request_maker.cpp
#include "sim_node/run/request_maker.h"

#include <stdexcept>
#include <utility>

#include "node/config/count_text.h"
#include "node/config/mapping_reader.h"
#include "sim_node/checks/settling.h"
#include "sim_node/plan/reduction/reduce.h"
#include "sim_node/run/link_states.h"

namespace cordis::sim {
namespace {

/// A scene as its file says it: liaisons have their links there, merged or not.
std::shared_ptr<const scene::Scene> whole_of(const std::shared_ptr<const scene::Scene>& scene) {
  return scene->whole ? scene->whole : scene;
}

Request request_of(Request::Kind kind, std::uint64_t steps = 0) {
  Request request;
  request.kind = kind;
  request.steps = steps;
  return request;
}

}  // namespace

std::string text_without_lines(const config::Problems& problems) {
  std::string text;
  for (config::Problem problem : problems.in_order()) {
    problem.source_line.clear();
    if (!text.empty()) text += '\n';
    text += problem.text();
  }
  return text;
}

RequestMaker::RequestMaker(std::shared_ptr<const scene::Scene> scene, std::uint64_t epoch)
    : scene_(std::move(scene)), parameters_(whole_of(scene_)), epoch_(epoch) {}

PreparedRequest RequestMaker::prepare(const Command& command, const Check& check) const {
  PreparedRequest prepared;
  switch (command.verb) {
    case msg::VERB_PAUSE:
      prepared.request = request_of(Request::Kind::kPause);
      prepared.done = "paused";
      return prepared;
    case msg::VERB_RESUME:
      prepared.request = request_of(Request::Kind::kResume);
      prepared.done = "goes on";
      return prepared;
    case msg::VERB_STEP:
      prepared.request = request_of(Request::Kind::kStep, command.steps);
      return prepared;
    case msg::VERB_RESET:
      prepared = restart(scene_);
      prepared.done = "'" + scene_->name + "' restarts";
      if (prepared.request.scene->simulation.misses_start_state()) {
        prepared.done +=
            " at 0 s, as '" + scene_->start_state_file + "' was saved with other parameters";
      }
      return prepared;
    case msg::VERB_SET:
      return set(command.values, check);
    case msg::VERB_STATE:
      prepared.request = request_of(Request::Kind::kForceStates);
      prepared.request.forced = find_states(*scene_, command.links, command.state);
      prepared.done = config::count_text(prepared.request.forced.size(), "link") + " put into '" +
                      command.state + "'";
      return prepared;
    case msg::VERB_LOAD:
    case msg::VERB_GET:
    case msg::VERB_SEEK:
    case msg::VERB_RATE:
      break;
  }
  throw std::invalid_argument("this command asks nothing of the loop");
}

PreparedRequest RequestMaker::load(std::shared_ptr<const scene::Scene> scene) const {
  PreparedRequest prepared = restart(std::move(scene));
  prepared.parameters = scene::Parameters(whole_of(prepared.scene));
  prepared.done = "'" + prepared.scene->name + "' begins";
  return prepared;
}

PreparedRequest RequestMaker::restart(std::shared_ptr<const scene::Scene> scene) const {
  PreparedRequest prepared;
  prepared.request = request_of(Request::Kind::kRestart);
  prepared.request.scene = std::make_unique<LoadedScene>(scene, epoch_, version_ + 1);
  prepared.scene = std::move(scene);
  prepared.is_new_version = true;
  return prepared;
}

PreparedRequest RequestMaker::set(const std::vector<NewValue>& values, const Check& check) const {
  PreparedRequest prepared;
  prepared.parameters = parameters_;
  auto scene = std::make_shared<scene::Scene>(*whole_of(scene_));
  for (const NewValue& wanted : values) {
    const auto outcome = prepared.parameters->set(wanted.name, wanted.parameter, wanted.value);
    if (!outcome.problem.empty()) {
      throw std::invalid_argument(outcome.problem +
                                  (outcome.hint.empty() ? "" : "; " + outcome.hint));
    }
    for (const scene::Change& change : outcome.changes) scene::apply(change, scene->network);
    prepared.done += (prepared.done.empty() ? "" : ", ") + wanted.name + "." + wanted.parameter +
                     " = " + config::number_text(wanted.value);
  }
  config::Problems problems;
  if (scene_->whole) {
    *scene = plan::reduce(std::move(*scene), problems);
    if (problems.has_errors()) throw std::invalid_argument(problems.all().front().message);
    scene::set_step(*scene, scene_->step_rate_hz, scene_->network.integrator);
    keep_settled(*scene_, *scene);
    scene->start_state = scene_->start_state;  // read once it was reduced
  }
  if (check) check(*scene, problems);
  if (problems.has_errors()) {
    throw std::invalid_argument("the values stay as they are\n" + text_without_lines(problems));
  }
  prepared.request = request_of(Request::Kind::kExchange);
  try {
    prepared.request.scene = std::make_unique<LoadedScene>(scene, epoch_, version_);
  } catch (const std::invalid_argument& refusal) {
    throw std::invalid_argument(std::string("this cannot be simulated: ") + refusal.what());
  }
  prepared.request.room.reserve(prepared.request.scene->simulation.world().max_values_of_state());
  prepared.scene = std::move(scene);
  prepared.warnings = text_without_lines(problems);
  return prepared;
}

void RequestMaker::commit(PreparedRequest prepared) {
  if (prepared.scene) scene_ = std::move(prepared.scene);
  if (prepared.parameters) parameters_ = std::move(*prepared.parameters);
  if (prepared.is_new_version) ++version_;
}

}  // namespace cordis::sim
