#include "sim_node/plan/reduction/light_mats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "node/config/count_text.h"
#include "sim_node/plan/reduction/held.h"
#include "sim_node/plan/reduction/take_out.h"

namespace cordis::plan {
namespace {

using engine::Vec3;

constexpr double kRounding = 1e-9;

/// A linear link, or what stands in the place of several in a row.
struct Branch {
  std::uint32_t mat_a = 0;
  std::uint32_t mat_b = 0;
  double stiffness = 0.0;
  double viscosity = 0.0;
  double rest_length = 0.0;
  bool is_maxwell = false;  // its spring and its damper are in series
  bool is_row = false;
  bool is_gone = false;
  double error = 0.0;  // of what was taken out of it

  bool is_spring() const noexcept { return !is_maxwell && stiffness > 0.0; }
  bool is_damper() const noexcept { return !is_maxwell && stiffness == 0.0 && viscosity > 0.0; }
};

double in_series(double a, double b) {
  return a * b / (a + b);
}

/// Whether the viscosity of both is in the same proportion to the stiffness.
bool are_alike(const Branch& a, const Branch& b) {
  const double left = a.viscosity * b.stiffness;
  const double right = b.viscosity * a.stiffness;
  return std::abs(left - right) <= kRounding * std::max(left, right);
}

/// What two branches in a row are as one; nothing when no link of the engine is that.
std::optional<Branch> row_of(const Branch& first, const Branch& second) {
  Branch row = first;
  row.mat_b = second.mat_b;
  row.rest_length = first.rest_length + second.rest_length;
  row.error = first.error + second.error;
  row.is_row = true;
  if (first.is_spring() && second.is_spring() && are_alike(first, second)) {
    const double share = second.stiffness / (first.stiffness + second.stiffness);
    row.stiffness = first.stiffness * share;
    row.viscosity = first.viscosity * share;
    return row;
  }
  if (first.is_damper() && second.is_damper()) {
    row.viscosity = in_series(first.viscosity, second.viscosity);
    return row;
  }
  // What is left is a chain of springs and dampers in any order: 1/K and 1/Z add up.
  const auto is_chain = [](const Branch& branch) {
    return branch.is_maxwell || branch.is_damper() ||
           (branch.is_spring() && branch.viscosity == 0.0);
  };
  if (!is_chain(first) || !is_chain(second)) return std::nullopt;
  const auto sum = [](double a, double b) {
    if (a == 0.0 || b == 0.0) return std::max(a, b);
    return in_series(a, b);
  };
  row.stiffness = sum(first.stiffness, second.stiffness);
  row.viscosity = sum(first.viscosity, second.viscosity);
  row.rest_length = 0.0;
  row.is_maxwell = true;
  return row;
}

class LightMatsReduction {
 public:
  LightMatsReduction(const Lightness& lightness, scene::Scene& scene)
      : lightness_(lightness),
        scene_(scene),
        network_(scene.network),
        held_(held_in(scene)),
        at_(network_.mats.size()),
        gone_(network_.mats.size()) {
    for (const engine::Link& link : network_.links) {
      const auto index = static_cast<std::uint32_t>(branches_.size());
      branches_.push_back(
          {link.mat_a, link.mat_b, link.stiffness, link.viscosity, link.rest_length});
      for (const std::uint32_t mat : {link.mat_a, link.mat_b}) {
        if (!held_.mats[mat]) at_[mat].push_back(index);
      }
    }
    for (const std::uint32_t strut : scene.struts) branches_[strut].is_row = true;
  }

  LightMats run() {
    std::vector<std::uint32_t> with_mass;
    for (std::uint32_t mat = 0; mat < gone_.size(); ++mat) {
      if (network_.mats[mat].kind != engine::MatKind::kMass) continue;
      if (network_.mats[mat].mass > 0.0) {
        with_mass.push_back(mat);
      } else if (const std::string reason = take_out_massless(mat); !reason.empty()) {
        result_.left.emplace(mat, reason);
      }
    }
    if (lightness_.band > 0.0) {
      for (const std::uint32_t mat : with_mass) take_out_with_mass(mat);
    }
    if (result_.count() > 0) write_back();
    return std::move(result_);
  }

 private:
  using Row = std::array<Branch, 2>;

