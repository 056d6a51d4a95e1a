// tests/sim/start_state_test.cpp -- scenes that start from the state of a run.
#include "sim_node/checks/start_state.h"

#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "sim_node/checks/planned_scene.h"
#include "sim_node/run/request_maker.h"
#include "sim_node/run/simulation.h"
#include "tests/sim/loaded_scenes.h"
#include "tests/support/filled.h"

namespace cordis::sim {
namespace {

class StartState : public testing::Test {
 protected:
  StartState()
      : folder_(std::filesystem::temp_directory_path() /
                ("cordis-start-state-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~StartState() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }

  /// A bow that sticks and slips, a drive, a Maxwell element and a heap; with keys at the top level.
  std::string scene(const std::string& name, const std::string& keys,
                    const std::string& mass = "0.01", const std::string& step = "") const {
    return write(
        name, test::filled(R"(cordis: 1
name: "a 'heap'"
space: 2
step: {rate_hz: 44100<step>}
)",
                           {{"step", step}}) +
                  keys +
                  test::filled(R"(world: {gravity_m_per_s2: [0, -9.81], viscosity_n_s_per_m: 0.001}
liaisons:
  land: {kind: state_machine, stiffness_n_per_m: 500, viscosity_n_s_per_m: 0.2, pulls: false, range: rest,
         friction: {static: 0.5, stiffness_n_per_m: 300}}
  glue: {kind: maxwell, stiffness_n_per_m: 20, viscosity_n_s_per_m: 2}
  rosin:
    start: hooked
    states:
      hooked: {stiffness_n_per_m: 40, exits: [{to: unhooked, when: abs(elongation_m) > 0.002}]}
      unhooked: {viscosity_n_s_per_m: 0.01, exits: [{to: hooked, when: age_s > 0.004, rest: here}]}
matter:
  floor: {kind: plane, at_m: [0, 0], normal: y}
  heap: {kind: points, at_m: [[0, 0.03], [0.03, 0.05], [0.01, 0.09]], radius_m: 0.02,
         mass_kg: <mass>,
         velocity_m_per_s: [[0.1, 0], [-0.2, 0], [0, -1]]}
  bow: {kind: fixed, driven: {position_m: ["0.2 + 0.3 * time_s", 0.2]}}
  string: {kind: mass, mass_kg: 0.02, at_m: [0.2, 0.1]}
  nail: {kind: fixed, at_m: [0.2, 0.15]}
links:
  - {liaison: land, within: heap}
  - {liaison: land, between_sets: [heap, floor]}
  - {liaison: rosin, between: [bow, string]}
  - {liaison: glue, between: [nail, string]}
)",
                               {{"mass", mass}}));
  }

  /// A scene of scene(), with another name.
  std::string renamed(const std::string& file, const std::string& name) const {
    std::ifstream stream(folder_ / file);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    const std::string before = "\"a 'heap'\"";
    text.replace(text.find(before), before.size(), name);
    return write(file, text);
  }

  static std::shared_ptr<const scene::Scene> planned(const std::string& file) {
    config::Problems problems;
    PlannedScene planned = plan_scene(file, {}, problems);
    EXPECT_EQ(problems.text(), "");
    return std::make_shared<const scene::Scene>(std::move(planned.scene));
  }

  static void play(Simulation& simulation, int ticks) {
    EventRoom events(1024);
    for (int tick = 0; tick < ticks; ++tick) {
      events.clear();
      ASSERT_TRUE(simulation.advance(simulation.steps_left_in_tick(), events));
    }
  }

  std::string saved_after(const std::string& file, int ticks) const {
    Simulation simulation(planned(file), 1);
    play(simulation, ticks);
    return state_file_text(simulation.scene(), simulation.world().snapshot());
  }

  /// Two parallel springs, merged where `keys` say so.
  std::string springs(const std::string& name, const std::string& keys) const {
    return write(name, test::filled(R"(cordis: 1
name: springs
space: 1
step: {rate_hz: 4000}
<keys>
liaisons:
  spring: {kind: spring, stiffness_n_per_m: 100}
  rubber: {kind: spring, stiffness_n_per_m: 7}
matter: {wall: {kind: fixed, at_m: 0}, bob: {kind: mass, mass_kg: 0.1, at_m: 0.01}}
links:
  - {liaison: spring, between: [wall, bob], rest_m: 0}
  - {liaison: rubber, between: [wall, bob], rest_m: 0}
)",
                                    {{"keys", keys}}));
  }

  static Simulation& now(PreparedRequest& prepared) { return prepared.request.scene->simulation; }

