// cli/bench/plain_loop.h -- spring-dampers as one would write them down first: the control of the
// engine's own times.
#pragma once

#include <cstddef>
#include <memory>

#include "sim_node/engine/description/network.h"

namespace cordis::cli {

/// Steps the masses and spring-dampers of a network by the scheme of `cordis`, one structure per
/// mass and per link, without an account, gravity, ports or fixed points. Compiled with -O3 for
/// SSE2, AVX2 and AVX-512; the processor takes the widest it has.
class PlainLoop {
 public:
  explicit PlainLoop(const engine::NetworkDescription& network);
  ~PlainLoop();
  PlainLoop(const PlainLoop&) = delete;
  PlainLoop& operator=(const PlainLoop&) = delete;

  void step() noexcept;
  double position(std::size_t mass, int axis) const noexcept;

  struct State;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace cordis::cli
