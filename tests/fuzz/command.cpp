// tests/fuzz/command.cpp -- commands to a sim_node, as any process of its session may write them.
//
// Each line is a command: a byte that says its verb, and its argument.
#include "sim_node/run/command.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "node/command_server.h"
#include "sim_node/checks/stability_check.h"
#include "sim_node/run/request_maker.h"
#include "sim_node/run/runner.h"
#include "sim_node/scene/sections/scene_reader.h"

namespace cordis::fuzz {
namespace {

constexpr int kMaxCommands = 10;
constexpr int kMaxTurns = 3;  // after each command

/// A hand, a mass, links of every kind, and two names for some of them.
constexpr const char* kScene = R"(
cordis: 1
name: commanded
space: 1
step: {rate_hz: 4000}
reduce: [parallel]
liaisons:
  spring: {kind: spring_damper, stiffness_n_per_m: 100, viscosity_n_s_per_m: 0.1}
  rosin:
    parameters: {hold_n_per_m: 50, slip_n_per_m: hold_n_per_m / 5, reach_m: 0.002}
    start: hooked
    states:
      hooked: {stiffness_n_per_m: hold_n_per_m, exits: [{to: free, when: abs(elongation_m) > reach_m}]}
      free: {stiffness_n_per_m: slip_n_per_m, exits: [{to: hooked, when: age_s > 0.01, rest: here}]}
matter:
  wall: {kind: fixed, at_m: 0}
  bob: {kind: mass, mass_kg: 0.1, at_m: 0.01}
ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: 0}
links:
  - {liaison: spring, between: [wall, bob], rest_m: 0}
  - {liaison: spring, between: [wall, bob], rest_m: 0, name: second}
  - {liaison: rosin, between: [key, bob], name: contact}
)";

constexpr std::uint64_t kEpoch = 7;

/// @return the scene as it runs; the same one for all inputs
std::shared_ptr<const scene::Scene> played_scene() {
  config::Problems problems;
  auto scene = std::make_shared<scene::Scene>(scene::load_scene_text(kScene, "scene", problems));
  if (problems.has_errors()) std::abort();
  return scene;
}

/// A session of one process: what a command asks for is done at once.
class Commanded {
 public:
  explicit Commanded(const std::shared_ptr<const scene::Scene>& scene)
      : maker_(scene, kEpoch),
        runner_(std::make_unique<sim::LoadedScene>(scene, kEpoch, 1), false),
        server_("sim", msg::KIND_SIM_NODE,
                [this](const msg::ControlCommand& message) { return execute(message); }) {}

  /// A command that is refused leaves the scene as it is, and one that comes again, too.
  void take(const msg::ControlCommand& message) {
    const std::uint64_t before = hash();
    const auto reply = server_.take(message);
    if (!reply || (!reply->accepted() && hash() != before)) std::abort();
    const std::uint64_t after = hash();
    const auto again = server_.take(message);
    if (!again || again->text() != reply->text() || hash() != after) std::abort();
    for (int turn = 0; turn < kMaxTurns && runner_.moves(); ++turn)
      static_cast<void>(runner_.advance());
  }

 private:
  std::uint64_t hash() const { return runner_.simulation().world().state_hash(); }

  node::Answer execute(const msg::ControlCommand& message) {
    try {
      const sim::Command command = sim::read_command(message.verb(), message.argument());
      if (command.verb == msg::VERB_GET) return get(command);
      if (command.verb == msg::VERB_LOAD) {
        sim::PreparedRequest prepared = maker_.load(maker_.scene());
        return done(std::move(prepared));
      }
      const node::Answer answer =
          done(maker_.prepare(command, [](const scene::Scene& scene, config::Problems& problems) {
            sim::check_stability(scene, false, problems);
          }));
      if (answer.accepted) check_values(command);
      return answer;
    } catch (const std::invalid_argument& refusal) {
      return {false, refusal.what()};
    }
  }

  node::Answer done(sim::PreparedRequest prepared) {
    runner_.execute(prepared.request);
    if (!prepared.request.done) return {false, "does not fit"};
    maker_.commit(std::move(prepared));
    return {true, "done"};
  }

  node::Answer get(const sim::Command& command) {
    for (const std::string& name : command.names) {
      if (const auto values = maker_.parameters().get(name); !values.problem.empty())
        return {false, values.problem};
    }
    return {true, "done"};
  }

  /// What was set last under a name is what it is now.
  void check_values(const sim::Command& command) {
    if (command.values.empty()) return;
    const sim::NewValue& last = command.values.back();
    const auto values = maker_.parameters().get(last.name + "." + last.parameter);
    if (values.entries.size() != 1 || values.entries[0].second != last.value) std::abort();
  }

  sim::RequestMaker maker_;
  sim::Runner runner_;
  node::CommandServer server_;
};

bool can_be_read(const msg::ControlCommand& message) {
  try {
    static_cast<void>(sim::read_command(message.verb(), message.argument()));
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

}  // namespace
}  // namespace cordis::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cordis;
  static const std::shared_ptr<const scene::Scene> kPlayed = fuzz::played_scene();
  std::optional<fuzz::Commanded> session;  // most inputs say nothing that asks for one
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  for (int id = 1; !rest.empty() && id <= fuzz::kMaxCommands; ++id) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    if (line.empty()) continue;
    msg::ControlCommand command;
    command.command_id(static_cast<std::uint64_t>(id));
    command.sender("stranger");
    command.target("sim");
    // 0 to 9 as digits: the verbs; any other byte is a number that is none
    command.verb(static_cast<msg::ControlVerb>(static_cast<unsigned char>(line[0]) ^ 0x30U));
    command.argument(std::string(line.substr(1)));
    if (!session && !fuzz::can_be_read(command)) continue;
    if (!session) session.emplace(kPlayed);
    session->take(command);
  }
  return 0;
}
