// device_node/drivers/trajectory.cpp
#include "device_node/drivers/trajectory.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace cordis::device {
Trajectory::Trajectory(double start, std::vector<Move> moves, Shape shape, double period_s)
    : start_(start), moves_(std::move(moves)), shape_(shape), period_s_(period_s) {
  double free_from = 0.0;
  for (const Move& move : moves_) {
    if (!(move.begin_s >= free_from - kTimeResolution) || !(move.duration_s >= 0.0) ||
        !std::isfinite(move.to)) {
      throw std::invalid_argument("a move begins before the one before it has ended");
    }
    free_from = move.begin_s + move.duration_s;
  }
  if (!(period_s_ == 0.0 || period_s_ >= free_from - kTimeResolution)) {
    throw std::invalid_argument("the moves take longer than one repetition");
  }
}

Trajectory::Place Trajectory::locate(double time_s) const noexcept {
  if (moves_.empty()) return {start_, start_, 0.0, 1.0};
  double local = std::max(time_s, 0.0);
  bool repeated = false;
  if (period_s_ > 0.0) {
    const double repetitions = std::floor((local + kTimeResolution) / period_s_);
    local = std::max(0.0, local - repetitions * period_s_);
    repeated = repetitions > 0.0;
  }
  const auto next = std::upper_bound(moves_.begin(), moves_.end(), local + kTimeResolution,
                                     [](double t, const Move& move) { return t < move.begin_s; });
  const double first_from = repeated ? moves_.back().to : start_;
  if (next == moves_.begin()) return {first_from, first_from, 0.0, 1.0};

  const auto move = next - 1;
  const double elapsed = local - move->begin_s;
  if (elapsed + kTimeResolution >= move->duration_s) return {move->to, move->to, 0.0, 1.0};
  const double from = move == moves_.begin() ? first_from : (move - 1)->to;
  const double share = elapsed <= kTimeResolution ? 0.0 : elapsed / move->duration_s;
  return {from, move->to, move->duration_s, share};
}

double Trajectory::value_at(double time_s) const noexcept {
  const Place place = locate(time_s);
  if (place.duration_s == 0.0) return place.to;
  const double s = place.share;
  const double done = shape_ == Shape::kLinear ? s : s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
  return place.from + (place.to - place.from) * done;
}

double Trajectory::rate_at(double time_s) const noexcept {
  const Place place = locate(time_s);
  if (place.duration_s == 0.0) return 0.0;
  const double s = place.share;
  const double slope = shape_ == Shape::kLinear ? 1.0 : 30.0 * s * s * (1.0 - s) * (1.0 - s);
  return (place.to - place.from) * slope / place.duration_s;
}

}  // namespace cordis::device
