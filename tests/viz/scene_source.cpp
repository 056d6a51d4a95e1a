// tests/viz/scene_source.cpp -- stands for sim_node and a device before viz_node: a scene that
// moves by formula.
//
// usage: scene_source --domain N [--session NAME] [--scene string|grid] [--mats N] [--states]
//                     [--amplitude METRES] [--bodies N] [--liaisons] [--space 1|2|3] [--surfaces] [--driven] [--bad-frames]
//                     [--colours] [--keyboard] [--tool-radius METRES] [--bonds]
//        scene_source --hold-domain     prints a domain of its own and holds it until it is ended
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "idl/gesture.h"
#include "idl/scene.h"
#include "node/config/name_hash.h"
#include "node/dds/participant.h"
#include "node/dds/writer.h"
#include "node/paced_loop.h"
#include "node/status.h"
#include "node/stop.h"
#include "node/time.h"
#include "tests/support/surfaces.h"
#include "tests/support/test_domain.h"

namespace cordis {
namespace {

constexpr double kStepRateHz = 1000.0;
constexpr double kFrameRateHz = 25.0;
constexpr std::uint32_t kStepsPerFrame = 40;
constexpr std::uint8_t kMass = 0;
constexpr std::uint8_t kFixed = 1;
constexpr std::uint8_t kPort = 2;
constexpr std::ptrdiff_t kPlainLinks = 4;  // without states, where there are several liaisons
constexpr std::size_t kIdleLink = 32;      // it does nothing, all the time
constexpr std::uint32_t kFirstBond = 2;    // row and column of a grid where it begins
constexpr std::uint32_t kSecondBond = 12;  // likewise; it does nothing
constexpr float kPortForceN = -0.25F;      // along y

struct Options {
  int domain = -1;
  std::string session = "viz_test";
  std::string scene = "string";
  std::size_t mats = 60;
  double amplitude_m = 0.0;  // of the string; 0: its own
  std::size_t bodies = 1;    // that the MATs belong to
  std::uint8_t space = 0;    // 0: that of the scene
  bool states = false;
  bool liaisons = false;  // two with states, and links without
  bool surfaces = false;
  bool driven = false;    // one more surface, a box at a MAT that moves
  bool colours = false;   // of the scene's own, for three bodies
  bool keyboard = false;  // the device is one of four keys
  float tool_radius_m = 0.0F;
  bool bonds = false;   // in a grid: two, of which one does nothing
  std::string refusal;  // of the device, for which the scene waits
  bool bad_frames = false;
  bool hold_domain = false;
};

Options read_options(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&]() -> std::string {
      if (++i == argc) throw std::invalid_argument(word + " needs a value");
      return argv[i];
    };
    if (word == "--domain") {
      options.domain = std::stoi(value());
    } else if (word == "--session") {
      options.session = value();
    } else if (word == "--scene") {
      options.scene = value();
    } else if (word == "--mats") {
      options.mats = std::stoul(value());
    } else if (word == "--amplitude") {
      options.amplitude_m = std::stod(value());
    } else if (word == "--bodies") {
      options.bodies = std::stoul(value());
    } else if (word == "--space") {
      options.space = static_cast<std::uint8_t>(std::stoul(value()));
    } else if (word == "--states") {
      options.states = true;
    } else if (word == "--liaisons") {
      options.liaisons = true;
    } else if (word == "--surfaces") {
      options.surfaces = true;
    } else if (word == "--driven") {
      options.driven = true;
    } else if (word == "--colours") {
      options.colours = true;
    } else if (word == "--tool-radius") {
      options.tool_radius_m = std::stof(value());
    } else if (word == "--keyboard") {
      options.keyboard = true;
    } else if (word == "--bonds") {
      options.bonds = true;
    } else if (word == "--refusal") {
      options.refusal = value();
    } else if (word == "--bad-frames") {
      options.bad_frames = true;
    } else if (word == "--hold-domain") {
      options.hold_domain = true;
    } else {
      throw std::invalid_argument("unknown option " + word);
    }
  }
  return options;
}

