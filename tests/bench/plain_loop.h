// tests/bench/plain_loop.h -- spring-dampers as one would write them down first: the control of the
// engine's own times.
#pragma once

#include "sim_node/engine/description/network.h"

namespace cordis::bench {

/// Steps the masses and spring-dampers of a network by the scheme of `cordis`, one structure per
/// mass and per link, without an account, gravity, ports or fixed points. Compiled with -O3 for the processor
/// that builds it.
class PlainLoop {
 public:
  explicit PlainLoop(const engine::NetworkDescription& network);
  ~PlainLoop();
  PlainLoop(const PlainLoop&) = delete;
  PlainLoop& operator=(const PlainLoop&) = delete;

  void step() noexcept;
  double position(std::size_t mass, int axis) const noexcept;

 private:
  struct State;
  State* state_;
};

}  // namespace cordis::bench
