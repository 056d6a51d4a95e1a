// tests/schema/corpus.cpp
#include "tests/schema/corpus.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <stdexcept>

#include "device_node/device_config.h"
#include "node/config/launch.h"
#include "node/config/yaml_reader.h"
#include "record_node/record_config.h"
#include "sim_node/scene/sections/scene_reader.h"
#include "sim_node/sim_config.h"
#include "tests/schema/document_json.h"
#include "tests/schema/variations.h"
#include "tests/support/filled.h"
#include "viz_node/viz_config.h"

namespace cordis::test {

namespace {

const std::filesystem::path kRoot = CORDIS_SOURCE_DIR;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(file), {}};
}

void add_folder(const std::string& sort, const std::string& folder, std::vector<Document>& all) {
  for (const auto& entry : std::filesystem::directory_iterator(kRoot / folder)) {
    if (entry.path().extension() == ".yaml")
      all.push_back({sort, entry.path().string(), text_of(entry.path())});
  }
}

/// The blocks of YAML in a document. Each says what it is after its three backticks.
void add_blocks(const std::filesystem::path& file, std::vector<Document>& all) {
  const std::string text = text_of(file);
  const std::regex block("```yaml ([a-z ]+)([^\n]*)\n([^`]*)```");
  for (std::sregex_iterator found(text.begin(), text.end(), block), end; found != end; ++found) {
    const std::string what = (*found)[1];
    const std::string name =
        (kRoot /
         (what.starts_with("scene") || what.starts_with("change") ? "launch_configs/scenes"
          : what.starts_with("device")                            ? "launch_configs/devices"
                                                                  : "launch_configs") /
         (file.stem().string() + "_" + std::to_string(all.size()) + ".yaml"))
            .string();
    const std::string code = (*found)[3];
    if (what.starts_with("scene")) {
      all.push_back({"scene", name, code, what.find("part") != std::string::npos});
    } else if (what.starts_with("launch")) {
      all.push_back({"launch", name, code});
    } else if (what.starts_with("nodes")) {
      all.push_back({"launch", name, "cordis: 1\n" + code});
    } else if (what.starts_with("device")) {
      all.push_back({"device", name, code});
    } else if (what.starts_with("change")) {
      all.push_back({"scene", name, code, true});
    } else {
      throw std::runtime_error("a block of an unknown sort: " + name);
    }
  }
}

constexpr const char* kSceneOnALine = R"(cordis: 1
name: line
space: 1
step: {rate_hz: 10000, gesture_rate_hz: 1000, frame_rate_hz: 25, integrator: cordis, freeze: {tolerance_m: 1.0e-6}}
world: {parameters: {g: 9.81}, gravity_m_per_s2: -g * cos(time_s), viscosity_n_s_per_m: 0.01, flow_m_per_s: 0.1}
reduce: {parallel: true}
parts:
  pair:
    parameters: {mass_kg: 0.01}
    matter: {ends: {kind: points, mass_kg: $mass_kg, at_m: [0, 0.1]}}
    links: [{liaison: soft, between: ["ends[0]", "ends[1]"]}]
matter:
  one: {kind: mass, mass_kg: 0.1, at_m: 0.5, velocity_m_per_s: 0, layout_at_m: [0, 0], medium_viscosity_n_s_per_m: 0.1}
  ball: {kind: mass, at_m: 0.9, ball: {mass_kg: 0.1, radius_m: 0.01}}
  wall: {kind: fixed, at_m: 0, ball: {radius_m: 0.01}}
  shaker: {kind: fixed, driven: {parameters: {f_hz: 2}, position_m: 0.1 * sin(2 * pi * f_hz * time_s)}}
  slider: {kind: fixed, at_m: 0, driven: {displacement_m: {at_s: [0, 1], values: [0, 0.1], between: smooth}}}
  some: {kind: points, at_m: [1, 2], mass_kg: 0.1}
  string: {kind: string, count: 4, mass_kg: 0.01, stiffness_n_per_m: 100, layout_at_m: [0, 0], layout_spacing_m: 0.1}
  threaded: {kind: string, count: 4, mass_kg: 0.01, liaison: soft, ends: fixed}
  loop: {kind: ring, count: 4, mass_kg: 0.01, stiffness_n_per_m: 100}
  net: {kind: grid, rows: 2, columns: 2, mass_kg: 0.01, stiffness_n_per_m: 100}
  floor: {kind: plane, at_m: -1, normal: [1]}
  chest: {kind: box, center_m: 0, size_m: 0.1}
  twins: {part: pair, translate_m: 6, layout_translate_m: [0, 0], repeat: {count: 2, translate_m: 0.1}, parameters: {mass_kg: 0.02}, driven: {displacement_m: 0}}
