// viz_node/page_text.cpp
#include "viz_node/page_text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include <nlohmann/json.hpp>

#include "idl/gesture.h"
#include "node/control_verbs.h"
#include "node/status_words.h"
#include "node/time_scale.h"
#include "viz_node/frame_encoder.h"
#include "viz_node/render/surface_mats.h"

namespace cordis::viz {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLongestText = 300;    // of a text that another process wrote
constexpr std::size_t kLongestReply = 4000;  // the parameters of a scene, line by line
constexpr std::size_t kMaxStates = 64;       // of a liaison, and liaisons whose changes are counted
constexpr std::size_t kMaxNames = 2000;  // names of matter, links and ports that a page receives
constexpr std::size_t kMaxColours = 20'000;  // ranges of MATs with a colour of the scene, likewise

std::string clipped(const std::string& text) {
  return text.substr(0, kLongestText);
}

/// Texts of other processes may be anything: what is not UTF-8 is replaced, a number that is not
/// finite becomes null.
std::string written(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json ranges(const std::vector<msg::NamedRange>& named) {
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(named.size(), kMaxNames); ++i) {
    list.push_back({{"name", clipped(named[i].name())},
                    {"first", named[i].first()},
                    {"count", named[i].count()}});
  }
  return list;
}

Json axes_of(const msg::PortDescription& port) {
  Json list = Json::array();
  for (const std::uint32_t axis : port.axes()) {
    if (list.size() == msg::MAX_AXES) break;
    list.push_back(axis);
  }
  return list;
}

Json colours(const std::vector<msg::ColouredRange>& ranges) {
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(ranges.size(), kMaxColours); ++i) {
    const msg::ColouredRange& range = ranges[i];
    std::array<char, 8> hex{};
    std::snprintf(hex.data(), hex.size(), "#%02x%02x%02x", range.red(), range.green(),
                  range.blue());
    list.push_back({{"first", range.first()}, {"count", range.count()}, {"colour", hex.data()}});
  }
  return list;
}

/// A device as a page draws it.
Json device_json(const msg::DeviceDescription& device) {
  Json travels = Json::array();
  const auto count = std::min<std::uint32_t>(device.coordinate_count(), msg::MAX_AXES);
  for (std::size_t axis = 0; axis < count; ++axis) travels.push_back(device.travel_m()[axis]);
  return {{"name", clipped(device.device())},
          {"simulated", node::is_simulated_driver(device.driver())},
          {"key_pitch_m", device.key_pitch_m()},
          {"lowest_m", device.lowest_m()},
          {"travel_m", std::move(travels)}};
}

Json ports(const std::vector<msg::PortDescription>& described,
           const std::vector<msg::PortFrame>& frames) {
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(described.size(), kMaxNames); ++i) {
    const auto& port = described[i];
    const msg::PortFrame frame = i < frames.size() ? frames[i] : msg::PortFrame();
    list.push_back({{"name", clipped(port.name())},
                    {"device", clipped(port.device())},
                    {"role", port.role() == msg::ROLE_MASS ? "mass" : "liaison"},
                    {"mat", port.mat()},
                    {"axes", axes_of(port)},
                    {"rest", frame.rest_m()},
                    {"direction", frame.direction()}});
  }
  return list;
}

const char* word_of(msg::SurfaceKind kind) {
  switch (kind) {
    case msg::SURFACE_BOX:
      return "box";
    case msg::SURFACE_CYLINDER:
      return "cylinder";
    case msg::SURFACE_SEGMENT:
      return "segment";
    case msg::SURFACE_HOLLOW_BOX:
      return "hollow_box";
    case msg::SURFACE_HOLLOW_CYLINDER:
      return "hollow_cylinder";
    case msg::SURFACE_INNER_FACE:
      return "inner_face";
    case msg::SURFACE_PLANE:
      break;
  }
  return "plane";
}

Json surfaces(const msg::SceneDescription& description) {
  Json list = Json::array();
  const std::vector<std::uint32_t> mats = mats_of_surfaces(description);
  for (std::size_t i = 0; i < mats.size(); ++i) {
    const msg::SurfaceDescription& surface = description.surfaces()[i];
    list.push_back({{"name", clipped(surface.name())},
                    {"mat", mats[i] == msg::NO_INDEX ? Json() : Json(mats[i])},
                    {"kind", word_of(surface.kind())},
                    {"centre", surface.centre_m()},
                    {"axis", surface.axis()},
                    {"size", surface.size_m()}});
  }
  return list;
}

