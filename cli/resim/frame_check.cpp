// cli/resim/frame_check.cpp
#include "cli/resim/frame_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim_node/engine/core/state_hash.h"
#include "sim_node/run/describe.h"
#include "sim_node/scene/naming.h"

namespace cordis::cli {
namespace {

std::uint64_t hash_of_positions(const sim::Simulation& simulation) {
  const auto& positions = simulation.world().positions();
  return engine::hash_of({positions.data(), static_cast<std::size_t>(positions.size())});
}

}  // namespace

double FrameFindings::rms_m() const noexcept {
  return distances == 0 ? 0.0 : std::sqrt(sum_of_squares_m2 / static_cast<double>(distances));
}

FrameCheck::FrameCheck(TakeReader& take, By by, double tolerance_m)
    : take_(take), by_(by), tolerance_m_(tolerance_m) {
  advance();
}

void FrameCheck::advance() {
  pending_.reset();
  pending_squares_ = 0.0;
  has_frame_ = take_.next(frame_);
}

/// Below 0: the frame is of an earlier step than the scene; above: of a later one.
int FrameCheck::order(const sim::Simulation& simulation, std::uint64_t version) const noexcept {
  if (frame_.version() != version) return frame_.version() < version ? -1 : 1;
  if (by_ != By::kTime) {
    const std::uint64_t step = simulation.world().step_count();
    return frame_.step() == step ? 0 : (frame_.step() < step ? -1 : 1);
  }
  const double ahead_s = frame_.simulated_s() - simulation.simulated_s();
  if (std::abs(ahead_s) < 0.5 * simulation.world().network().step()) return 0;
  return ahead_s < 0.0 ? -1 : 1;
}

void FrameCheck::check(const sim::Simulation& simulation, std::uint64_t version) {
  while (has_frame_) {
    const int place = order(simulation, version);
    if (place > 0) return;
    if (place < 0) {
      if (pending_) {
        close_frame(false);
      } else {
        ++findings_.unmatched;
        advance();
      }
      continue;
    }
    const bool is_equal =
        by_ == By::kHash && hash_of_positions(simulation) == frame_.position_hash();
    if (keeps_) keep(simulation);
    if (is_equal) {
      close_frame(true);
      continue;
    }
    map_mats(simulation, version);
    pending_ = difference(simulation);
    if (by_ == By::kTime) compare_forces(simulation);
    if (by_ == By::kHash) return;  // a command may follow in the same step, before the frame
    close_frame(pending_->largest_m <= tolerance_m_);
  }
}

FrameFindings FrameCheck::finish() {
  if (has_frame_ && pending_) close_frame(false);
  while (has_frame_) {
    ++findings_.beyond;
    advance();
  }
  return findings_;
}

void FrameCheck::close_frame(bool is_equal) {
  ++findings_.frames;
  if (is_equal) ++findings_.equal;
  if (pending_) {
    findings_.sum_of_squares_m2 += pending_squares_;
    findings_.distances += mats_.size();
    if (!is_equal && !findings_.first) findings_.first = pending_;
    if (!findings_.largest || pending_->largest_m > findings_.largest->largest_m)
      findings_.largest = pending_;
  }
  advance();
}

/// Which MATs stand for each other: all, in their order, where both have as many; else those of the
/// same name.
void FrameCheck::map_mats(const sim::Simulation& simulation, std::uint64_t version) {
  if (mapped_scene_ == &simulation.scene() && mapped_version_ == version) return;
  mapped_scene_ = &simulation.scene();
  mapped_version_ = version;
  layout_ = sim::layout_of(simulation.scene());
  mats_.clear();
  map_ports(simulation, version);
  const std::size_t in_frame = frame_.position_m().size() / 3;
  if (in_frame == simulation.scene().network.mats.size()) {
    for (std::uint32_t mat = 0; mat < in_frame; ++mat) mats_.emplace_back(mat, mat);
    return;
  }
  const msg::SceneDescription* description = take_.description(version);
  if (description == nullptr) return;
  for (const msg::NamedRange& ours : description->matter()) {
    for (const scene::NamedRange& theirs : simulation.scene().matter) {
      if (theirs.name != ours.name() || theirs.count != ours.count()) continue;
      for (std::uint32_t i = 0; i < theirs.count; ++i) {
        if (ours.first() + i < in_frame) mats_.emplace_back(ours.first() + i, theirs.first + i);
      }
    }
  }
}

void FrameCheck::map_ports(const sim::Simulation& simulation, std::uint64_t version) {
  ports_.clear();
  const msg::SceneDescription* description = take_.description(version);
  if (description == nullptr) return;
  const std::vector<scene::Port>& ports = simulation.scene().ports;
  const auto mats = sim::port_mats_of(simulation.scene());
  for (std::size_t ours = 0; ours < description->ports().size(); ++ours) {
    const std::string& name = description->ports()[ours].name();
    const auto theirs = std::ranges::find(ports, name, &scene::Port::name);
    if (theirs == ports.end()) continue;
    ports_.push_back({name, ours, mats[static_cast<std::size_t>(theirs - ports.begin())]});
  }
}

/// Takes of before wire version 10 may have no forces.
void FrameCheck::compare_forces(const sim::Simulation& simulation) {
  const std::vector<float>& taken = frame_.port_force_n();
  for (const ComparedPort& port : ports_) {
    if (taken.size() < 3 * port.in_frame + 3) continue;
    engine::Vec3 sum = engine::Vec3::Zero();
    for (const std::uint32_t mat : port.mats) sum += simulation.world().link_force(mat);
    std::array<float, 3> now{};
    layout_.show_force(port.mats.front(), sum.data(), now.data());
    const float* before = taken.data() + 3 * port.in_frame;
    const double far_n = std::hypot(now[0] - before[0], now[1] - before[1], now[2] - before[2]);
    if (findings_.force && far_n <= findings_.force->largest_n) continue;
    findings_.force = ForceDifference{.step = frame_.step(),
                                      .time_s = frame_.simulated_s(),
                                      .largest_n = far_n,
                                      .taken_n = std::hypot(before[0], before[1], before[2]),
                                      .now_n = std::hypot(now[0], now[1], now[2]),
                                      .port = port.name};
  }
}

FrameDifference FrameCheck::difference(const sim::Simulation& simulation) {
  FrameDifference found{frame_.version(), frame_.step(), frame_.simulated_s(), 0.0, {}};
  pending_squares_ = 0.0;
  const double* positions = simulation.world().positions().data();
  std::uint32_t worst = 0;
  double largest = 0.0;  // squared
  for (const auto& [in_frame, mat] : mats_) {
    std::array<float, 3> shown{};
    layout_.show(mat, positions + 4 * static_cast<std::size_t>(mat), shown.data());
    double square = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double way = static_cast<double>(shown[k]) -
                         static_cast<double>(frame_.position_m()[3 * std::size_t{in_frame} + k]);
      square += way * way;
    }
    pending_squares_ += square;
    if (square <= largest) continue;
    largest = square;
    worst = mat;
  }
  found.largest_m = std::sqrt(largest);
  if (largest > 0.0) found.mat = scene::call_mat(simulation.scene(), worst).name;
  return found;
}

void FrameCheck::keep(const sim::Simulation& simulation) {
  if (!computed_.empty() && computed_.back().frame == frame_.frame()) computed_.pop_back();
  Computed computed{frame_.epoch(), frame_.frame(), hash_of_positions(simulation), {}};
  const sim::FrameLayout layout = sim::layout_of(simulation.scene());
  const std::size_t count = simulation.scene().network.mats.size();
  computed.position_m.resize(3 * count);
  for (std::size_t mat = 0; mat < count; ++mat) {
    layout.show(mat, simulation.world().positions().data() + 4 * mat,
                computed.position_m.data() + 3 * mat);
  }
  computed_.push_back(std::move(computed));
}

}  // namespace cordis::cli