  static PreparedRequest set(const RequestMaker& maker, double stiffness) {
    Command command;
    command.verb = msg::VERB_SET;
    command.values = {{"spring", "stiffness_n_per_m", stiffness}};
    return maker.prepare(command, {});
  }

  static PreparedRequest reset(const RequestMaker& maker) {
    Command command;
    command.verb = msg::VERB_RESET;
    return maker.prepare(command, {});
  }

  static std::string problems_of(const std::string& file) {
    config::Problems problems;
    plan_scene(file, {}, problems);
    return problems.text();
  }

  std::filesystem::path folder_;
};

TEST_F(StartState, GoesOnWithTheBitsOfHavingRunOn) {
  const std::string file = scene("whole.yaml", "");
  Simulation whole(planned(file), 1);
  for (const int ticks : {0, 1, 7, 150}) {
    write("run.state", saved_after(file, ticks));
    Simulation later(planned(scene("later.yaml", "start_state: run.state\n")), 1);
    EXPECT_EQ(later.tick_count(), static_cast<std::uint64_t>(ticks));
    EXPECT_EQ(later.start_s(), later.simulated_s());

    play(whole, ticks + 200 - static_cast<int>(whole.tick_count()));
    play(later, 200);

    EXPECT_EQ(later.world().step_count(), whole.world().step_count());
    EXPECT_EQ(later.world().state_hash(), whole.world().state_hash()) << ticks;
    EXPECT_EQ(later.steps_of_tick(), whole.steps_of_tick());
    whole = Simulation(planned(file), 1);
  }
}

TEST_F(StartState, IsTheStateThatWasSaved) {
  const std::string file = scene("whole.yaml", "");
  const std::string text = saved_after(file, 20);
  write("run.state", text);

  const Simulation later(planned(scene("later.yaml", "start_state: run.state\n")), 1);

  EXPECT_EQ(state_file_text(later.scene(), later.world().snapshot()), text);
}

TEST_F(StartState, HoldsNoForceOfAHandWhosePortIsGone) {
  const auto pair = [this](const std::string& name, const std::string& keys) {
    return write(name, R"(cordis: 1
name: pair
space: 1
step: {rate_hz: 1000}
)" + keys + "matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 1]}}\n");
  };
  Simulation before(
      planned(pair("whole.yaml", "ports: {hand: {device: d, axes: [0], role: liaison, of: a}}\n")),
      1);
  msg::GestureForces sample;
  sample.device_id(before.scene().ports.front().device_id);
  sample.epoch(5);
  sample.sample(1);
  sample.axis_count(1);
  sample.force_n()[0] = 3.0;
  before.devices().front().receive(sample, true, DeviceReach{});
  play(before, 3);
  ASSERT_NE(before.world().velocity(0).x(), 0.0);
  write("run.state", state_file_text(before.scene(), before.world().snapshot()));

  Simulation later(planned(pair("later.yaml", "start_state: run.state\n")), 1);

  EXPECT_EQ(later.world().position(0), before.world().position(0));
  play(later, 1);
  const double speed = later.world().velocity(0).x();
  play(later, 5);
  EXPECT_NEAR(later.world().velocity(0).x(), speed, 1e-9);
}

TEST_F(StartState, OfAnotherSceneIsRefused) {
  write("run.state", saved_after(scene("whole.yaml", ""), 3));

  const std::string changed = problems_of(scene("other.yaml", "start_state: run.state\n", "0.011"));
  EXPECT_NE(changed.find("other.yaml:5:14: error: 'run.state' holds a state of 'a 'heap'', which "
                         "has changed since"),
            std::string::npos)
      << changed;

  scene("other.yaml", "start_state: run.state\n", "0.011");
  const std::string text = problems_of(renamed("other.yaml", "lump"));
  EXPECT_NE(
      text.find("other.yaml:5:14: error: 'run.state' holds a state of another scene, 'a 'heap''"),
      std::string::npos)
      << text;
}

