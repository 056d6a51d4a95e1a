// viz_node/pointer_server.cpp
#include "viz_node/pointer_server.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

namespace cordis::viz {
namespace {

using Json = nlohmann::json;
using Vector = std::array<double, 3>;

constexpr std::size_t kSentKept = 64;

double dot(const Vector& a, const Vector& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector less(const Vector& a, const Vector& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

bool is_finite(const Vector& v) noexcept {
  return std::ranges::all_of(v, [](double x) { return std::isfinite(x); });
}

/// A coordinate that no device exceeds; 0 for one that is not finite.
double bounded(double coordinate_m) noexcept {
  if (!std::isfinite(coordinate_m)) return 0.0;
  return std::clamp(coordinate_m, -PointerServer::kMaxCoordinate, PointerServer::kMaxCoordinate);
}

/// Bit n: axis n.
std::uint32_t mask_of(const std::vector<std::uint32_t>& axes) noexcept {
  std::uint32_t mask = 0;
  for (const std::uint32_t axis : axes) mask |= 1U << axis;
  return mask;
}

/// The sum of a value per axis times the direction of that axis.
template <class Port, class PerAxis>
Vector along(const Port& port, const PerAxis& value) {
  Vector sum{};
  for (std::size_t i = 0; i < port.axes.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += value[port.axes[i]] * port.directions[i][k];
  }
  return sum;
}

}  // namespace

std::optional<DragRequest> read_drag_request(std::string_view text) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || json.value("type", Json()) != "pointer") return std::nullopt;
  const Json port = json.value("port", Json());
  const Json event = json.value("event", Json(0u));
  const Json place_m = json.value("at_m", Json());
  if (!port.is_number_unsigned() || port.get<std::uint64_t>() > msg::NO_INDEX ||
      !event.is_number_unsigned())
    return std::nullopt;
  DragRequest request{port.get<std::uint32_t>(), event.get<std::uint64_t>(), std::nullopt};
  if (place_m.is_null()) return request;
  if (!place_m.is_array() || place_m.size() != 3) return std::nullopt;
  Vector place{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!place_m[k].is_number()) return std::nullopt;
    place[k] = place_m[k].get<double>();
  }
  request.at_m = place;
  return request;
}

PointerServer::PointerServer(std::uint64_t epoch, std::function<void(msg::PointerTarget&)> publish)
    : epoch_(epoch), publish_(std::move(publish)) {}

void PointerServer::describe(const std::vector<msg::PortDescription>& ports,
                             const std::vector<msg::PortFrame>& frames, std::int64_t now_nsec) {
  {
    const std::lock_guard lock(mutex_);
    for (auto& [id, device] : devices_) release(id, device, now_nsec);
    std::map<std::uint32_t, Device> before = std::exchange(devices_, {});
    ports_.clear();
    const std::size_t count = std::min(ports.size(), frames.size());
    for (std::size_t i = 0; i < count; ++i) {
      const msg::PortDescription& described = ports[i];
      const msg::PortFrame& frame = frames[i];
      Port port;
      port.device_id = described.device_id();
      port.mat = described.mat();
      const bool fits =
          frame.rest_m().size() == 3 && frame.direction().size() == 3 * described.axes().size() &&
          std::ranges::all_of(described.axes(),
                              [](std::uint32_t axis) { return axis < msg::MAX_AXES; });
      if (fits) {
        std::copy_n(frame.rest_m().begin(), 3, port.rest_m.begin());
        port.axes = described.axes();
        for (std::size_t a = 0; a < port.axes.size(); ++a) {
          const double* const direction = frame.direction().data() + 3 * a;
          port.directions.push_back({direction[0], direction[1], direction[2]});
        }
      }
      // The numbers go on: a device takes none twice.
      const auto known = before.find(port.device_id);
      Device& device = devices_[port.device_id];
      if (known != before.end() && device.number == 0) device = std::move(known->second);
      ports_.push_back(std::move(port));
    }
    ++version_;
  }
  report_change();
}

bool PointerServer::is_held(const Device& device, std::int64_t now_nsec) const noexcept {
  return device.page != 0 && now_nsec - device.spoken_nsec < kSilenceNsec;
}

bool PointerServer::is_present(const Device& device, std::int64_t now_nsec) noexcept {
  return device.state && now_nsec - device.state_nsec <= kAbsentNsec;
}

void PointerServer::drag(std::uint32_t page, const DragRequest& request,
                         const std::vector<float>& positions_m, std::int64_t now_nsec) {
  {
    const std::lock_guard lock(mutex_);
    if (request.port >= ports_.size()) return;
    const Port& port = ports_[request.port];
    Device& device = devices_.at(port.device_id);
    const std::uint32_t mask = mask_of(port.axes);
    const bool is_new = !is_held(device, now_nsec) || (device.held & mask) == 0;
    const bool is_early = now_nsec - device.spoken_nsec < kMinPauseNsec;
    if (is_held(device, now_nsec) && device.page != page) return;  // one hand at a time
    if (!request.at_m) {
      if (device.page != page || (device.held & mask) == 0) return;
      lead(device, now_nsec);
      let_go(device, port);
      if (device.held == 0) {
        release(port.device_id, device, now_nsec);
      } else {
        send(port.device_id, device, request.event, now_nsec);
      }
    } else {
      if (port.axes.empty() || !is_present(device, now_nsec) || !is_finite(*request.at_m)) return;
      if (is_new && is_early) return;  // the page repeats it
      if (is_new) take_hold(device, port, page, positions_m, now_nsec);
      const Vector way = less(*request.at_m, port.rest_m);
      for (std::size_t i = 0; i < port.axes.size(); ++i)
        device.wanted_m[port.axes[i]] = bounded(dot(way, port.directions[i]));
      if (is_early) return;
      lead(device, now_nsec);
      send(port.device_id, device, request.event, now_nsec);
      if (!is_new) return;
    }
    ++version_;
  }
  report_change();
}