  /// The two branches at a MAT, turned so that they lead from one end over the MAT to the other.
  /// @return empty, or why there is no such row
  std::string find_row(std::uint32_t mat, Row& row) const {
    if (held_.mats[mat]) return "a port, a signal, a set or a link with states asks for it";
    if (at_[mat].size() != 2)
      return "it has " + config::count_text(at_[mat].size(), "link") + " instead of 2";
    if (network_.medium_viscosity > 0.0) return "the medium acts on it";
    row = {branches_[at_[mat][0]], branches_[at_[mat][1]]};
    if (row[0].mat_b != mat) turn(row[0]);
    if (row[1].mat_a != mat) turn(row[1]);
    if (row[0].mat_a == row[1].mat_b) return "both its links lead to the same MAT";
    return {};
  }

  void turn(Branch& branch) const {
    std::swap(branch.mat_a, branch.mat_b);
    if (network_.dimension == 1) branch.rest_length = -branch.rest_length;
  }

  double distance(std::uint32_t a, std::uint32_t b) const {
    const Vec3 along = network_.mats[b].position - network_.mats[a].position;
    return network_.dimension == 1 ? along.x() : along.norm();
  }
  double elongation(const Branch& branch) const {
    return distance(branch.mat_a, branch.mat_b) - branch.rest_length;
  }
  double rounding_of(const Branch& branch) const {
    return kRounding *
           (std::abs(distance(branch.mat_a, branch.mat_b)) + std::abs(branch.rest_length));
  }

  /// @return empty, or why it stays
  std::string take_out_massless(std::uint32_t mat) {
    Row ends;
    if (std::string reason = find_row(mat, ends); !reason.empty()) return reason;
    const std::optional<Branch> row = row_of(ends[0], ends[1]);
    if (!row) return "its two links are not alike, and are no spring and damper";
    if (!wanted(*row)) return "`reduce` does not ask for it";
    if (row->is_maxwell && !begins_at_rest(ends)) {
      return "the spring beside it is drawn or pushed at the start";
    }
    if (network_.dimension > 1 && row->is_spring() && elongation(*row) < -rounding_of(*row)) {
      return "its springs are pushed at the start, and it would give way sideways";
    }
    ++(row->is_maxwell ? result_.maxwell : result_.massless);
    replace(mat, *row);
    return {};
  }

  bool wanted(const Branch& row) const {
    return row.is_maxwell ? scene_.reduce.massless : scene_.reduce.series;
  }

  bool begins_at_rest(const Row& ends) const {
    return std::all_of(ends.begin(), ends.end(), [this](const Branch& branch) {
      return !branch.is_spring() || std::abs(elongation(branch)) <= rounding_of(branch);
    });
  }

  void take_out_with_mass(std::uint32_t mat) {
    Row ends;
    if (!scene_.reduce.massless || !find_row(mat, ends).empty()) return;
    std::optional<Branch> row = row_of(ends[0], ends[1]);
    if (!row || !is_calm(mat, ends)) return;
    const double mass = network_.mats[mat].mass;
    const double share = share_of_second(*row, ends);
    const double stiffness = row->is_maxwell ? row->stiffness : stiffness_at(ends, *row);
    if (stiffness <= 0.0) return;
    const double square = lightness_.band * lightness_.band * mass / stiffness;
    row->error += row->is_maxwell ? 2.0 * square : square;
    if (row->error > lightness_.largest) return;
    add_mass(ends[0].mat_a, (1.0 - share) * mass);
    add_mass(ends[1].mat_b, share * mass);
    result_.budget = std::max(result_.budget, row->error);
    ++result_.light;
    replace(mat, *row);
  }

  /// The part of its mass that the second neighbour takes.
  static double share_of_second(const Branch& row, const Row& ends) {
    if (!row.is_maxwell) return ends[1].stiffness / (ends[0].stiffness + ends[1].stiffness);
    return ends[1].is_spring() ? 1.0 : 0.0;
  }

  /// Of the MAT in the direction in which it is softest.
  double stiffness_at(const Row& ends, const Branch& row) const {
    const double along = ends[0].stiffness + ends[1].stiffness;
    if (network_.dimension == 1) return along;
    const double first = distance(ends[0].mat_a, ends[0].mat_b);
    const double second = distance(ends[1].mat_a, ends[1].mat_b);
    const double bend = first + second - distance(row.mat_a, row.mat_b);
    if (first == 0.0 || second == 0.0 || bend > kRounding * (first + second)) return 0.0;
    return std::min(along, row.stiffness * elongation(row) * (1.0 / first + 1.0 / second));
  }