TEST_F(StartState, ThatIsDamagedIsRefused) {
  const std::string sound = saved_after(scene("whole.yaml", ""), 3);
  const std::string later = scene("later.yaml", "start_state: run.state\n");
  const auto changed = [&](const std::string& before, const std::string& after) {
    std::string text = sound;
    text.replace(text.find(before), before.size(), after);
    write("run.state", text);
    return problems_of(later);
  };

  EXPECT_NE(changed("  - \"", "  - \"0000000000000000").find("it is damaged"), std::string::npos);
  EXPECT_NE(changed("  - \"", "  - \"xyz").find("must be 16 hexadecimal digits"),
            std::string::npos);
  EXPECT_NE(changed("check: \"", "check: \"0").find("must be 16 hexadecimal digits"),
            std::string::npos);
  EXPECT_NE(changed("cordis_state: 1", "cordis_state: 2").find("'cordis_state'"),
            std::string::npos);
  // a step of which only the number is damaged, one that would be counted up to for years among them
  EXPECT_NE(changed("step: ", "step: 1").find("it is damaged"), std::string::npos);
  EXPECT_NE(changed("step: ", "step: 90071992547").find("it is damaged"), std::string::npos);
  EXPECT_NE(changed("values:", "value:").find("missing key 'values'"), std::string::npos);
  std::filesystem::remove(folder_ / "run.state");
  EXPECT_NE(problems_of(later).find("later.yaml:5:14: error:"), std::string::npos);
}

TEST_F(StartState, OfATickIsNoneOfAnotherGestureRate) {
  write("run.state", saved_after(scene("whole.yaml", ""), 3));
  const auto of_rate = [&](const std::string& rate_hz) {
    return problems_of(
        scene("later.yaml", "start_state: run.state\n", "0.01", ", gesture_rate_hz: " + rate_hz));
  };

  EXPECT_EQ(of_rate("1000"), "");
  EXPECT_EQ(of_rate("44100"), "");  // each step is the end of a period
  EXPECT_NE(of_rate("900").find("later.yaml:5:14: error: 'run.state' ends within a gesture period"),
            std::string::npos)
      << of_rate("900");
}

TEST_F(StartState, OfAnyStepIsReadAtOnce) {
  auto described = std::make_shared<scene::Scene>(*planned(scene("whole.yaml", "")));
  engine::Snapshot snapshot = Simulation(described, 1).world().snapshot();
  snapshot.step = 441ULL * 20'000'000'000'000ULL;  // 2^53 is a little more
  write("run.state", state_file_text(*described, snapshot));

  const Simulation later(planned(scene("later.yaml", "start_state: run.state\n")), 1);

  EXPECT_EQ(later.tick_count(), 10ULL * 20'000'000'000'000ULL);
  EXPECT_EQ(later.steps_of_tick(), 44);
}

TEST_F(StartState, OfManyMatsIsReadBack) {
  std::string places;
  for (int i = 0; i < 100'000; ++i) places += "[0," + std::to_string(i) + ",0],";
  const auto fallen = [&](const std::string& name, const std::string& keys) {
    return write(name,
                 R"(cordis: 1
name: dust
space: 3
step: {rate_hz: 1000}
)" + keys +
                     "matter: {dust: {kind: points, mass_kg: 1, velocity_m_per_s: [0.1, 0, 1], "
                     "at_m: [" +
                     places + "]}}\n");
  };
  const std::string text = saved_after(fallen("whole.yaml", ""), 1);
  ASSERT_GT(text.size(), std::size_t{16} << 20);
  write("run.state", text);

  const Simulation later(planned(fallen("later.yaml", "start_state: run.state\n")), 1);

  EXPECT_TRUE(state_file_text(later.scene(), later.world().snapshot()) == text);
}

TEST_F(StartState, IsWhereASceneWithOtherParametersGoesOn) {
  for (const std::string reduce : {"", "reduce: [parallel]\n"}) {
    write("run.state", saved_after(springs("whole.yaml", reduce), 20));
    const auto scene = planned(springs("later.yaml", "start_state: run.state\n" + reduce));
    RequestMaker maker(scene, 1);
    Simulation before(scene, 1);
    play(before, 5);

    PreparedRequest changed = set(maker, 90);
    ASSERT_TRUE(now(changed).go_on_from(before, changed.request.room));
    EXPECT_EQ(now(changed).world().step_count(), 100u);
    EXPECT_EQ(now(changed).start_s(), before.start_s());
    maker.commit(std::move(changed));

    PreparedRequest again = reset(maker);
    EXPECT_EQ(now(again).simulated_s(), 0.0);
    EXPECT_EQ(again.done,
              "'springs' restarts at 0 s, as 'run.state' was saved with other parameters");
    maker.commit(std::move(again));

    maker.commit(set(maker, 100));
    PreparedRequest as_saved = reset(maker);
    EXPECT_EQ(now(as_saved).world().step_count(), 80u) << reduce;
    EXPECT_EQ(as_saved.done, "'springs' restarts");
  }
}

TEST_F(StartState, WithoutAFileIsRefused) {
  EXPECT_NE(problems_of(scene("whole.yaml", "start_state: \"\"\n"))
                .find("whole.yaml:5:14: error: 'start_state' in scene must name a file"),
            std::string::npos);
}

}  // namespace
}  // namespace cordis::sim