Json state_machines(const std::vector<msg::StateMachineDescription>& described) {
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(described.size(), kMaxNames); ++i) {
    Json states = Json::array();
    for (const std::string& state : described[i].states()) {
      if (states.size() == kMaxStates) break;
      states.push_back(clipped(state));
    }
    list.push_back({{"name", clipped(described[i].name())}, {"states", std::move(states)}});
  }
  return list;
}

Json sets(const std::vector<msg::SetDescription>& described) {
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(described.size(), kMaxNames); ++i) {
    list.push_back({{"name", clipped(described[i].name())},
                    {"state_machine", described[i].state_machine()},
                    {"start_state", described[i].start_state()}});
  }
  return list;
}

Json changes(const std::vector<msg::LiaisonChanges>& counted) {
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(counted.size(), kMaxStates); ++i) {
    list.push_back({{"liaison", clipped(counted[i].liaison())}, {"changes", counted[i].changes()}});
  }
  return list;
}

std::string state_of(const ReportedNode& node, std::int64_t now_nsec) {
  const msg::NodePhase phase = node.status.phase();
  const bool is_silent = now_nsec - node.received_nsec > kLostAfterNsec;
  return node::word_of(is_silent && !node::has_ended(phase) ? msg::PHASE_LOST : phase);
}

Json node_json(const ReportedNode& node, std::int64_t now_nsec) {
  const msg::NodeStatus& s = node.status;
  return {{"name", clipped(s.node())},
          {"host", clipped(s.host())},
          {"kind", node::word_of(s.kind())},
          {"epoch", std::to_string(s.epoch())},
          {"state", state_of(node, now_nsec)},
          {"text", clipped(s.text())},
          {"received_s", static_cast<double>(now_nsec - node.received_nsec) * 1e-9},
          {"target_rate_hz", s.target_rate_hz()},
          {"reached_rate_hz", s.reached_rate_hz()},
          {"mean_rate_hz", s.mean_rate_hz()},
          {"ticks", s.ticks()},
          {"overruns", s.overruns()},
          {"dropped", s.dropped()},
          {"latency_count", s.latency_count()},
          {"latency_p50_s", s.latency_p50_s()},
          {"latency_p99_s", s.latency_p99_s()},
          {"latency_max_s", s.latency_max_s()},
          {"link_samples", s.link_samples()},
          {"link_unanswered", s.link_unanswered()},
          {"energy_j", s.energy_j()},
          {"energy_drift", s.energy_drift()},
          {"integration_error_j", s.integration_error_j()},
          {"switching_energy_j", s.switching_energy_j()},
          {"port_work_j", s.port_work_j()},
          {"dissipated_j", s.dissipated_j()},
          {"largest_stability_number", s.largest_stability_number()},
          {"largest_partners", s.largest_partners()},
          {"certified_partners",
           s.certified_partners() == msg::NO_INDEX ? Json(nullptr) : Json(s.certified_partners())},
          {"overflowed_steps", s.overflowed_steps()},
          {"forgotten_pairs", s.forgotten_pairs()},
          {"refused_inputs", s.refused_inputs()},
          {"port_energy_j", s.port_energy_j()},
          {"passivity_ticks", s.passivity_ticks()},
          {"step", s.step()},
          {"changes", changes(s.changes())},
          {"lost_events", s.lost_events()},
          {"memory_bytes", s.memory_bytes()}};
}

struct QuantityWords {
  const char* name;
  const char* unit;
};