/// A scene whose MATs swing along y: y(t) = sum of two modes at the place of each.
struct MovingScene {
  msg::SceneDescription description;
  std::vector<float> rest_m;  // x, y, z of each MAT
  std::vector<float> mode_a;  // share of the first mode
  std::vector<float> mode_b;  // share of the second
  double amplitude_m = 0.0;
  std::uint32_t port_mat = 0;

  double height(std::size_t mat, double t) const {
    return amplitude_m * (mode_a[mat] * std::cos(2.0 * std::numbers::pi * 0.9 * t) +
                          0.4 * mode_b[mat] * std::sin(2.0 * std::numbers::pi * 1.7 * t));
  }
};

void add_mat(MovingScene& scene, double x, double z, std::uint8_t kind, float radius, double u,
             double v) {
  const double pi = std::numbers::pi;
  scene.rest_m.insert(scene.rest_m.end(), {static_cast<float>(x), 0.0F, static_cast<float>(z)});
  scene.description.mat_kind().push_back(kind);
  scene.description.mat_radius_m().push_back(radius);
  scene.description.mat_mass_kg().push_back(kind == kMass ? 0.001F : 0.0F);
  scene.mode_a.push_back(static_cast<float>(std::sin(pi * u) * std::sin(pi * v)));
  scene.mode_b.push_back(static_cast<float>(std::sin(2.0 * pi * u) * std::sin(pi * v)));
}

void join(MovingScene& scene, std::size_t a, std::size_t b) {
  scene.description.link_ends().push_back(static_cast<std::uint32_t>(a));
  scene.description.link_ends().push_back(static_cast<std::uint32_t>(b));
}

MovingScene string_scene(std::size_t count) {
  MovingScene scene;
  scene.description.space(2);
  scene.amplitude_m = 0.03;
  scene.port_mat = static_cast<std::uint32_t>(count / 5);
  for (std::size_t i = 0; i < count; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(count - 1);
    const bool end = i == 0 || i + 1 == count;
    add_mat(scene, 0.65 * u - 0.325, 0.0, end ? kFixed : (i == scene.port_mat ? kPort : kMass),
            0.0F, u, 0.5);
    if (i > 0) join(scene, i - 1, i);
  }
  return scene;
}

MovingScene grid_scene(std::size_t count) {
  MovingScene scene;
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(count)));
  const double pitch = 0.4 / static_cast<double>(side - 1);
  scene.description.space(3);
  scene.amplitude_m = 0.06;
  scene.port_mat = static_cast<std::uint32_t>((side / 3) * side + side / 3);
  for (std::size_t i = 0; i < side * side; ++i) {
    const std::size_t row = i / side;
    const std::size_t column = i % side;
    const bool edge = row == 0 || column == 0 || row + 1 == side || column + 1 == side;
    const double u = static_cast<double>(column) / static_cast<double>(side - 1);
    const double v = static_cast<double>(row) / static_cast<double>(side - 1);
    add_mat(scene, 0.4 * u - 0.2, 0.4 * v - 0.2,
            edge ? kFixed : (i == scene.port_mat ? kPort : kMass), static_cast<float>(0.35 * pitch),
            u, v);
    if (column > 0) join(scene, i - 1, i);
    if (row > 0) join(scene, i - side, i);
  }
  return scene;
}

/// The MATs as bodies of equal size: `string`, `string2`, `string3` ...
std::vector<msg::NamedRange> bodies_of(const msg::SceneDescription& description,
                                       const std::string& name, std::size_t count) {
  std::vector<msg::NamedRange> bodies(count);
  const std::size_t mats = description.mat_kind().size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i * mats / count;
    bodies[i].name(i == 0 ? name : name + std::to_string(i + 1));
    bodies[i].first(static_cast<std::uint32_t>(first));
    bodies[i].count(static_cast<std::uint32_t>((i + 1) * mats / count - first));
  }
  return bodies;
}

/// Every link may be hooked or free.
void describe_states(msg::SceneDescription& description) {
  msg::StateMachineDescription hook;
  hook.name("hook");
  hook.states({"hooked", "free"});
  description.state_machines({hook});
  description.link_state_machine().assign(description.link_ends().size() / 2, 0);
}

