// sim_node/plan/reduction/series.cpp
#include "sim_node/plan/reduction/series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "node/assert.h"
#include "node/config/count_text.h"
#include "sim_node/plan/reduction/held.h"
#include "sim_node/plan/reduction/take_out.h"

namespace cordis::plan {
namespace {

using engine::Link;

bool is_spring(const Link& link) noexcept {
  return link.stiffness > 0.0;
}

bool is_damper(const Link& link) noexcept {
  return link.stiffness == 0.0 && link.viscosity > 0.0;
}

/// True if the viscosity of both is in the same proportion to the stiffness.
bool are_alike(const Link& a, const Link& b) noexcept {
  constexpr double kRounding = 1e-9;
  const double left = a.viscosity * b.stiffness;
  const double right = b.viscosity * a.stiffness;
  return std::abs(left - right) <= kRounding * std::max(left, right);
}

/// Two links in a row as one; nothing when no linear link is that.
/// Precondition: the first ends where the second begins.
std::optional<Link> row_of(const Link& first, const Link& second) noexcept {
  CORDIS_ASSERT(first.mat_b == second.mat_a);
  Link row = first;
  row.mat_b = second.mat_b;
  row.rest_length = first.rest_length + second.rest_length;
  if (is_spring(first) && is_spring(second) && are_alike(first, second)) {
    const double share = second.stiffness / (first.stiffness + second.stiffness);
    row.stiffness = first.stiffness * share;
    row.viscosity = first.viscosity * share;
    return row;
  }
  if (!is_damper(first) || !is_damper(second)) return std::nullopt;
  row.viscosity = first.viscosity * second.viscosity / (first.viscosity + second.viscosity);
  return row;
}

void turn(Link& link) noexcept {
  std::swap(link.mat_a, link.mat_b);
  link.rest_length = -link.rest_length;
}

class SeriesReduction {
 public:
  explicit SeriesReduction(scene::Scene& scene)
      : scene_(scene),
        network_(scene.network),
        held_(held_in(scene)),
        links_at_(network_.mats.size()),
        gone_mats_(network_.mats.size()),
        gone_links_(network_.links.size()) {
    for (std::uint32_t l = 0; l < network_.links.size(); ++l) {
      for (const std::uint32_t mat : {network_.links[l].mat_a, network_.links[l].mat_b}) {
        if (!held_.mats[mat]) links_at_[mat].push_back(l);
      }
    }
  }

  MergedSeries run() {
    for (std::uint32_t mat = 0; mat < network_.mats.size(); ++mat) {
      const engine::Mat& is = network_.mats[mat];
      if (is.kind != engine::MatKind::kMass || is.mass > 0.0) continue;
      if (std::string reason = take_out_mat(mat); !reason.empty()) {
        result_.left.emplace(mat, std::move(reason));
      }
    }
    if (result_.count > 0) take_out(gone_mats_, gone_links_, scene_);
    return std::move(result_);
  }

 private:
  /// @return empty, or why it stays
  std::string take_out_mat(std::uint32_t mat) {
    if (network_.dimension > 1) {
      return "in " + std::to_string(network_.dimension) +
             " dimensions it gives way sideways when its row is pushed";
    }
    if (held_.mats[mat]) return "a port, a signal, a set or a link with states asks for it";
    if (links_at_[mat].size() != 2) {
      return "it has " + config::count_text(links_at_[mat].size(), "link") + " instead of 2";
    }
    if (network_.medium_viscosity_on(network_.mats[mat]) > 0.0) return "the medium acts on it";
    std::array<Link, 2> ends{network_.links[links_at_[mat][0]], network_.links[links_at_[mat][1]]};
    if (ends[0].mat_b != mat) turn(ends[0]);
    if (ends[1].mat_a != mat) turn(ends[1]);
    if (ends[0].mat_a == ends[1].mat_b) return "both its links lead to the same MAT";
    const std::optional<Link> row = row_of(ends[0], ends[1]);
    if (!row) return "its two links are not of one kind";
    replace(mat, *row);
    return {};
  }

  void replace(std::uint32_t mat, const Link& row) {
    const auto [stays, goes] = std::minmax(links_at_[mat][0], links_at_[mat][1]);
    gone_mats_[mat] = true;
    gone_links_[goes] = true;
    network_.links[stays] = row;
    for (const std::uint32_t end : {row.mat_a, row.mat_b}) {
      std::replace(links_at_[end].begin(), links_at_[end].end(), goes, stays);
    }
    ++result_.count;
  }

  scene::Scene& scene_;
  engine::NetworkDescription& network_;
  Held held_;
  std::vector<std::vector<std::uint32_t>> links_at_;  // MATs that are not held
  std::vector<bool> gone_mats_;
  std::vector<bool> gone_links_;
  MergedSeries result_;
};

}  // namespace

MergedSeries merge_series(scene::Scene& scene) {
  return SeriesReduction(scene).run();
}

}  // namespace cordis::plan