/// How a page shows what triggered a change of state; empty when nothing did.
QuantityWords words_of(msg::EventQuantity quantity) noexcept {
  switch (quantity) {
    case msg::QUANTITY_DISTANCE:
      return {"distance", "m"};
    case msg::QUANTITY_ELONGATION:
      return {"elongation", "m"};
    case msg::QUANTITY_SPEED:
      return {"speed", "m/s"};
    case msg::QUANTITY_SPEED_X:
      return {"speed x", "m/s"};
    case msg::QUANTITY_SPEED_Y:
      return {"speed y", "m/s"};
    case msg::QUANTITY_SPEED_Z:
      return {"speed z", "m/s"};
    case msg::QUANTITY_SLIP:
      return {"slip", "m/s"};
    case msg::QUANTITY_FORCE:
      return {"force", "N"};
    case msg::QUANTITY_IMPULSE:
      return {"impulse", "N s"};
    case msg::QUANTITY_AGE:
      return {"age", "s"};
    case msg::QUANTITY_REST_LENGTH:
      return {"rest", "m"};
    case msg::QUANTITY_MASS_A:
      return {"mass a", "kg"};
    case msg::QUANTITY_MASS_B:
      return {"mass b", "kg"};
    case msg::QUANTITY_SLID:
      return {"slip", "m"};
    case msg::QUANTITY_ANGLE:
      return {"angle", "rad"};
    case msg::QUANTITY_BEND:
      return {"bend", "rad"};
    case msg::QUANTITY_ANGULAR_SPEED:
      return {"speed", "rad/s"};
    case msg::QUANTITY_MOMENT:
      return {"moment", "N m"};
    case msg::QUANTITY_REST_ANGLE:
      return {"rest", "rad"};
    case msg::QUANTITY_NONE:
      break;
  }
  return {"", ""};
}

Json events_json(const ReceivedEvents& events) {
  Json newest = Json::array();
  for (const auto& event : events.newest) {
    const QuantityWords quantity = words_of(event.quantity());
    newest.push_back({{"step", event.step()},
                      {"link", event.link() == msg::NO_INDEX ? Json() : Json(event.link())},
                      {"mat_a", event.mat_a()},
                      {"mat_b", event.mat_b()},
                      {"state_machine", event.state_machine()},
                      {"from", event.from_state()},
                      {"to", event.to_state()},
                      {"quantity", quantity.name},
                      {"unit", quantity.unit},
                      {"value", event.value()},
                      {"energy_j", event.energy_j()}});
  }
  return {{"total", events.total}, {"lost", events.lost}, {"newest", std::move(newest)}};
}

Json replies_json(const ReceivedReplies& replies) {
  Json list = Json::array();
  for (const msg::ControlReply& reply : replies) {
    list.push_back({{"number", reply.command_id()},
                    {"node", clipped(reply.node())},
                    {"accepted", reply.accepted()},
                    {"text", reply.text().substr(0, kLongestReply)}});
  }
  return list;
}

/// True if a verb has a number as its argument, or in it.
bool has_value(msg::ControlVerb verb) noexcept {
  return verb == msg::VERB_SEEK || verb == msg::VERB_RATE || verb == msg::VERB_SET;
}

/// True if a page may ask for it.
bool is_for_pages(msg::ControlVerb verb) noexcept {
  return verb == msg::VERB_PAUSE || verb == msg::VERB_RESUME || verb == msg::VERB_STEP ||
         verb == msg::VERB_RESET || verb == msg::VERB_GET || verb == msg::VERB_LOAD ||
         has_value(verb);
}

}  // namespace

std::string hello_text(const std::string& session, const std::string& node,
                       const PageRights& rights, bool may_command) {
  return written({{"type", "hello"},
                  {"protocol", kProtocolVersion},
                  {"session", clipped(session)},
                  {"node", clipped(node)},
                  {"scenes", rights.scenes},
                  {"parameters", rights.parameters},
                  {"may_command", may_command}});
}

std::optional<std::string> argument_of(const PageCommand& command, const PageRights& rights) {
  switch (command.verb) {
    case msg::VERB_STEP:
      return std::to_string(command.steps);
    case msg::VERB_SEEK:
    case msg::VERB_RATE:
      return std::to_string(command.value);  // six decimals
    case msg::VERB_SET:
      if (!rights.parameters) return std::nullopt;
      return written(Json::object({{command.parameter, command.value}}));
    case msg::VERB_LOAD:
      if (command.scene >= rights.scenes.size()) return std::nullopt;
      return written(Json(rights.scenes[command.scene]));
    default:
      return "";
  }
}