/// The last third of the links belongs to another liaison, but for the very last ones.
void describe_other_liaisons(msg::SceneDescription& description) {
  msg::StateMachineDescription glue;
  glue.name("glue");
  glue.states({"stuck", "loose"});
  description.state_machines().push_back(glue);
  std::vector<std::uint32_t>& machines = description.link_state_machine();
  std::fill(machines.begin() + static_cast<std::ptrdiff_t>(machines.size() * 2 / 3), machines.end(),
            1);
  std::fill(machines.end() - kPlainLinks, machines.end(), msg::NO_INDEX);
}

/// Balls may stick to each other.
void describe_bonds(msg::SceneDescription& description) {
  msg::StateMachineDescription paste;
  paste.name("paste");
  paste.states({"apart", "stuck", "torn"});
  msg::SetDescription set;
  set.name("lump");
  set.state_machine(static_cast<std::uint32_t>(description.state_machines().size()));
  description.state_machines().push_back(paste);
  description.sets({set});
}

void name_parts(MovingScene& scene, const std::string& name, std::size_t bodies,
                std::uint64_t epoch) {
  msg::SceneDescription& description = scene.description;
  msg::NamedRange tool;  // has the name of the port, but is another MAT
  tool.name("finger");
  tool.first(scene.port_mat + 3);
  tool.count(1);
  description.matter() = bodies_of(description, name, bodies);
  description.matter().push_back(tool);
  msg::NamedRange links;
  links.name("joints");
  links.count(static_cast<std::uint32_t>(description.link_ends().size() / 2));
  description.links({links});
  msg::PortDescription port;
  port.name("finger");
  port.device("keyboard");
  port.device_id(config::name_hash("keyboard"));
  port.mat(scene.port_mat);
  port.axes({0});
  description.ports({port});
  for (const auto& [signal, unit] :
       {std::pair{"finger position", "m"}, {"finger force", "N"}, {"energy", "J"}}) {
    msg::SignalDescription described;
    described.name(signal);
    described.unit(unit);
    description.signals().push_back(described);
  }
  description.epoch(epoch);
  description.version(1);
  description.name(name);
  description.scene_file("scenes/" + name + ".yaml");
  description.step_rate_hz(kStepRateHz);
  description.gesture_rate_hz(kStepRateHz);
  description.frame_rate_hz(kFrameRateHz);
}

msg::ColouredRange coloured(std::uint32_t first, std::uint32_t count, std::uint32_t rgb) {
  msg::ColouredRange range;
  range.first(first);
  range.count(count);
  range.red(static_cast<std::uint8_t>(rgb >> 16));
  range.green(static_cast<std::uint8_t>(rgb >> 8 & 255u));
  range.blue(static_cast<std::uint8_t>(rgb & 255u));
  return range;
}

/// The second half of a rope, a body and a fixed point have colours of their own.
void give_colours(msg::SceneDescription& description) {
  std::vector<msg::NamedRange>& matter = description.matter();
  matter[0].name("rope.core");
  matter[1].name("rope.skin");
  msg::NamedRange anchor;
  anchor.name("anchor");
  anchor.first(matter[2].first() + matter[2].count() - 1);
  anchor.count(1);
  matter.push_back(anchor);
  description.colours({coloured(matter[1].first(), matter[1].count(), 0xc81e1e),
                       coloured(matter[2].first(), matter[2].count(), 0xf5f500),
                       coloured(anchor.first(), 1, 0x8000ff)});
}

/// The port is the third of four keys, which go down by 1 cm.
msg::DeviceDescription describe_keyboard(MovingScene& scene) {
  const std::size_t first = std::size_t{3} * scene.port_mat;
  msg::PortFrame frame;
  for (std::size_t k = 0; k < 3; ++k) frame.rest_m().push_back(scene.rest_m[first + k]);
  frame.direction({0.0, 1.0, 0.0});
  scene.description.port_frames({frame});
  scene.description.ports()[0].axes({2});
  msg::DeviceDescription keyboard;
  keyboard.device("keyboard");
  keyboard.device_id(config::name_hash("keyboard"));
  keyboard.epoch(1);
  keyboard.coordinate_count(4);
  keyboard.rate_hz(kStepRateHz);
  keyboard.key_pitch_m(0.01375);
  keyboard.lowest_m(-0.01);
  keyboard.highest_m(0.01);
  return keyboard;
}