liaisons:
  soft: {kind: spring_damper, stiffness_n_per_m: k_n_per_m, viscosity_n_s_per_m: 0.1, rest_m: 0.1, parameters: {k_n_per_m: 10}}
  spring: {kind: spring, stiffness_n_per_m: 10}
  damper: {kind: damper, viscosity_n_s_per_m: 10}
  maxwell: {kind: maxwell, stiffness_n_per_m: 10, viscosity_n_s_per_m: 1, start_force_n: 0.1}
  both: {kind: parallel, parallel: [soft, {kind: spring, stiffness_n_per_m: 1}]}
  both_unnamed: {parallel: [soft, spring]}
  softer: {like: soft}
  stated: {kind: state_machine, states: {on: {stiffness_n_per_m: 1, exits: [{to: off, when: elongation_m > 1, rest: here}]}, off: {final: true}}, start: on, range: rest}
  table: {elasticity: {kind: table, at_m: [0, 1], force_n: [0, 1]}, dissipation: {kind: table, at_m_per_s: [0, 1], force_n: [0, 1]}, range_m: 1}
  power: {elasticity: {kind: power, coefficient: 1, exponent: 2}, dissipation: {kind: power, coefficient: 1, exponent: 2}}
  attracting: {elasticity: {kind: lennard_jones, depth_j: 1.0e-5, diameter_m: 0.01, cut_m: 0.02}}
  rings: {elasticity: {kind: rings, rings: [{stiffness_n_per_m: 1, radius_m: 0.1}]}}
  rubbing: {kind: state_machine, stiffness_n_per_m: 1, force_limit_n: 2, pulls: false, pushes: true, friction: {static: 0.5, kinetic: 0.4, stiffness_n_per_m: 100, viscosity_n_s_per_m: 1}}
  gripping:
    friction: {static: 0.5, stiffness_n_per_m: 100}
    states:
      holds: {friction: {static: 0.9, kinetic: 0.8, stiffness_n_per_m: 90, viscosity_n_s_per_m: 2}, pulls: false, exits: [{to: slides, when: slip_m > 0.1}]}
      slides: {friction: none, pulls: false, exits: [{to: holds, when: normal_force_n < 1}]}
links:
  - {liaison: soft, between: [one, wall], name: held, rest_m: 0.2}
  - {liaison: rings, within: some, range_m: 0.01}
  - {liaison: stated, between_sets: [some, string], rest: radii}
ports:
  key: {device: keyboard, axes: [0], role: mass, at_m: 0.2, along: x, layout_at_m: [0, 0],
        ball: {radius_m: 0.01}, coupling: {stiffness_n_per_m: 500, viscosity_n_s_per_m: 1, mass_kg: 0.05},
        needs: {travel_m: 0.01, up_m: 0.001, down_m: 0.01, force_n: 1}}
  other: {device: lever, axes: [0], role: liaison, at_m: 0.3, mass_kg: 0.1, coupling: direct}
signals:
  place: {of: one, quantity: position, rate: step, sound: true, full_scale: 1}
  energy: {quantity: energy}
  stretch: {of: held, quantity: elongation, take: mean}
)";

constexpr const char* kSceneOfPlane = R"(cordis: 1
space: 2
accuracy: {tolerance: 0.01, band_hz: 100, contact_energy: 0.1, over_s: 1}
step: {gesture_rate_hz: 1000}
world: {gravity_m_per_s2: [0, -9.81]}
parts:
  wheel:
    parameters: {ball: {mass_kg: 0.1, radius_m: 0.01}, ends: free}
    matter:
      hub: {kind: mass, at_m: [0, 0], ball: $ball}
      rim: {kind: string, count: 3, mass_kg: 0.1, from_m: [1, 0], to_m: [2, 0], ends: $ends, stiffness_n_per_m: 10}