std::string description_text(const msg::SceneDescription& description, std::uint32_t scene) {
  Json signals = Json::array();
  for (const auto& signal : description.signals()) {
    signals.push_back({{"name", clipped(signal.name())},
                       {"unit", clipped(signal.unit())},
                       {"sound", signal.sound()},
                       {"full_scale", signal.full_scale()}});
  }
  return written({{"type", "description"},
                  {"scene", scene},
                  {"epoch", std::to_string(description.epoch())},
                  {"version", description.version()},
                  {"name", clipped(description.name())},
                  {"scene_file", clipped(description.scene_file())},
                  {"space", description.space()},
                  {"step_rate_hz", description.step_rate_hz()},
                  {"gesture_rate_hz", description.gesture_rate_hz()},
                  {"frame_rate_hz", description.frame_rate_hz()},
                  {"mat_count", description.mat_kind().size()},
                  {"link_count", description.link_ends().size() / 2},
                  {"matter", ranges(description.matter())},
                  {"links", ranges(description.links())},
                  {"state_machines", state_machines(description.state_machines())},
                  {"sets", sets(description.sets())},
                  {"ports", ports(description.ports(), description.port_frames())},
                  {"signals", std::move(signals)},
                  {"surfaces", surfaces(description)},
                  {"colours", colours(description.colours())},
                  {"colours_left_out", description.colours().size() -
                                           std::min(description.colours().size(), kMaxColours)}});
}

std::string status_text(const std::vector<ReportedNode>& nodes,
                        const std::vector<msg::DeviceDescription>& devices,
                        const ReceivedEvents& events, const ReceivedReplies& replies,
                        const MirrorFigures& figures, std::uint32_t scene, std::int64_t now_nsec) {
  Json list = Json::array();
  for (const ReportedNode& node : nodes) list.push_back(node_json(node, now_nsec));
  Json described = Json::array();
  for (const msg::DeviceDescription& device : devices) described.push_back(device_json(device));
  return written(
      {{"type", "status"},
       {"scene", scene},
       {"sent_nsec", now_nsec},
       {"nodes", std::move(list)},
       {"devices", std::move(described)},
       {"events", events_json(events)},
       {"replies", replies_json(replies)},
       {"viz",
        {{"frames", figures.frames}, {"refused", figures.refused}, {"lost", figures.lost}}}});
}

std::optional<Acknowledgement> read_acknowledgement(std::string_view text) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || json.value("type", Json()) != "ack") return std::nullopt;
  const Json sequence = json.value("sequence", Json());
  const Json drawn = json.value("drawn", Json());
  if (!sequence.is_number_unsigned() || !drawn.is_boolean()) return std::nullopt;
  const auto number = sequence.get<std::uint64_t>();
  if (number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return Acknowledgement{static_cast<std::uint32_t>(number), drawn.get<bool>()};
}

std::optional<bool> read_sound_request(std::string_view text) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || json.value("type", Json()) != "sound") return std::nullopt;
  const Json on = json.value("on", Json());
  return on.is_boolean() ? std::optional(on.get<bool>()) : std::nullopt;
}

std::optional<PageCommand> read_page_command(std::string_view text) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || json.value("type", Json()) != "command") return std::nullopt;
  const Json verb = json.value("verb", Json());
  const Json steps = json.value("steps", Json(1u));
  if (!verb.is_string() || !steps.is_number_unsigned()) return std::nullopt;
  const node::ControlVerb* known = node::find_control_verb(verb.get<std::string>());
  if (known == nullptr || !is_for_pages(known->verb)) return std::nullopt;
  const Json value = json.value("value", Json());
  if (has_value(known->verb) && !value.is_number()) return std::nullopt;
  const Json parameter = json.value("parameter", Json(""));
  const Json scene = json.value("scene", Json());
  if (known->verb == msg::VERB_LOAD && !scene.is_number_unsigned()) return std::nullopt;
  if (!parameter.is_string()) return std::nullopt;
  const std::string name = parameter.get<std::string>();
  if (known->verb == msg::VERB_SET && name.empty()) return std::nullopt;
  return PageCommand{known->verb, steps.get<std::uint64_t>(),
                     value.is_number() ? value.get<double>() : 0.0, name,
                     scene.is_number_unsigned() ? scene.get<std::uint64_t>() : 0};
}

}  // namespace cordis::viz