/// The page takes hold of the port: its coordinates are where it is now. If no page held the device, so
/// are those of its other ports.
void PointerServer::take_hold(Device& device, const Port& taken, std::uint32_t page,
                              const std::vector<float>& positions_m, std::int64_t now_nsec) {
  const bool is_first = !is_held(device, now_nsec);
  if (is_first) {
    device.held = 0;
    device.target_m.fill(0.0);
    device.led_nsec = now_nsec;
  }
  for (const Port& port : ports_) {
    if (port.device_id != taken.device_id || (!is_first && &port != &taken)) continue;
    if (positions_m.size() < 3 * (std::size_t{port.mat} + 1)) continue;
    const float* const place = positions_m.data() + 3 * std::size_t{port.mat};
    const Vector way = less({place[0], place[1], place[2]}, port.rest_m);
    for (std::size_t i = 0; i < port.axes.size(); ++i)
      device.target_m[port.axes[i]] = bounded(dot(way, port.directions[i]));
  }
  if (is_first) device.wanted_m = device.target_m;
  device.page = page;
  device.held |= mask_of(taken.axes);
}

/// The coordinates of the port stay where they are.
void PointerServer::let_go(Device& device, const Port& port) noexcept {
  device.held &= ~mask_of(port.axes);
  for (const std::uint32_t axis : port.axes) device.wanted_m[axis] = device.target_m[axis];
}

/// Moves the targets towards what the page wants, for the time since they moved last.
void PointerServer::lead(Device& device, std::int64_t now_nsec) noexcept {
  const std::int64_t elapsed_nsec =
      std::clamp(now_nsec - device.led_nsec, std::int64_t{0}, kSilenceNsec);
  device.led_nsec = now_nsec;
  const double longest_m = kMaxSpeed * 1e-9 * static_cast<double>(elapsed_nsec);
  for (std::size_t axis = 0; axis < device.target_m.size(); ++axis)
    device.target_m[axis] +=
        std::clamp(device.wanted_m[axis] - device.target_m[axis], -longest_m, longest_m);
}

void PointerServer::release(std::uint32_t device_id, Device& device, std::int64_t now_nsec) {
  if (device.page == 0) return;
  device.page = 0;
  device.held = 0;
  send(device_id, device, 0, now_nsec);
}

void PointerServer::send(std::uint32_t device_id, Device& device, std::uint64_t event,
                         std::int64_t now_nsec) {
  if (!device.state) return;  // no such device has reported itself
  device.spoken_nsec = now_nsec;
  msg::PointerTarget target;
  target.device_id(device_id);
  target.epoch(epoch_);
  target.sequence_number(++device.number);
  target.time_nsec(now_nsec);
  target.holds(device.page != 0);
  target.held_coordinates(device.held);
  target.coordinate_count(device.state->coordinate_count());
  target.target_m(device.target_m);
  publish_(target);
  device.sent.push_back({device.number, event});
  if (device.sent.size() > kSentKept) device.sent.pop_front();
}

void PointerServer::leave(std::uint32_t page, std::int64_t now_nsec) {
  {
    const std::lock_guard lock(mutex_);
    for (auto& [id, device] : devices_) {
      if (device.page == page) release(id, device, now_nsec);
    }
    ++version_;
  }
  report_change();
}

void PointerServer::take(const msg::PointerState& state, std::int64_t now_nsec) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = devices_.find(state.device_id());
    if (found == devices_.end() || state.coordinate_count() > msg::MAX_AXES) return;
    const auto is_finite = [](double x) { return std::isfinite(x); };
    if (!std::ranges::all_of(state.force_n(), is_finite) ||
        !std::ranges::all_of(state.target_m(), is_finite))
      return;
    Device& device = found->second;
    device.state = state;
    device.state_nsec = now_nsec;
    if (state.followed_epoch() == epoch_) {
      for (const Sent& sent : device.sent) {
        if (sent.number == state.felt_number()) device.felt_event = sent.event;
      }
    }
    ++version_;
  }
  report_change();
}

std::uint64_t PointerServer::version() const {
  const std::lock_guard lock(mutex_);
  return version_;
}

std::string PointerServer::text(std::uint32_t page, std::int64_t now_nsec) const {
  const std::lock_guard lock(mutex_);
  Json list = Json::array();
  for (std::size_t i = 0; i < ports_.size(); ++i) {
    const Port& port = ports_[i];
    const Device& device = devices_.at(port.device_id);
    if (!device.state || now_nsec - device.state_nsec > kAbsentNsec || port.axes.empty()) continue;
    const msg::PointerState& state = *device.state;
    if (std::ranges::any_of(
            port.axes, [&state](std::uint32_t axis) { return axis >= state.coordinate_count(); }))
      continue;
    const bool held = is_held(device, now_nsec) && (device.held >> port.axes.front() & 1U) != 0;
    Vector target = along(port, state.target_m());
    for (std::size_t k = 0; k < 3; ++k) target[k] += port.rest_m[k];
    Json one{{"port", i}, {"holder", is_held(device, now_nsec) ? device.page : 0}, {"held", held}};
    one["plays"] = state.holds();
    one["event"] = device.page == page ? device.felt_event : 0;
    one["target_m"] = target;
    one["force_n"] = along(port, state.force_n());
    list.push_back(std::move(one));
  }
  return Json{{"type", "pointer"}, {"page", page}, {"ports", std::move(list)}}.dump();
}

void PointerServer::report_change() const {
  if (changed_) changed_();
}

}  // namespace cordis::viz