matter:
  one: {kind: mass, mass_kg: 0.1, at_m: [[0, 0], [1, 0]], velocity_m_per_s: [0, 0], drawn_radius_m: 0.01, fixed: true, color: '#ff8800'}
  pushed: {kind: mass, displacement_m: [0, 0], mass_kg: 0.1, at_m: [0, 3], driven: {force_n: [sin(time_s) - x_m, 0]}}
  some: {kind: points, displacement_m: [0, 0], at_m: [[2, 0], [3, 0]], mass_kg: [0.1, 0.2], velocity_m_per_s: [[0, 0], [0, 0]], radius_m: 0.01, fixed: [0]}
  string: {kind: string, displacement_m: [0, 0], count: 4, mass_kg: 0.01, from_m: [4, 0], to_m: [5, 0], ends: fixed, stiffness_n_per_m: 100, tension_n: 1}
  loop: {kind: ring, displacement_m: [0, 0], velocity_m_per_s: [0, 0], count: 8, mass_kg: 0.01, center_m: [6, 0], radius_m: 0.1, stiffness_n_per_m: 100, viscosity_n_s_per_m: 0.1}
  net: {kind: grid, displacement_m: [0, 0], rows: 2, columns: 2, mass_kg: 0.01, corner_m: [7, 0], spacing_m: 0.1, border: fixed, stiffness_n_per_m: 100, rest_m: 0.1, shear_stiffness_n_per_m: 10, shear_viscosity_n_s_per_m: 0.1}
  crystal: {kind: lattice, displacement_m: [0, 0], structure: square, spacing_m: 0.1, corner_m: [8, 0], counts: [2, 2], mass_kg: 0.01, stiffness_n_per_m: 100}
  cut: {kind: lattice, structure: triangular, spacing_m: 0.1, region: {from_m: [9, 0], to_m: [9.5, 0.5]}, mass_kg: 0.01}
  plate: {kind: disc, displacement_m: [0, 0], center_m: [10, 0], radius_m: 0.2, spacing_m: 0.1, structure: rings, mass_kg: 0.01, stiffness_n_per_m: 100}
  heap: {kind: pack, displacement_m: [0, 0], ball: {mass_kg: 0.01, radius_m: 0.01}, region: {center_m: [11, 0], radius_m: 0.1}, count: 3, seed: 1}
  full: {kind: pack, ball: {mass_kg: 0.01, radius_m: 0.01}, region: {from_m: [12, 0], to_m: [12.1, 0.1]}, fill: 0.1}
  bag: {kind: skin, displacement_m: [0, 0], velocity_m_per_s: [0, 0], center_m: [13, 0], radius_m: 0.1, count: 8, mass_kg: 0.01, stiffness_n_per_m: 100, core: {mass_kg: 0.1, stiffness_n_per_m: 10, viscosity_n_s_per_m: 0.1}}
  house: {kind: skin, corners_m: [[14, 0], [15, 0], [14, 1]], spacing_m: 0.1, mass_kg: 0.01, stiffness_n_per_m: 100}
  bar: {kind: beam, displacement_m: [0, 0], cells: 2, from_m: [16, 0], to_m: [16.2, 0], height_m: 0.1, mass_kg: 0.01, stiffness_n_per_m: 100, ends: first_fixed}
  floor: {kind: plane, at_m: [0, -1], normal: y, sides: both}
  chest: {kind: box, center_m: [0, -5], size_m: [0.1, 0.1], sides: both}
  crate: {kind: box, from_m: [1, -5], to_m: [2, -6]}
  pole: {kind: cylinder, center_m: [3, -5], radius_m: 0.1, sides: one}
  hills: {kind: polyline, corners_m: [[0, -7], [1, -6.5], [2, -7]], closed: true}
  row: {part: wheel, translate_m: [20, 0], rotate_deg: 10, color: teal, repeat: {count: 2, translate_m: [1, 0], rotate_deg: 5}}
liaisons:
  touch: {stiffness_n_per_m: 100, range_m: 0.1, pulls: false}
  steel: {kind: bending, stiffness_n_m_per_rad: 1, viscosity_n_m_s_per_rad: 0.1, rest_rad: 0.1, length_m: 0.1}
  cord: {kind: bending, elasticity: 2 * bend_rad, dissipation: 0.1 * speed_rad_per_s}
  tin: {kind: bending, elasticity: {kind: table, at_rad: [-1, 1], moment_n_m: [-1, 1]}, dissipation: {kind: table, at_rad_per_s: [-1, 1], moment_n_m: [-1, 1]}}
links:
  - {liaison: steel, along: loop, stiffness_n_m_per_rad: 2, viscosity_n_m_s_per_rad: 0.2}
  - {liaison: touch, between_sets: [heap, floor], range_m: 0.1}
ports:
  hand: {device: mouse, axes: [0, 1], role: mass, at_m: [0, 1], along: [x, y]}
  grip: {device: glove, axes: [0, 1], role: liaison, of: plate}
signals:
  pile: {of: heap, quantity: pieces, near_m: 0.1}
  force: {of: hand, quantity: force, axis: y}
  landing: {of: heap, by: floor, quantity: contact_force, axis: y}
  spin: {of: heap, quantity: angular_momentum, about_m: [0, 0]}
)";