/// Everything that sim_node writes but the description.
/// A box that swings up and down; the other surfaces are at the first MAT.
void add_driven_box(MovingScene& scene) {
  msg::SceneDescription& description = scene.description;
  msg::NamedRange ram;
  ram.name("ram");
  ram.first(static_cast<std::uint32_t>(description.mat_kind().size()));
  ram.count(1);
  add_mat(scene, -0.3, 0.3, kPort, 0.0F, 0.5, 0.5);
  description.matter().push_back(ram);
  description.surface_mat().assign(description.surfaces().size(), 0);
  description.surfaces().push_back(
      test::surface("ram", msg::SURFACE_BOX, {-0.3, 0.0, 0.3}, {}, {0.1, 0.02, 0.1}));
  description.surface_mat().push_back(ram.first());
}

class Publisher {
 public:
  Publisher(dds::Participant& participant, MovingScene& scene, bool states)
      : frame_writer_(participant, dds::Topic::kFrame),
        signal_writer_(participant, dds::Topic::kSignals),
        scene_(scene),
        states_(states) {}

  void publish_frame(std::uint64_t number, std::uint64_t step) {
    const double t = static_cast<double>(step) / kStepRateHz;
    frame_.epoch(scene_.description.epoch());
    frame_.version(scene_.description.version());
    frame_.frame(number);
    frame_.step(step);
    frame_.simulated_s(t);
    frame_.position_m(scene_.rest_m);
    for (std::size_t i = 0; i < scene_.mode_a.size(); ++i) {
      frame_.position_m()[3 * i + 1] = static_cast<float>(scene_.height(i, t));
    }
    if (states_) {  // every second link changes its state once in a second
      const std::uint8_t second = step / 1000 % 2 == 0 ? 0 : 1;
      frame_.link_state().resize(scene_.description.link_ends().size() / 2);
      for (std::size_t l = 1; l < frame_.link_state().size(); l += 2)
        frame_.link_state()[l] = second;
      if (frame_.link_state().size() > kIdleLink) frame_.link_state()[kIdleLink] = 128 + 1;
    }
    if (!scene_.description.sets().empty()) {  // across the cells of a grid
      const std::uint32_t second = kSecondBond * row_of_grid() + kSecondBond;
      frame_.bond_ends({kFirstBond * row_of_grid() + kFirstBond,
                        (kFirstBond + 1) * row_of_grid() + kFirstBond + 1, second,
                        second + row_of_grid() + 1});
      frame_.bond_state({1, 2 + 128});
      frame_.bond_count({2});
      frame_.bonds_left_out(step / 1000 % 4 < 2 ? 0 : 7);
    }
    frame_.port_force_n({0.0F, kPortForceN, 0.0F});
    frame_.time_nsec(node::monotonic_nsec());
    static_cast<void>(frame_writer_.write(frame_));
  }

  void publish_bad_frame() {
    frame_.position_m().pop_back();
    static_cast<void>(frame_writer_.write(frame_));
  }

  void publish_signals(std::uint64_t batch, std::uint64_t first_step) {
    signals_.epoch(scene_.description.epoch());
    signals_.version(scene_.description.version());
    signals_.batch(batch);
    signals_.first_step(first_step);
    signals_.stride_steps(1);
    signals_.signal_count(3);
    signals_.value().clear();
    for (std::uint32_t i = 0; i < kStepsPerFrame; ++i) {
      const double t = static_cast<double>(first_step + i) / kStepRateHz;
      const double y = scene_.height(scene_.port_mat, t);
      const double force = -90.0 * y + 0.15 * std::sin(2.0 * std::numbers::pi * 140.0 * t);
      signals_.value().insert(signals_.value().end(), {y, force, 0.012 * std::exp(-0.02 * t)});
    }
    static_cast<void>(signal_writer_.write(signals_));
  }

 private:
  std::uint32_t row_of_grid() const {
    return static_cast<std::uint32_t>(
        std::sqrt(static_cast<double>(scene_.description.mat_kind().size())));
  }

  dds::Writer<msg::SceneFrame> frame_writer_;
  dds::Writer<msg::SceneSignals> signal_writer_;
  MovingScene& scene_;
  bool states_;
  msg::SceneFrame frame_;
  msg::SceneSignals signals_;
};

