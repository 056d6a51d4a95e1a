// sim_node/checks/partner_watch.cpp
#include "sim_node/checks/partner_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "node/config/count_text.h"
#include "sim_node/plan/plan.h"
#include "sim_node/scene/naming.h"

namespace cordis::sim {
namespace {

/// True if `a` is nearer to its number, or farther beyond it, than `b`. A number that is passed is
/// nearer than every other, for the share largest / (certified + 1) is at least 1 there alone.
bool is_nearer(const PartnersSeen& a, const PartnersSeen& b) noexcept {
  return std::uint64_t{a.largest} * (std::uint64_t{b.certified} + 1) >
         std::uint64_t{b.largest} * (std::uint64_t{a.certified} + 1);
}

}  // namespace

PartnerWatch::PartnerWatch(const engine::NetworkDescription& network) {
  if (network.sets.empty()) return;
  const plan::LiaisonGraph graph = plan::liaison_graph(network);
  if (plan::uncertainty_of(network, graph)) return;
  const bool holds = network.integrator != engine::IntegratorKind::kModal &&
                     network.step < plan::certified_bound(network, graph).step;
  for (const plan::PartnerLimit& limit : plan::partner_limits(network, graph, holds)) {
    const engine::SetLiaison& set = network.sets[limit.set];
    std::uint32_t first = 0;
    for (const auto* members : {&set.set_p, &set.set_q}) {
      if (members->empty()) continue;
      Half half{limit.set, first, {}, std::numeric_limits<std::uint32_t>::max(), {}};
      for (std::size_t m = 0; m < members->size(); ++m) {
        half.certified.push_back(limit.guaranteed[first] != 0
                                     ? std::numeric_limits<std::uint32_t>::max()
                                     : limit.certified[first]);
        half.least = std::min(half.least, half.certified.back());
        ++first;
      }
      if (half.least == std::numeric_limits<std::uint32_t>::max()) continue;
      half.seen = {limit.set, 0, half.least};
      halves_.push_back(std::move(half));
    }
  }
}

void PartnerWatch::update(const engine::World& world) noexcept {
  for (Half& half : halves_) {
    const engine::PartnerCount count = world.largest_partners(half.set);
    update(half, half.first == 0 ? count.of_p : count.of_q, world);
  }
}

void PartnerWatch::update(Half& half, std::uint32_t largest, const engine::World& world) noexcept {
  if (largest <= half.least) {
    const PartnersSeen now{half.set, largest, half.least};
    if (is_nearer(now, half.seen)) half.seen = now;
    return;
  }
  for (std::uint32_t m = 0; m < half.certified.size(); ++m) {
    if (half.certified[m] == std::numeric_limits<std::uint32_t>::max()) continue;
    const PartnersSeen now{half.set, world.partners_of(half.set, half.first + m),
                           half.certified[m]};
    if (is_nearer(now, half.seen)) half.seen = now;
  }
  passed_ = passed_ || half.seen.is_passed();
}

void PartnerWatch::take_over(const PartnerWatch& before) noexcept {
  for (Half& half : halves_) {
    for (const Half& other : before.halves_) {
      if (other.set != half.set || other.first != half.first) continue;
      // the mass that touched most may have been certified for more than the least
      const PartnersSeen so_far{half.set, other.seen.largest,
                                std::max(half.least, other.seen.certified)};
      if (is_nearer(so_far, half.seen)) half.seen = so_far;
    }
  }
}

std::optional<PartnersSeen> PartnerWatch::nearest() const noexcept {
  std::optional<PartnersSeen> nearest;
  for (const Half& half : halves_) {
    if (!nearest || is_nearer(half.seen, *nearest)) nearest = half.seen;
  }
  return nearest;
}

std::string crowding_text(const scene::Scene& scene, const PartnersSeen& seen) {
  const scene::Called liaison =
      scene::call_liaison(scene, plan::LiaisonId{plan::LiaisonKind::kSet, seen.set});
  return "a mass of " + liaison.name + " (" + scene::place_text(liaison.place) + ") touches " +
         config::count_text(seen.largest, "other") + " at once, certified up to " +
         std::to_string(seen.certified) + ": at " +
         std::to_string(std::lround(scene.step_rate_hz)) +
         " Hz the scene may be unstable from here on; take a higher rate_hz or a softer liaison";
}

}  // namespace cordis::sim