constexpr const char* kSceneOfSpace = R"(cordis: 1
space: 3
step: {rate_hz: 10000}
reduce: [series]
settle: {until_n: 1.0e-6, steps: 1000}
start_state: none.state
parts:
  rod: {ports: {end: {device: rods, axes: [0], role: mass, at_m: [0, 1, 0]}}, matter: {tip: {kind: mass, mass_kg: 0.1, at_m: [0, 0, 0]}}}
matter:
  one: {kind: mass, mass_kg: 0.1, at_m: [0, 0, 0]}
  wall: {kind: fixed, at_m: [0, 0, 1]}
  net: {kind: grid, rows: 2, columns: 2, mass_kg: 0.01, corner_m: [1, 0, 0], spacing_m: 0.1, plane: xz, stiffness_n_per_m: 100}
  loop: {kind: ring, count: 8, mass_kg: 0.01, center_m: [2, 0, 0], radius_m: 0.1, plane: xz, stiffness_n_per_m: 100}
  string: {kind: string, count: 4, mass_kg: 0.01, from_m: [3, 0, 0], to_m: [4, 0, 0], stiffness_n_per_m: 100}
  crystal: {kind: lattice, structure: fcc, spacing_m: 0.1, corner_m: [5, 0, 0], counts: [2, 2, 2], mass_kg: 0.01, stiffness_n_per_m: 100}
  plate: {kind: disc, center_m: [6, 0, 0], radius_m: 0.2, spacing_m: 0.1, plane: xy, mass_kg: 0.01}
  sphere: {kind: ball, displacement_m: [0, 0, 0], center_m: [7, 0, 0], radius_m: 0.2, spacing_m: 0.1, structure: cubic, mass_kg: 0.01, stiffness_n_per_m: 100}
  heap: {kind: pack, ball: {mass_kg: 0.01, radius_m: 0.01}, region: {from_m: [8, 0, 0], to_m: [8.1, 0.1, 0.1]}, count: 3}
  bag: {kind: skin, center_m: [9, 0, 0], radius_m: 0.1, subdivisions: 0, mass_kg: 0.01, stiffness_n_per_m: 100}
  bar: {kind: beam, cells: 2, from_m: [10, 0, 0], to_m: [10.2, 0, 0], height_m: 0.1, width_m: 0.1, up: z, mass_kg: 0.01, stiffness_n_per_m: 100}
  floor: {kind: plane, at_m: [0, -1, 0], normal: y}
  chest: {kind: box, center_m: [0, -5, 0], size_m: [0.1, 0.1, 0]}
  pole: {kind: cylinder, center_m: [1, -5, 0], radius_m: 0.1, axis: y, length_m: 1}
  rods: {part: rod, translate_m: [20, 0, 0], rotate: {axis: z, deg: 10}, repeat: {count: 2, translate_m: [1, 0, 0], rotate: {axis: y, deg: 5}}}
liaisons: {}
)";