  /// Whether it begins where its links hold it, and moves with them.
  bool is_calm(std::uint32_t mat, const Row& ends) const {
    const std::array<const engine::Mat*, 2> outer{&network_.mats[ends[0].mat_a],
                                                  &network_.mats[ends[1].mat_b]};
    const Vec3& velocity = network_.mats[mat].velocity;
    if (ends[0].is_spring() && ends[1].is_spring()) {
      const double stiffness = ends[0].stiffness + ends[1].stiffness;
      const double pull =
          ends[0].stiffness * elongation(ends[0]) - ends[1].stiffness * elongation(ends[1]);
      const double share = ends[1].stiffness / stiffness;
      const Vec3 shared = (1.0 - share) * outer[0]->velocity + share * outer[1]->velocity;
      return std::abs(pull) <= stiffness * (rounding_of(ends[0]) + rounding_of(ends[1])) &&
             (velocity - shared).norm() <= kRounding * (velocity.norm() + shared.norm());
    }
    if (network_.dimension > 1 || ends[0].is_maxwell || ends[1].is_maxwell) return false;
    const bool second = ends[1].is_spring();
    return begins_at_rest(ends) && ends[0].is_spring() != second &&
           velocity == outer[second ? 1 : 0]->velocity;
  }

  void add_mass(std::uint32_t mat, double mass) {
    engine::Mat& to = network_.mats[mat];
    if (to.kind == engine::MatKind::kMass) to.mass += mass;
  }

  void replace(std::uint32_t mat, const Branch& row) {
    const std::uint32_t stays = std::min(at_[mat][0], at_[mat][1]);
    const std::uint32_t goes = std::max(at_[mat][0], at_[mat][1]);
    gone_[mat] = true;
    branches_[stays] = row;
    branches_[goes].is_gone = true;
    for (const std::uint32_t end : {row.mat_a, row.mat_b}) {
      for (std::uint32_t& branch : at_[end]) {
        if (branch == goes) branch = stays;
      }
    }
  }

  void write_back() {
    std::vector<bool> links(branches_.size());
    std::vector<std::uint32_t> maxwells;
    scene_.struts.clear();
    for (std::uint32_t l = 0; l < branches_.size(); ++l) {
      const Branch& branch = branches_[l];
      links[l] = branch.is_gone || branch.is_maxwell;
      if (branch.is_maxwell && !branch.is_gone) maxwells.push_back(l);
      if (links[l]) continue;
      engine::Link& link = network_.links[l];
      link.mat_a = branch.mat_a;
      link.mat_b = branch.mat_b;
      link.stiffness = branch.stiffness;
      link.viscosity = branch.viscosity;
      link.rest_length = branch.rest_length;
      if (!branch.is_row || !branch.is_spring() || network_.dimension == 1) continue;
      scene_.struts.push_back(l);
      if (elongation(branch) <= rounding_of(branch)) ++result_.struts;
    }
    for (const std::uint32_t l : maxwells) add_maxwell(l);
    take_out(gone_, links, scene_);
  }

  /// Named after the link that stood there first.
  void add_maxwell(std::uint32_t link) {
    const Branch& branch = branches_[link];
    const auto group = std::find_if(
        scene_.link_groups.begin(), scene_.link_groups.end(), [link](const auto& candidate) {
          return candidate.kind == scene::LinkKind::kLinear && link >= candidate.first &&
                 link - candidate.first < candidate.count;
        });
    scene::LinkGroup made;
    made.kind = scene::LinkKind::kMaxwell;
    made.first = static_cast<std::uint32_t>(network_.maxwell_links.size());
    made.count = 1;
    if (group != scene_.link_groups.end()) {
      made.name = group->name + ".maxwell";
      made.place = group->place;
    }
    scene_.link_groups.push_back(std::move(made));
    network_.maxwell_links.push_back(
        {branch.mat_a, branch.mat_b, branch.stiffness, branch.viscosity});
  }

  const Lightness& lightness_;
  scene::Scene& scene_;
  engine::NetworkDescription& network_;
  Held held_;
  std::vector<Branch> branches_;
  std::vector<std::vector<std::uint32_t>> at_;  // branches, of MATs that are not held
  std::vector<bool> gone_;
  LightMats result_;
};

}  // namespace

LightMats take_out_light_mats(const Lightness& lightness, scene::Scene& scene) {
  return LightMatsReduction(lightness, scene).run();
}

}  // namespace cordis::plan
