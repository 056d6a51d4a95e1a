// sim_node/director.cpp
#include "sim_node/director.h"

#include <stdexcept>
#include <thread>
#include <utility>

namespace cordis::sim {
namespace {

constexpr auto kLook = std::chrono::milliseconds(1);  // for the end of single steps

std::string count_of(std::uint64_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string at_step(const Order& order) {
  return " at step " + std::to_string(order.step);
}

/// All that is wrong in the files of a scene, behind one sentence.
std::string refusal_of(const std::string& path, const config::Problems& problems) {
  return "'" + path + "' cannot be played (" + count_of(problems.error_count(), "error") +
         "), the present scene goes on\n" + problems.text();
}

}  // namespace

Director::Director(OrderBox& orders, std::shared_ptr<const scene::Scene> scene, std::uint64_t run,
                   Load load, Tell tell)
    : orders_(orders),
      scene_(std::move(scene)),
      run_(run),
      load_(std::move(load)),
      tell_(std::move(tell)) {}

node::Answer Director::obey(const msg::ControlCommand& message) {
  Command command;
  try {
    command = read_command(message.verb(), message.argument());
  } catch (const std::invalid_argument& refusal) {
    return {false, refusal.what()};
  }
  Order order;
  switch (command.verb) {
    case Verb::kPause:
      order.kind = Order::Kind::kPause;
      return give(order, "paused");
    case Verb::kResume:
      order.kind = Order::Kind::kResume;
      return give(order, "goes on");
    case Verb::kStep:
      return step(command.steps);
    case Verb::kReset:
      return restart(scene_, "'" + scene_->name + "' begins anew");
    case Verb::kLoad:
      return load(command.scene_file);
  }
  return {};
}

node::Answer Director::give(Order& order, const std::string& done) {
  if (!orders_.give(order)) return {false, "too late, the simulation is ending"};
  if (order.kind == Order::Kind::kPause && order.was_paused)
    return {true, "was paused already" + at_step(order)};
  if (order.kind == Order::Kind::kResume && !order.was_paused)
    return {true, "was running already" + at_step(order)};
  return {true, done + at_step(order)};
}

node::Answer Director::step(std::uint64_t count) {
  Order order;
  order.kind = Order::Kind::kStep;
  order.steps = count;
  if (!orders_.give(order)) return {false, "too late, the simulation is ending"};
  const auto limit = std::chrono::steady_clock::now() + kPatience;
  while (orders_.steps_left() > 0 && !orders_.is_closed()) {
    if (std::chrono::steady_clock::now() > limit)
      return {true, count_of(count, "step") + " begun" + at_step(order)};
    std::this_thread::sleep_for(kLook);
  }
  return {true, "paused at step " + std::to_string(order.step + count - orders_.steps_left())};
}

node::Answer Director::restart(std::shared_ptr<const scene::Scene> scene, const std::string& done) {
  Order order;
  order.kind = Order::Kind::kRestart;
  order.stage = std::make_unique<Stage>(scene, run_, version_ + 1);
  if (!orders_.give(order)) return {false, "too late, the simulation is ending"};
  scene_ = std::move(scene);
  tell_(*scene_, ++version_);
  const std::string paused = order.was_paused ? ", paused" : "";
  return {true, done + paused + "; the scene before ended" + at_step(order)};
}

node::Answer Director::load(const std::string& path) {
  config::Problems problems;
  auto scene = std::make_shared<scene::Scene>(load_(path, problems));
  if (problems.has_errors()) return {false, refusal_of(path, problems)};
  const std::string warnings = problems.text();
  node::Answer answer = restart(scene, "'" + scene->name + "' begins");
  if (answer.accepted && !warnings.empty()) answer.text += "\n" + warnings;
  return answer;
}

}  // namespace cordis::sim
