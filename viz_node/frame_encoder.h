// viz_node/frame_encoder.h -- the binary messages of the page's protocol (viz_node/web/README.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "idl/scene.h"

namespace cordis::viz {

inline constexpr std::uint32_t kMagic = 0x31534443;  // the bytes "CDS1"
inline constexpr std::uint8_t kProtocolVersion = 4;
inline constexpr std::size_t kFrameHeaderBytes = 88;
inline constexpr std::size_t kSignalsHeaderBytes = 48;
inline constexpr std::size_t kTopologyHeaderBytes = 24;
inline constexpr std::size_t kSoundHeaderBytes = 48;

enum class MessageType : std::uint8_t { kFrame = 1, kSignals = 2, kTopology = 3, kSound = 4 };

/// What stands before the positions of a frame. Positions, bonds, forces on ports and states follow as
/// they came over DDS.
struct FrameHeader {
  std::uint32_t sequence = 0;  ///< counts what viz_node has shown, from 1; a page acknowledges it
  std::uint32_t scene = 0;     ///< the description it belongs to
  std::uint64_t frame = 0;     ///< number that sim_node gave it
  std::uint64_t step = 0;
  std::int64_t taken_nsec = 0;  ///< CLOCK_MONOTONIC when sim_node took it
  std::int64_t sent_nsec = 0;   ///< CLOCK_MONOTONIC when viz_node sent it
  double simulated_s = 0.0;
  std::uint32_t mat_count = 0;
  std::uint32_t link_state_count = 0;
  std::uint32_t dropped = 0;  ///< frames that this client was not sent, since it came
  std::uint32_t bond_count = 0;
  std::uint32_t bonds_left_out = 0;
  std::uint32_t set_count = 0;   ///< number of sets of the description, or 0
  std::uint32_t port_count = 0;  ///< likewise
};

std::array<std::uint8_t, kFrameHeaderBytes> encode(const FrameHeader& header) noexcept;

/// A batch of signals: header, then rows x signals float32. The batch has been checked
/// (scene_check.h).
std::string encode_signals(const msg::SceneSignals& signals, std::uint32_t scene,
                           double step_rate_hz);

/// A block of sound: header, then steps x sounds float32. The block has been checked.
std::string encode_sound(const msg::SceneSound& sound, std::uint32_t scene);

inline constexpr std::uint16_t kNoStateMachine = 65535;  ///< the link has no states

/// What a page needs once per scene: radii, masses, link ends, state machines of links, kinds. The description has been checked.
std::string encode_topology(const msg::SceneDescription& description, std::uint32_t scene);

}  // namespace cordis::viz
