// sim_node/plan/reference/reference_integrator.cpp
#include "sim_node/plan/reference/reference_integrator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace cordis::plan {
namespace {

constexpr int kColumns = 8;
constexpr int kFewestColumns = 4;
constexpr double kSmallestShare = 1e-15;  // of a step, against the time
constexpr int kHalvings = 200;            // of a step in which a link changes

/// How much longer the next step may be. The error of the last but one column is of order
/// 2 (columns - 1) + 1.
double factor_for(double error, int columns) {
  if (!std::isfinite(error)) return 0.1;
  return 0.9 * std::pow(std::max(error, 1e-12), -1.0 / (2 * columns - 1));
}

}  // namespace

ReferenceIntegrator::ReferenceIntegrator(engine::NetworkDescription network, double tolerance)
    : system_(std::move(network)),
      tolerance_(tolerance),
      next_step_(system_.network().step),
      longest_step_(system_.has_states() ? system_.network().step
                                         : std::numeric_limits<double>::infinity()),
      values_(system_.start()),
      columns_(kColumns) {}

void ReferenceIntegrator::set_velocity(std::uint32_t mat, const engine::Vec3& velocity) {
  const std::size_t first = system_.position_count() + 3 * static_cast<std::size_t>(mat);
  std::copy_n(velocity.data(), 3, values_.begin() + static_cast<std::ptrdiff_t>(first));
}

void ReferenceIntegrator::midpoint(double step, int parts, Values& after) {
  const double part = step / parts;
  system_.rate(values_, rate_);
  first_ = values_;
  second_.resize(values_.size());
  for (std::size_t i = 0; i < values_.size(); ++i) second_[i] = values_[i] + part * rate_[i];
  for (int n = 1; n < parts; ++n) {
    system_.rate(second_, rate_);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      first_[i] = std::exchange(second_[i], first_[i] + 2.0 * part * rate_[i]);
    }
  }
  system_.rate(second_, rate_);
  after.resize(values_.size());
  for (std::size_t i = 0; i < values_.size(); ++i) {
    after[i] = 0.5 * (second_[i] + first_[i] + part * rate_[i]);
  }
  evaluations_ += static_cast<std::uint64_t>(parts) + 1;
}

double ReferenceIntegrator::difference(const Values& after, const Values& lower) const {
  double error = 0.0;
  const std::size_t n = system_.position_count();
  const std::size_t ends[] = {0, n, 2 * n, after.size()};
  for (int group = 0; group < 3; ++group) {
    double largest = 0.0;
    double difference = 0.0;
    for (std::size_t i = ends[group]; i < ends[group + 1]; ++i) {
      largest = std::max({largest, std::abs(after[i]), std::abs(values_[i])});
      difference = std::max(difference, std::abs(after[i] - lower[i]));
      if (!std::isfinite(after[i])) return std::numeric_limits<double>::infinity();
    }
    if (largest > 0.0) error = std::max(error, difference / (largest * tolerance_));
  }
  return error;
}

ReferenceIntegrator::StepAttempt ReferenceIntegrator::try_step(double step, Values& after) {
  StepAttempt attempt;
  for (int k = 0; k < kColumns; ++k) {
    const int parts = 2 * (k + 1);
    Values fresh;
    midpoint(step, parts, fresh);
    // Neville's row: columns_[j] holds the value extrapolated over j + 1 of the last rows.
    for (int j = 0; j < k; ++j) {
      const double ratio = static_cast<double>(parts) / (2.0 * (k - j));
      const double share = 1.0 / (ratio * ratio - 1.0);
      Values& last = columns_[static_cast<std::size_t>(j)];
      for (std::size_t i = 0; i < fresh.size(); ++i) {
        const double old = std::exchange(last[i], fresh[i]);
        fresh[i] += (fresh[i] - old) * share;
      }
    }
    columns_[static_cast<std::size_t>(k)] = std::move(fresh);
    attempt.columns = k + 1;
    if (k + 1 < kFewestColumns) continue;
    attempt.error = difference(columns_[static_cast<std::size_t>(k)],
                               columns_[static_cast<std::size_t>(k - 1)]);
    if (attempt.error <= 1.0) break;
  }
  after = columns_[static_cast<std::size_t>(attempt.columns - 1)];
  return attempt;
}

void ReferenceIntegrator::accept(double step, Values& after) {
  time_ += step;
  std::swap(values_, after);
}

void ReferenceIntegrator::locate_change(double step, Values& after) {
  // The condition is false at the beginning of the step and true at its end.
  double low = 0.0;
  double high = step;
  Values attempt;
  for (int n = 0; n < kHalvings && high - low > kSmallestShare * std::max(time_, high); ++n) {
    const double middle = 0.5 * (low + high);
    try_step(middle, attempt);
    const bool true_there = system_.next_change(time_ + middle, attempt).has_value();
    (true_there ? high : low) = middle;
    if (true_there) after = attempt;
  }
  accept(high, after);
}

void ReferenceIntegrator::advance_to(double time) {
  Values after;
  while (time - time_ > kSmallestShare * std::max(1.0, time)) {
    while (const auto change = system_.next_change(time_, values_)) {
      system_.change(*change, time_, values_);
      ++changes_;
      if (changes_ % 1000000 == 0) throw std::runtime_error("the links change without end");
    }
    const double step = std::min({next_step_, longest_step_, time - time_});
    const StepAttempt attempt = try_step(step, after);
    if (!(attempt.error <= 1.0)) {
      next_step_ = step * std::clamp(factor_for(attempt.error, attempt.columns), 0.1, 0.9);
      if (next_step_ < kSmallestShare * std::max(time_, 1e-12)) {
        throw std::runtime_error("the motion is too rough at " + std::to_string(time_) + " s");
      }
      continue;
    }
    if (system_.has_states() && system_.next_change(time_ + step, after)) {
      locate_change(step, after);
      continue;
    }
    accept(step, after);
    // A step that was easy may be longer, whatever its few columns say.
    const double least = attempt.columns < kColumns - 1 ? 1.5 : 0.2;
    next_step_ = std::max(next_step_, step) *
                 std::clamp(factor_for(attempt.error, attempt.columns), least, 3.0);
  }
}

}  // namespace cordis::plan
