// viz_node/pointer_server.h -- which page holds which port, and what its hand feels.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "idl/gesture.h"
#include "idl/scene.h"

namespace cordis::viz {

/// What a page says about a port that it drags.
struct DragRequest {
  std::uint32_t port = 0;                     ///< number in the description
  std::uint64_t event = 0;                    ///< number of the event of the page
  std::optional<std::array<double, 3>> at_m;  ///< where it wants the port; absent: it lets go
};

/// Reads `{"type": "pointer", "port": 0, "at_m": [0, 0.1, 0], "event": 17}`, where `"at_m": null` lets
/// go; nothing when `text` is anything else.
std::optional<DragRequest> read_drag_request(std::string_view text);

/// Hands the ports of the scene to one page at a time, turns places into targets of devices, and
/// reports to pages who holds what and what is felt there.
///
/// A device belongs to the page that took hold of one of its ports first, until that page has let go
/// of all of them, leaves, or says nothing for kSilenceNsec. Any thread may call it.
///
/// Pages are not trusted. A hold begins where the ports are. From there the targets move at
/// kMaxSpeed at most, whatever places a page names. A device gets at most one target per
/// kMinPauseNsec, besides those that let go; a place in between counts with the next one.
class PointerServer {
 public:
  static constexpr std::int64_t kSilenceNsec = 500'000'000;
  static constexpr std::int64_t kAbsentNsec = 1'600'000'000;  ///< without a state of the device
  static constexpr std::int64_t kMinPauseNsec = 2'000'000;
  static constexpr double kMaxSpeed = 2.0;       ///< per coordinate [m/s]
  static constexpr double kMaxCoordinate = 4.0;  ///< from the rest of a coordinate [m]

  /// @param epoch    of this viz_node
  /// @param publish  writes a target; called with the lock held, must not wait
  PointerServer(std::uint64_t epoch, std::function<void(msg::PointerTarget&)> publish);

  /// Called, without a lock, when there is something new for the pages.
  void on_change(std::function<void()> call) { changed_ = std::move(call); }

  /// Another scene begins: all let go.
  void describe(const std::vector<msg::PortDescription>& ports,
                const std::vector<msg::PortFrame>& frames, std::int64_t now_nsec);

  /// @param page  number of the page, from 1
  /// @param positions_m  x, y, z of each MAT, as the newest frame has them
  void drag(std::uint32_t page, const DragRequest& request, const std::vector<float>& positions_m,
            std::int64_t now_nsec);
  void leave(std::uint32_t page, std::int64_t now_nsec);  ///< the page is gone
  void take(const msg::PointerState& state, std::int64_t now_nsec);

  std::uint64_t version() const;  ///< +1 with each change of what text() says
  /// JSON for a page: viz_node/web/README.md.
  std::string text(std::uint32_t page, std::int64_t now_nsec) const;

 private:
  struct Port {
    std::uint32_t device_id = 0;
    std::uint32_t mat = 0;
    std::array<double, 3> rest_m{};
    std::vector<std::uint32_t> axes;
    std::vector<std::array<double, 3>> directions;  // per axis
  };
  struct Sent {
    std::uint64_t number = 0;
    std::uint64_t event = 0;
  };
  struct Device {
    std::uint32_t page = 0;                    // that holds it; 0: none
    std::int64_t spoken_nsec = -kSilenceNsec;  // last message to the device
    std::uint32_t held = 0;                    // coordinates
    std::uint64_t number = 0;
    std::array<double, 16> wanted_m{};  // by the page
    std::array<double, 16> target_m{};  // on the way there
    std::int64_t led_nsec = 0;          // when the targets moved last
    std::deque<Sent> sent;              // the last ones, to find the event of a number
    std::optional<msg::PointerState> state;
    std::int64_t state_nsec = 0;
    std::uint64_t felt_event = 0;
  };

  bool is_held(const Device& device, std::int64_t now_nsec) const noexcept;
  static bool is_present(const Device& device, std::int64_t now_nsec) noexcept;
  void take_hold(Device& device, const Port& port, std::uint32_t page,
                 const std::vector<float>& positions_m, std::int64_t now_nsec);
  static void let_go(Device& device, const Port& port) noexcept;
  static void lead(Device& device, std::int64_t now_nsec) noexcept;
  void release(std::uint32_t device_id, Device& device, std::int64_t now_nsec);
  void send(std::uint32_t device_id, Device& device, std::uint64_t event, std::int64_t now_nsec);
  void report_change() const;

  const std::uint64_t epoch_;
  const std::function<void(msg::PointerTarget&)> publish_;
  std::function<void()> changed_;
  mutable std::mutex mutex_;
  std::vector<Port> ports_;
  std::map<std::uint32_t, Device> devices_;  // of the ports of the scene
  std::uint64_t version_ = 0;
};

}  // namespace cordis::viz
