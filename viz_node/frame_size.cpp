// viz_node/frame_size.cpp
#include "viz_node/frame_size.h"

namespace cordis::viz {
namespace {

constexpr std::size_t kScalarBytes = 128;  // numbers, times, lengths of sequences and padding
constexpr std::size_t kPointBytes = 3 * sizeof(float);
constexpr std::size_t kBondBytes = 2 * sizeof(std::uint32_t) + 1;

}  // namespace

std::size_t largest_frame_bytes(const msg::SceneDescription& description) noexcept {
  const std::size_t sets = description.sets().size();
  return kScalarBytes + kPointBytes * (description.mat_kind().size() + description.ports().size()) +
         description.link_state_machine().size() + sizeof(std::uint32_t) * sets +
         (sets > 0 ? kBondBytes * msg::MAX_BONDS : 0);
}

bool arrives_whole(std::size_t frame_bytes, std::size_t socket_bytes) noexcept {
  return frame_bytes <= socket_bytes / 2;
}

}  // namespace cordis::viz