int publish(const Options& options) {
  const auto epoch = static_cast<std::uint64_t>(node::monotonic_nsec());
  dds::Participant sim({options.domain, options.session, "sim", false});
  dds::Participant keyboard({options.domain, options.session, "keyboard", false});
  MovingScene scene =
      options.scene == "grid" ? grid_scene(options.mats) : string_scene(options.mats);
  if (options.amplitude_m > 0.0) scene.amplitude_m = options.amplitude_m;
  if (options.space != 0) scene.description.space(options.space);
  scene.description.mat_radius_m()[scene.port_mat + 3] += options.tool_radius_m;
  if (options.states) describe_states(scene.description);
  if (options.states && options.liaisons) describe_other_liaisons(scene.description);
  if (options.surfaces) scene.description.surfaces(test::steps_and_post());
  if (options.bonds) describe_bonds(scene.description);
  name_parts(scene, options.scene, options.bodies, epoch);
  if (options.driven) add_driven_box(scene);
  if (options.colours) give_colours(scene.description);
  dds::Writer<msg::DeviceDescription> device_writer(keyboard, dds::Topic::kDevice);
  if (options.keyboard) {
    msg::DeviceDescription described = describe_keyboard(scene);
    static_cast<void>(device_writer.write(described));
  }
  dds::Writer<msg::SceneDescription> description_writer(sim, dds::Topic::kDescription);
  static_cast<void>(description_writer.write(scene.description));

  std::atomic<std::uint64_t> step{0};
  const auto speak = [&step, epoch](msg::NodeStatus& status) {
    status.phase(node::stop_requested() ? msg::PHASE_STOPPED : msg::PHASE_RUNNING);
    status.target_rate_hz(kStepRateHz);
    status.ticks((static_cast<std::uint64_t>(node::monotonic_nsec()) - epoch) / 1000000);
    status.step(step);
    status.overruns(3);
    status.dropped(7);
    status.energy_j(0.012);
    status.energy_drift(2.5e-9);
    status.integration_error_j(2e-6);
    status.port_work_j(3e-3);
    status.switching_energy_j(250e-6);
    status.dissipated_j(1.2e-3);
    status.largest_stability_number(1.75);
    status.largest_partners(7);
    status.certified_partners(12);
    status.refused_inputs(3);
  };
  const node::StatusPublisher sim_status(sim, msg::KIND_SIM_NODE, epoch,
                                         [&](msg::NodeStatus& status) {
                                           speak(status);
                                           if (options.refusal.empty()) return;
                                           status.phase(msg::PHASE_WAITING);
                                           status.text(options.refusal);
                                         });
  const node::StatusPublisher keyboard_status(keyboard, msg::KIND_DEVICE_NODE, epoch,
                                              [&](msg::NodeStatus& status) {
                                                speak(status);
                                                status.latency_count(step);
                                                status.link_samples(20'000);
                                                status.link_unanswered(240);
                                                status.latency_p50_s(92e-6);
                                                status.latency_p99_s(310e-6);
                                                status.latency_max_s(1.9e-3);
                                              });

  Publisher publisher(sim, scene, options.states);
  node::PacedLoop loop(kFrameRateHz);
  for (std::uint64_t frame = 1; !node::stop_requested(); ++frame) {
    loop.wait();
    step += kStepsPerFrame;
    publisher.publish_frame(frame, step);
    publisher.publish_signals(frame, step - kStepsPerFrame + 1);
    if (options.bad_frames && frame % 5 == 0) publisher.publish_bad_frame();
  }
  return 0;
}

int hold_domain() {
  std::printf("%d\n", test::own_domain());
  std::fflush(stdout);
  while (!node::wait_for_stop(std::chrono::hours(1))) {
  }
  return 0;
}

}  // namespace
}  // namespace cordis

int main(int argc, char** argv) {
  try {
    const cordis::Options options = cordis::read_options(argc, argv);
    cordis::node::install_stop_signals();
    return options.hold_domain ? cordis::hold_domain() : cordis::publish(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "scene_source: %s\n", error.what());
    return 1;
  }
}
