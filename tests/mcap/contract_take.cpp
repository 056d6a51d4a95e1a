// tests/mcap/contract_take.cpp -- writes takes of random messages of the contract, and beside them
// what is in the messages, and the schema of every message of the contract, as JSON.
//
// usage: contract_take FOLDER SEED
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <nlohmann/json.hpp>

#include "idl/gesture.h"
#include "idl/scene.h"
#include "idl/schema_text.h"
#include "record_node/mcap/writer.h"

namespace cordis {
namespace {

using nlohmann::json;

std::mt19937 random_number;

std::uint32_t any_u32() {
  return static_cast<std::uint32_t>(random_number());
}

/// Numbers of 64 bits as text: JSON of a browser has no room for them.
std::string exact(std::uint64_t value) {
  return std::to_string(value);
}

std::uint64_t any_u64() {
  return std::uint64_t{any_u32()} << 32 | any_u32();
}

double any_double() {
  return std::uniform_real_distribution<double>(-1e3, 1e3)(random_number);
}

std::string any_text() {
  static const std::vector<std::string> kTexts{"", "string", "Saite ü", "弦", "a much longer name"};
  return kTexts[any_u32() % kTexts.size()];
}

template <class T>
std::vector<std::byte> payload_of(const T& message) {
  eprosima::fastcdr::FastBuffer buffer;
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                             eprosima::fastcdr::Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  message.serialize(cdr);
  const auto* bytes = reinterpret_cast<const std::byte*>(buffer.getBuffer());
  return {bytes, bytes + cdr.getSerializedDataLength()};
}

struct Sample {
  std::string topic;
  std::string type;
  std::vector<std::byte> payload;
  json value;
};

Sample any_positions() {
  msg::GesturePositions message;
  message.device_id(any_u32());
  message.epoch(any_u64());
  message.sample(any_u64());
  message.time_nsec(-static_cast<std::int64_t>(any_u64() >> 2));
  message.axis_count(any_u32() % 17);
  json positions = json::array();
  for (double& position : message.position_m()) {
    position = any_double();
    positions.push_back(position);
  }
  message.answer_delay_s(any_double());
  return {"gesture/positions",
          "cordis::msg::GesturePositions",
          payload_of(message),
          {{"device_id", message.device_id()},
           {"epoch", exact(message.epoch())},
           {"sample", exact(message.sample())},
           {"answered_epoch", "0"},
           {"answered_sample", "0"},
           {"answered_time_nsec", "0"},
           {"time_nsec", std::to_string(message.time_nsec())},
           {"axis_count", message.axis_count()},
           {"position_m", positions},
           {"answer_delay_s", message.answer_delay_s()}}};
}

Sample any_frame() {
  msg::SceneFrame message;
  message.frame(any_u64());
  message.simulated_s(any_double());
  json positions = json::array();
  json states = json::array();
  for (std::size_t i = any_u32() % 100; i > 0; --i) {
    message.position_m().push_back(static_cast<float>(any_double()));
    positions.push_back(static_cast<double>(message.position_m().back()));
  }
  for (std::size_t i = any_u32() % 20; i > 0; --i) {
    message.link_state().push_back(static_cast<std::uint8_t>(any_u32()));
    states.push_back(message.link_state().back());
  }
  json bond_ends = json::array();
  json bond_states = json::array();
  json forces = json::array();
  for (std::size_t i = any_u32() % 5; i > 0; --i) {
    message.bond_ends().insert(message.bond_ends().end(), {any_u32(), any_u32()});
    message.bond_state().push_back(static_cast<std::uint8_t>(any_u32()));
    bond_states.push_back(message.bond_state().back());
    message.port_force_n().push_back(static_cast<float>(any_double()));
    forces.push_back(static_cast<double>(message.port_force_n().back()));
  }
  for (const std::uint32_t end : message.bond_ends()) bond_ends.push_back(end);
  message.bonds_left_out(any_u32());
  return {"scene/frame",
          "cordis::msg::SceneFrame",
          payload_of(message),
          {{"epoch", "0"},
           {"version", "0"},
           {"frame", exact(message.frame())},
           {"step", "0"},
           {"time_nsec", "0"},
           {"action_time_nsec", "0"},
           {"simulated_s", message.simulated_s()},
           {"position_m", positions},
           {"position_hash", "0"},
           {"link_state", states},
           {"bond_ends", bond_ends},
           {"bond_state", bond_states},
           {"bond_count", json::array()},
           {"bonds_left_out", message.bonds_left_out()},
           {"port_force_n", forces}}};
}

Sample any_events() {
  msg::SceneEvents message;
  message.batch(any_u64());
  json events = json::array();
  for (std::size_t i = any_u32() % 5; i > 0; --i) {
    msg::LinkEvent event;
    event.step(any_u64());
    event.link(any_u32());
    event.quantity(static_cast<msg::EventQuantity>(any_u32() % (msg::QUANTITY_SLID + 1)));
    event.value(any_double());
    events.push_back({{"step", exact(event.step())},
                      {"link", event.link()},
                      {"mat_a", 0},
                      {"mat_b", 0},
                      {"state_machine", 0},
                      {"from_state", 0},
                      {"to_state", 0},
                      {"quantity", static_cast<int>(event.quantity())},
                      {"value", event.value()},
                      {"energy_j", 0}});
    message.event().push_back(event);
  }
  return {"scene/events",
          "cordis::msg::SceneEvents",
          payload_of(message),
          {{"epoch", "0"},
           {"version", "0"},
           {"batch", exact(message.batch())},
           {"lost", "0"},
           {"event", events}}};
}

Sample any_description() {
  msg::SceneDescription message;
  message.name(any_text());
  json signals = json::array();
  for (std::size_t i = any_u32() % 4; i > 0; --i) {
    msg::SignalDescription signal;
    signal.name(any_text());
    signal.unit("N");
    signal.rate(any_u32() % 2 == 0 ? msg::RATE_GESTURE : msg::RATE_STEP);
    signal.sound(any_u32() % 2 == 0);
    signal.full_scale(0.25 * static_cast<double>(any_u32() % 100));
    signals.push_back({{"name", signal.name()},
                       {"unit", "N"},
                       {"rate", static_cast<int>(signal.rate())},
                       {"sound", signal.sound()},
                       {"full_scale", signal.full_scale()}});
    message.signals().push_back(signal);
  }
  json ports = json::array();
  json port_frames = json::array();
  for (std::size_t i = any_u32() % 3; i > 0; --i) {
    msg::PortDescription port;
    port.name(any_text());
    port.role(any_u32() % 2 == 0 ? msg::ROLE_MASS : msg::ROLE_LIAISON);
    port.axes({0, static_cast<std::uint32_t>(any_u32())});
    ports.push_back({{"name", port.name()},
                     {"device", ""},
                     {"device_id", 0},
                     {"role", static_cast<int>(port.role())},
                     {"mat", 0},
                     {"axes", port.axes()}});
    message.ports().push_back(port);
    msg::PortFrame frame;
    frame.rest_m({0.25 * static_cast<double>(any_u32() % 100), 0.5, -1.5});
    frame.direction({0.0, 1.0, 0.0, 1.0, 0.0, 0.0});
    port_frames.push_back({{"rest_m", frame.rest_m()}, {"direction", frame.direction()}});
    message.port_frames().push_back(frame);
  }
  json surfaces = json::array();
  json surface_mat = json::array();
  for (std::size_t i = any_u32() % 3; i > 0; --i) {
    msg::SurfaceDescription surface;
    surface.name(any_text());
    surface.kind(any_u32() % 2 == 0 ? msg::SURFACE_PLANE : msg::SURFACE_CYLINDER);
    surface.centre_m({0.25 * static_cast<double>(any_u32() % 100), 0.5, -1.5});
    surface.axis({0.0, 1.0, 0.0});
    if (surface.kind() == msg::SURFACE_CYLINDER) surface.size_m({0.25, 2.0});
    surfaces.push_back({{"name", surface.name()},
                        {"kind", static_cast<int>(surface.kind())},
                        {"centre_m", surface.centre_m()},
                        {"axis", surface.axis()},
                        {"size_m", surface.size_m()}});
    message.surfaces().push_back(surface);
    message.surface_mat().push_back(any_u32());
    surface_mat.push_back(message.surface_mat().back());
  }
  json colours = json::array();
  for (std::size_t i = any_u32() % 3; i > 0; --i) {
    msg::ColouredRange range;
    range.first(any_u32());
    range.count(any_u32());
    range.red(static_cast<std::uint8_t>(any_u32()));
    range.green(static_cast<std::uint8_t>(any_u32()));
    range.blue(static_cast<std::uint8_t>(any_u32()));
    colours.push_back({{"first", range.first()},
                       {"count", range.count()},
                       {"red", range.red()},
                       {"green", range.green()},
                       {"blue", range.blue()}});
    message.colours().push_back(range);
  }
  json sets = json::array();
  for (std::size_t i = any_u32() % 3; i > 0; --i) {
    msg::SetDescription set;
    set.name(any_text());
    set.state_machine(any_u32());
    sets.push_back(
        {{"name", set.name()}, {"state_machine", set.state_machine()}, {"start_state", 0}});
    message.sets().push_back(set);
  }
  const json none = json::array();
  return {"scene/description",
          "cordis::msg::SceneDescription",
          payload_of(message),
          {{"wire_version", 0},
           {"epoch", "0"},
           {"version", "0"},
           {"name", message.name()},
           {"space", 0},
           {"step_rate_hz", 0},
           {"gesture_rate_hz", 0},
           {"frame_rate_hz", 0},
           {"mat_kind", none},
           {"mat_mass_kg", none},
           {"mat_radius_m", none},
           {"matter", none},
           {"link_ends", none},
           {"links", none},
           {"state_machines", none},
           {"link_state_machine", none},
           {"ports", ports},
           {"port_frames", port_frames},
           {"signals", signals},
           {"scene_file", ""},
           {"surfaces", surfaces},
           {"colours", colours},
           {"surface_mat", surface_mat},
           {"sets", sets}}};
}

bool write_take(const std::filesystem::path& folder, mcap::Compression compression) {
  const std::string name = mcap::name_of(compression);
  const std::string stem = name.empty() ? "none" : name;
  mcap::WriterConfig config;
  config.compression = compression;
  config.chunk_bytes = 20'000;
  mcap::Writer writer(folder / (stem + ".mcap"), config);
  std::map<std::string, std::uint16_t> channels;
  json values = json::array();
  std::uint64_t now = 1'700'000'000'000'000'000;
  bool is_good = true;
  for (std::uint32_t i = 1; i <= 400; ++i) {
    Sample (*const kinds[])() = {any_positions, any_frame, any_events, any_description};
    const Sample sample = kinds[any_u32() % 4]();
    if (!channels.contains(sample.topic)) {
      const std::string text(msg::schema_text_of(sample.type));
      is_good = is_good && !text.empty();
      const std::uint16_t schema = writer.add_schema({0, sample.type, "omgidl", text});
      channels[sample.topic] = writer.add_channel({0, schema, sample.topic, "cdr", {}});
    }
    now += any_u32() % 30'000'000;
    is_good = is_good &&
              writer.write({channels[sample.topic], i, now, now - 5, sample.payload}) ==
                  mcap::WriteStatus::kOk &&
              writer.close_chunk_if_older(now) == mcap::WriteStatus::kOk;
    values.push_back({{"topic", sample.topic},
                      {"sequence", i},
                      {"log_time", exact(now)},
                      {"publish_time", exact(now - 5)},
                      {"value", sample.value}});
  }
  const std::string scene = "cordis: 1\n";
  is_good = is_good &&
            writer.attach({"scene.yaml", "application/yaml", 1, 2,
                           std::as_bytes(std::span(scene))}) == mcap::WriteStatus::kOk &&
            writer.add_metadata({"cordis.session", {{"seed", "7"}}}) == mcap::WriteStatus::kOk &&
            writer.close() == mcap::WriteStatus::kOk;
  std::ofstream(folder / (stem + ".json")) << values.dump();
  return is_good;
}

}  // namespace
}  // namespace cordis

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  nlohmann::json schemas = nlohmann::json::object();
  for (const cordis::msg::SchemaText& schema : cordis::msg::schema_texts())
    schemas[std::string(schema.type)] = schema.text;
  std::ofstream(std::string(argv[1]) + "/schemas.json") << schemas.dump();
  cordis::random_number.seed(static_cast<unsigned>(std::stoul(argv[2])));
  bool is_good = true;
  for (const auto compression : {cordis::mcap::Compression::kNone, cordis::mcap::Compression::kLz4,
                                 cordis::mcap::Compression::kZstd})
    is_good = cordis::write_take(argv[1], compression) && is_good;
  return is_good ? 0 : 1;
}
