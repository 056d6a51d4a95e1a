// viz_node/frame_encoder.cpp
#include "viz_node/frame_encoder.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace cordis::viz {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the protocol is little endian, and positions are sent as they lie in memory");

/// Writes values one behind the other; the caller has reserved the room.
class Packer {
 public:
  explicit Packer(void* begin) noexcept : next_(static_cast<std::uint8_t*>(begin)) {}

  template <class Value>
  Packer& put(Value value) noexcept {
    std::memcpy(next_, &value, sizeof value);
    next_ += sizeof value;
    return *this;
  }

  template <class Container>
  Packer& put_all(const Container& values) noexcept {
    const std::size_t bytes = values.size() * sizeof(typename Container::value_type);
    if (bytes != 0) std::memcpy(next_, values.data(), bytes);
    next_ += bytes;
    return *this;
  }

  Packer& put_prefix(MessageType type, std::size_t header_bytes) noexcept {
    return put(kMagic)
        .put(kProtocolVersion)
        .put(static_cast<std::uint8_t>(type))
        .put(static_cast<std::uint16_t>(header_bytes));
  }

 private:
  std::uint8_t* next_;
};

}  // namespace

std::array<std::uint8_t, kFrameHeaderBytes> encode(const FrameHeader& header) noexcept {
  std::array<std::uint8_t, kFrameHeaderBytes> bytes{};
  Packer(bytes.data())
      .put_prefix(MessageType::kFrame, kFrameHeaderBytes)
      .put(header.sequence)
      .put(header.scene)
      .put(header.frame)
      .put(header.step)
      .put(header.taken_nsec)
      .put(header.sent_nsec)
      .put(header.simulated_s)
      .put(header.mat_count)
      .put(header.link_state_count)
      .put(header.dropped)
      .put(header.bond_count)
      .put(header.bonds_left_out)
      .put(header.set_count)
      .put(header.port_count);
  return bytes;
}

namespace {

/// Steps from one row to the next, in the mean.
double stride_of(const msg::SceneSignals& signals) noexcept {
  const std::vector<std::uint32_t>& steps = signals.row_step();
  if (steps.size() < 2 || steps.back() <= steps.front()) return signals.stride_steps();
  return static_cast<double>(steps.back() - steps.front()) / static_cast<double>(steps.size() - 1);
}

}  // namespace

std::string encode_signals(const msg::SceneSignals& signals, std::uint32_t scene,
                           double step_rate_hz) {
  const std::uint32_t columns = signals.signal_count();
  const auto rows = static_cast<std::uint32_t>(signals.value().size() / columns);
  std::string bytes(kSignalsHeaderBytes + signals.value().size() * sizeof(float), '\0');
  Packer packer(bytes.data());
  packer.put_prefix(MessageType::kSignals, kSignalsHeaderBytes)
      .put(scene)
      .put(columns)
      .put(rows)
      .put(std::uint32_t{signals.dropped_rows()})
      .put(std::uint64_t{signals.first_step()})
      .put(static_cast<double>(signals.first_step()) / step_rate_hz)
      .put(stride_of(signals) / step_rate_hz);
  for (const double value : signals.value()) packer.put(static_cast<float>(value));
  return bytes;
}

std::string encode_sound(const msg::SceneSound& sound, std::uint32_t scene) {
  const std::uint32_t sounds = sound.sound_count();
  std::string bytes(kSoundHeaderBytes + sound.value().size() * sizeof(float), '\0');
  Packer(bytes.data())
      .put_prefix(MessageType::kSound, kSoundHeaderBytes)
      .put(scene)
      .put(sounds)
      .put(static_cast<std::uint32_t>(sound.value().size() / sounds))
      .put(std::uint32_t{sound.dropped_steps()})
      .put(std::uint64_t{sound.first_step()})
      .put(double{sound.step_rate_hz()})
      .put(std::int64_t{sound.time_nsec()})
      .put_all(sound.value());
  return bytes;
}

std::string encode_topology(const msg::SceneDescription& description, std::uint32_t scene) {
  const auto mats = static_cast<std::uint32_t>(description.mat_kind().size());
  const auto links = static_cast<std::uint32_t>(description.link_ends().size() / 2);
  const std::vector<std::uint32_t>& machines = description.link_state_machine();
  std::string bytes(
      kTopologyHeaderBytes + 9 * std::size_t{mats} + 8 * std::size_t{links} + 2 * machines.size(),
      '\0');
  Packer packer(bytes.data());
  packer.put_prefix(MessageType::kTopology, kTopologyHeaderBytes)
      .put(scene)
      .put(mats)
      .put(links)
      .put(static_cast<std::uint32_t>(machines.size()))
      .put_all(description.mat_radius_m())
      .put_all(description.mat_mass_kg())
      .put_all(description.link_ends());
  for (const std::uint32_t machine : machines)
    packer.put(static_cast<std::uint16_t>(std::min<std::uint32_t>(machine, kNoStateMachine)));
  packer.put_all(description.mat_kind());
  return bytes;
}

}  // namespace cordis::viz