constexpr const char* kLaunch = R"(cordis: 1
session: cover
domain: 1
clock: realtime
network: {interface: eth0, peers: [192.168.5.2], multicast: true}
security: keys
nodes:
  sim: {node: sim_node, scene: none.yaml, duration_s: 1, force: true, paused: true, delay_quantile: 0.9, signals_for: cordis, recorded_by: [tape], threads: 2}
  key: {node: device_node, device: devices/keyboard.yaml}
  view: {node: viz_node, address: 127.0.0.1, port: 8080, rate_hz: 25, scenes: [none.yaml], parameters: true, foxglove: true}
  tape: {node: record_node, out: none.mcap, topics: [scene/*], exclude: none, idl: none.idl, compression: lz4}
record: {out: none.mcap}
)";

std::string device_with(const std::string& hand) {
  const std::string wire = "{port: /dev/null, coupling: {}}";
  return filled(R"(cordis: 1
axes: 4
end_piece: {map: [[1, 0, 0, 0]]}
passivity: {}
trace: {file: /tmp/trace.csv}
script: {positions: [{at_s: 0, m: 0}]}
replay: {take: none.mcap}
kfb1: <wire>
firefader: <wire>
haply: <wire>
mock: {key: {}, sensor: {}, hand: {axes: [0, 1, 2, 3], finger: {}, <hand>}}
)",
                {{"wire", wire}, {"hand", hand}});
}

void read_device(const config::Launch& launch, const config::LaunchNode& node,
                 config::Problems& problems) {
  try {
    static_cast<void>(device::load_device(launch, node, problems));
  } catch (const std::exception&) {  // the problems say why
  }
}

void read_launch(const Document& document, config::Problems& problems) {
  for (const char* clock : {"clock=realtime", "clock=lockstep", "clock=asap"}) {
    const config::Launch launch =
        config::load_launch_text(document.text, document.name, {clock}, problems);
    for (const config::LaunchNode& node : launch.nodes) {
      if (node.program == "sim_node") static_cast<void>(sim::read_sim_section(node, problems));
      if (node.program == "viz_node") static_cast<void>(viz::read_viz_config(node, problems));
      if (node.program == "record_node")
        static_cast<void>(record::read_record_section(node, problems));
      if (node.program == "device_node") read_device(launch, node, problems);
    }
  }
}

std::vector<Document> load_shipped_documents() {
  std::vector<Document> all;
  add_folder("scene", "launch_configs/scenes", all);
  add_folder("scene", "launch_configs/lab", all);
  add_folder("launch", "launch_configs", all);
  add_folder("device", "launch_configs/devices", all);
  const std::filesystem::path foreign = kRoot / "examples/foreign_device";
  all.push_back({"launch", foreign / "launch.yaml", text_of(foreign / "launch.yaml")});
  all.push_back({"scene", foreign / "scene.yaml", text_of(foreign / "scene.yaml")});
  for (const auto& entry : std::filesystem::directory_iterator(kRoot / "docs")) {
    if (entry.path().extension() == ".md") add_blocks(entry.path(), all);
  }
  add_blocks(kRoot / "README.md", all);
  return all;
}

}  // namespace

std::vector<Document> shipped_documents() {
  static const std::vector<Document> kAll = load_shipped_documents();
  return kAll;
}

std::vector<Document> cover_documents() {
  std::vector<Document> all{
      {"scene", "line", kSceneOnALine},
      {"scene", "plane", kSceneOfPlane},
      {"scene", "space", kSceneOfSpace},
      {"launch", kRoot / "launch_configs/cover.yaml", kLaunch},
      {"device", "moves", device_with("moves: [{at_s: 0, in_s: 1, to_m: 0}]")},
      {"device", "one axis", "axes: 1\nmock: {key: {}, hand: {}}\n"},
      {"device", "forces", R"(axes: 1
driver: script
script: {forces: [{at_s: 0, n: 0}]}
)"},
      {"device", "pointer",
       R"(axes: 1
driver: pointer
pointer: {key: {}, hand: {axes: [0], finger: {}}, sensor: {}}
)"}};
  for (const char* kind : {"hold", "reach_and_press", "pluck", "bow", "grasp_and_drag", "knead"})
    all.push_back({"device", kind, device_with("gesture: {kind: " + std::string(kind) + "}")});
  return all;
}

void read(const Document& document, config::Problems& problems) {
  if (document.sort == "scene") {
    static_cast<void>(scene::load_scene_text(document.text, document.name, problems));
  } else if (document.sort == "launch") {
    read_launch(document, problems);
  } else {
    try {
      const config::Value value = config::load_text(document.text, document.name, problems);
      static_cast<void>(device::read_device(value, "device", problems));
    } catch (const config::ConfigError&) {  // the problems say why
    }
  }
}

namespace {

FileFacts observed_facts(const std::string& sort) {
  FileFacts facts;
  std::vector<Document> all = cover_documents();
  if (sort != "device") {
    for (Document& document : shipped_documents()) {
      if (!document.is_part) all.push_back(std::move(document));
    }
  }
  for (const Document& document : all) {
    if (document.sort != sort) continue;
    config::Problems problems;
    const config::Value root = config::load_text(document.text, document.name, problems);
    const config::KeyLog log;
    read(document, problems);
    facts.add(root, log);
  }
  config::Problems problems;
  facts.add_parameter_names(
      config::load_file(kRoot / "launch_configs/liaisons/standard.yaml", problems));
  return facts;
}

}  // namespace

FileFacts facts_of(const std::string& sort) {
  static std::map<std::string, FileFacts> known;
  const auto found = known.find(sort);
  return found != known.end() ? found->second
                              : known.emplace(sort, observed_facts(sort)).first->second;
}

void add_variations(const std::string& sort, FileFacts& facts) {
  const FileFacts base = facts;
  Variations variations(base);
  std::vector<Document> all = cover_documents();
  std::erase_if(all, [&](const Document& document) { return document.sort != sort; });
  for (const Document& document : all) variations.learn(json_of_text(document.text));
  for (const Document& document : all) {
    const auto take = [&](const std::string& text, const std::string& section) {
      const Document variation{sort, document.name, text};
      config::Problems problems;
      const config::Value root = config::load_text(text, document.name, problems);
      const config::KeyLog log;
      read(variation, problems);
      facts.add_variation(root, section, log, problems);
    };
    variations.of(json_of_text(document.text), take);
  }
}

}  // namespace cordis::test
