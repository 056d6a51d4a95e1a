// sim_node/engine/links/spring_damper.cpp
#include "sim_node/engine/links/spring_damper.h"

#include <algorithm>
#include <utility>

#include "node/assert.h"
#include "sim_node/engine/links/elongation_increment.h"

namespace cordis::engine {
namespace {

using Kind = SpringDamperArray::Kind;

bool is_of(Kind kind, const NetworkDescription& description, const Link& link) {
  return (description.dimension > 1 && link.isotropic) == (kind == Kind::kVectorSpring);
}

std::size_t axes_of(Kind kind, const NetworkDescription& description) {
  return kind == Kind::kVectorSpring ? static_cast<std::size_t>(description.dimension) : 1;
}

/// Links by groups of the blocks, within one in the order of order_in_runs().
struct GroupedLinks {
  std::vector<Link> links;
  std::vector<std::size_t> first;  // of each group; and one more, which ends the last
};

GroupedLinks links_of(Kind kind, const NetworkDescription& description, bool with_runs,
                      const MatBlocks& blocks) {
  std::vector<Link> links;
  const auto add = [&](const Link& link) {
    if (is_of(kind, description, link)) links.insert(links.end(), axes_of(kind, description), link);
  };
  if (with_runs) {
    for (const std::uint32_t link : order_in_runs(description.links).links)
      add(ascending(description.links[link], description.dimension));
  } else {
    for (const Link& link : description.links) add(link);
  }
  std::vector<std::size_t> group;
  group.reserve(links.size());
  for (const Link& link : links) group.push_back(blocks.group_of(link.mat_a, link.mat_b));
  GroupedOrder order = by_group(group, blocks.group_count());
  std::vector<Link> sorted;
  sorted.reserve(links.size());
  for (const std::uint32_t link : order.links) sorted.push_back(links[link]);
  return {std::move(sorted), std::move(order.first)};
}

}  // namespace

SpringDamperArray::SpringDamperArray(const NetworkDescription& description, Kind kind,
                                     const MatLayout& layout, const MatBlocks& blocks)
    : layout_(layout),
      link_groups_(blocks),
      dimension_(description.dimension),
      is_1d_(description.dimension == 1 || kind == Kind::kVectorSpring),
      freezes_(description.freeze_tolerance > 0.0),
      active_(0, kLinkBatch) {
  const bool with_runs = layout.is_by_axis() && kind == Kind::kAlong;
  const GroupedLinks grouped = links_of(kind, description, with_runs, blocks);
  arrange(grouped.links, grouped.first, with_runs, axes_of(kind, description), description.step);
}

/// @param links  by groups  @param first  where the links of each group begin, and where the last end
/// @param axes  so many rows in turn are of one link
void SpringDamperArray::arrange(const std::vector<Link>& links,
                                const std::vector<std::size_t>& first, bool with_runs,
                                std::size_t axes, double step) {
  LinkArrangement rows;
  rows.link_of_row.reserve(padded(links.size(), kLinkBatch));
  const MatBlocks& blocks = link_groups_.blocks();
  for (std::size_t group = 0; group < blocks.group_count(); ++group) {
    groups_.push_back({rows.link_of_row.size(), rows.runs.size()});
    const bool may_overhang =
        group == blocks.group_of_others();  // behind the last MAT there is room
    const std::size_t last_mat = blocks.mats_of_group(group).last + (may_overhang ? kLinkBatch : 0);
    arrange_links(std::span(links).subspan(first[group], first[group + 1] - first[group]),
                  static_cast<std::uint32_t>(first[group]), with_runs, last_mat, rows);
  }
  const std::size_t row_count = rows.link_of_row.size();
  groups_.push_back({row_count, rows.runs.size()});

  for (auto* columns : {&column_a_, &column_b_}) columns->assign(row_count, 0U);
  for (auto* values : {&stiffness_, &viscosity_over_dt_, &rest_length_, &viscous_factor_}) {
    values->assign(row_count, 0.0);
  }
  if (!is_1d_) elastic_factor_.assign(row_count, 0.0);
  std::size_t group = 0;
  for (std::size_t row = 0; row < row_count; ++row) {
    while (groups_[group + 1].first_row <= row) ++group;
    const std::uint32_t link = rows.link_of_row[row];
    if (link == LinkArrangement::kEmpty) {
      pad_row(row, blocks.mats_of_group(group));
    } else {
      fill_row(row, links[link], static_cast<std::uint32_t>(link % axes), step);
    }
  }
  active_ = ActiveLinks(row_count, kLinkBatch);
  if (!layout_.is_by_axis()) return;
  find_equal_parameters(rows);
  runs_ = std::move(rows.runs);
  used_rows_ = std::move(rows.used_rows);
}

void SpringDamperArray::fill_row(std::size_t row, const Link& link, std::uint32_t axis,
                                 double step) noexcept {
  column_a_[row] = static_cast<std::uint32_t>(layout_.offset(link.mat_a, axis));
  column_b_[row] = static_cast<std::uint32_t>(layout_.offset(link.mat_b, axis));
  stiffness_[row] = link.stiffness;
  viscosity_over_dt_[row] = link.viscosity / step;
  rest_length_[row] = link.rest_length;
  viscous_ = viscous_ || link.viscosity > 0.0;
}

/// A row of padding joins a MAT to itself without stiffness or viscosity: its force is 0.
void SpringDamperArray::pad_row(std::size_t row, const MatBlocks::Mats& mats) noexcept {
  column_a_[row] = column_b_[row] = static_cast<std::uint32_t>(
      layout_.offset(mats.first + mat_of_padding(row, mats.last - mats.first)));
}

void SpringDamperArray::find_equal_parameters(const LinkArrangement& arrangement) {
  for (const LinkRun& run : arrangement.runs) {
    equal_.push_back(kNoneEqual);
    if (run.is_gathered) continue;
    bool are_equal = true;
    const std::size_t first = run.first_row;  // never empty
    for (std::size_t row = first; row < first + run.row_count; ++row) {
      if (arrangement.link_of_row[row] == LinkArrangement::kEmpty) continue;
      are_equal = are_equal && stiffness_[row] == stiffness_[first] &&
                  viscosity_over_dt_[row] == viscosity_over_dt_[first] &&
                  rest_length_[row] == rest_length_[first];
    }
    if (!are_equal) continue;
    equal_.back() = equal_parameters_.size();
    for (const auto* values : {&stiffness_, &viscosity_over_dt_, &rest_length_}) {
      equal_parameters_.insert(equal_parameters_.end(), kLinkBatch, (*values)[first]);
    }
  }
}

LinkRows SpringDamperArray::rows(const ActiveLinks::Run& run) noexcept {
  const std::size_t first = run.first;
  return {run.count,
          column_a_.data() + first,
          column_b_.data() + first,
          stiffness_.data() + first,
          viscosity_over_dt_.data() + first,
          rest_length_.data() + first,
          viscous_factor_.data() + first,
          is_1d_ ? nullptr : elastic_factor_.data() + first};
}

RunRows SpringDamperArray::rows(std::size_t run) noexcept {
  const std::size_t first = runs_[run].first_row;
  RunRows rows;
  rows.count = runs_[run].row_count;
  rows.first_a = runs_[run].first_a;
  rows.first_b = runs_[run].first_b;
  rows.used_rows = used_rows_.data() + first / kLinkBatch;
  rows.viscous_factor = viscous_factor_.data() + first;
  rows.elastic_factor = is_1d_ ? nullptr : elastic_factor_.data() + first;
  if (equal_[run] == kNoneEqual) {
    rows.stiffness = stiffness_.data() + first;
    rows.viscosity_over_dt = viscosity_over_dt_.data() + first;
    rows.rest_length = rest_length_.data() + first;
    rows.parameter_step = kLinkBatch;
  } else {
    rows.stiffness = equal_parameters_.data() + equal_[run];
    rows.viscosity_over_dt = rows.stiffness + kLinkBatch;
    rows.rest_length = rows.viscosity_over_dt + kLinkBatch;
  }
  return rows;
}

StepEnergy SpringDamperArray::add(AddLinkForces add_link_forces, const ForceColumns& columns,
                                  ThreadTeam& team) noexcept {
  if (column_a_.empty()) return {};
  CORDIS_ASSERT(!layout_.is_by_axis());
  if (!link_groups_.are_one() && !freezes_) {
    const auto add_group = [&](std::size_t group, LinkWork& work) noexcept {
      const std::size_t first = groups_[group].first_row;
      const ActiveLinks::Run run{first, groups_[group + 1].first_row - first};
      if (run.count > 0) add_link_forces(rows(run), columns, work);
    };
    return half_of(link_groups_.add(team, add_group));
  }
  LinkWork work;
  for (const ActiveLinks::Run& run : active_.runs()) add_link_forces(rows(run), columns, work);
  return half_of(work);
}

StepEnergy SpringDamperArray::add_by_axis(AddLinkForces gathered, const RunLoops& loops,
                                          const ForceColumns& rows_of_mats,
                                          ThreadTeam& team) noexcept {
  if (column_a_.empty()) return {};
  const AddRunForces chained = viscous_ ? loops.chained_spring_dampers : loops.chained_springs;
  const AddRunForces along = viscous_ ? loops.spring_dampers : loops.springs;

  const auto add_group = [&](std::size_t group, LinkWork& work) noexcept {
    for (std::size_t i = groups_[group].first_run; i < groups_[group + 1].first_run; ++i) {
      const LinkRun& run = runs_[i];
      if (run.is_gathered) {
        gathered(rows(ActiveLinks::Run{run.first_row, run.row_count}), rows_of_mats, work);
      } else {
        (run.first_b == run.first_a + 1 ? chained : along)(rows(i), rows_of_mats, work);
      }
    }
  };
  return half_of(link_groups_.add(team, add_group));
}

StepEnergy SpringDamperArray::add_forces(const StepKernel& kernel, const ForceColumns& columns,
                                         ThreadTeam& team) noexcept {
  const AddLinkForces forces_1d = viscous_ ? kernel.spring_dampers_1d : kernel.springs_1d;
  if (layout_.is_by_axis()) {
    const AddLinkForces gathered_nd =
        viscous_ ? kernel.gathered_spring_dampers_by_axis : kernel.gathered_springs_by_axis;
    return add_by_axis(is_1d_ ? forces_1d : gathered_nd, kernel.runs[dimension_ - 1], columns,
                       team);
  }
  const AddLinkForces forces_nd = viscous_ ? kernel.spring_dampers_3d : kernel.springs_3d;
  return add(is_1d_ ? forces_1d : forces_nd, columns, team);
}

StepEnergy SpringDamperArray::add_forces_at_full_step(const StepKernel& kernel,
                                                      const ForceColumns& columns,
                                                      ThreadTeam& team) noexcept {
  const AddLinkForces forces_1d = viscous_ ? kernel.moment_spring_dampers_1d : kernel.springs_1d;
  StepEnergy halves;
  if (layout_.is_by_axis()) {
    const AddLinkForces gathered_nd = viscous_ ? kernel.moment_gathered_spring_dampers_by_axis
                                               : kernel.moment_gathered_springs_by_axis;
    halves = add_by_axis(is_1d_ ? forces_1d : gathered_nd, kernel.moment_runs[dimension_ - 1],
                         columns, team);
  } else {
    const AddLinkForces forces_nd =
        viscous_ ? kernel.moment_spring_dampers_3d : kernel.moment_springs_3d;
    halves = add(is_1d_ ? forces_1d : forces_nd, columns, team);
  }
  return {0.0, 2.0 * halves.dissipated, 0.0, 0.0};
}

void SpringDamperArray::mark_neighbours(const WakePropagation& pass,
                                        MatRoles& roles) const noexcept {
  for (std::size_t l = 0; l < column_a_.size(); ++l) {
    roles.join(column_a_[l] / 4, column_b_[l] / 4, pass);
  }
}

void SpringDamperArray::choose_active(MatRoles& roles) noexcept {
  active_.choose(column_a_.data(), column_b_.data(), roles);
}

StepEnergy SpringDamperArray::work_since_last_call(const MatArray& mats) const noexcept {
  StepEnergy work;
  if (is_1d_ && !viscous_) return work;
  for (std::size_t l = 0; l < column_a_.size(); ++l) {
    const double elongation_increment =
        half_elongation_increment(mats, column_a_[l], column_b_[l], is_1d_);
    work.dissipated += viscous_factor_[l] * elongation_increment;
    if (!is_1d_) work.elastic += elastic_factor_[l] * elongation_increment;
  }
  return work;
}

double SpringDamperArray::potential_energy(const MatArray& mats) const noexcept {
  double sum = 0.0;
  for (std::size_t l = 0; l < column_a_.size(); ++l) {
    const Vec3 along = mats.position_of_forces(layout_.mat_of(column_b_[l])) -
                       mats.position_of_forces(layout_.mat_of(column_a_[l]));
    const double distance = is_1d_ ? along[layout_.axis_of(column_a_[l])] : along.norm();
    const double elongation = distance - rest_length_[l];
    sum += stiffness_[l] * elongation * elongation;
  }
  return 0.5 * sum;
}

void SpringDamperArray::start() noexcept {
  std::fill(viscous_factor_.begin(), viscous_factor_.end(), 0.0);
}

void SpringDamperArray::drop_viscosity() noexcept {
  std::fill(viscosity_over_dt_.begin(), viscosity_over_dt_.end(), 0.0);
  viscous_ = false;  // so that none of a run is read
}

void SpringDamperArray::serialize(Archive& archive) {
  archive.reals(viscous_factor_);
  archive.reals(elastic_factor_);
}

}  // namespace cordis::engine
