// sim_node/plan/reduction/take_out.cpp
#include "sim_node/plan/reduction/take_out.h"

#include <algorithm>
#include <utility>

#include "node/assert.h"

namespace cordis::plan {
namespace {

/// Numbers before and after something was taken out of a row.
class Renumbering {
 public:
  explicit Renumbering(const std::vector<bool>& gone) : gone_(gone), before_(gone.size() + 1) {
    for (std::size_t i = 0; i < gone.size(); ++i) before_[i + 1] = before_[i] + (gone[i] ? 0 : 1);
  }

  void apply(std::uint32_t& index) const {
    CORDIS_ASSERT(index < gone_.size() && !gone_[index]);
    index = before_[index];
  }
  void apply(std::vector<std::uint32_t>& indices) const {
    for (std::uint32_t& index : indices) apply(index);
  }
  /// Applies to a NamedRange or a LinkGroup.
  template <class Range>
  void apply_to_range(Range& range) const {
    const std::uint32_t end = before_[range.first + range.count];
    range.first = before_[range.first];
    range.count = end - range.first;
  }
  template <class Range>
  void apply_to_ranges(std::vector<Range>& ranges) const {
    for (Range& range : ranges) apply_to_range(range);
    std::erase_if(ranges, [](const Range& range) { return range.count == 0; });
  }
  template <class Item>
  void keep(std::vector<Item>& items) const {
    if (items.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < gone_.size(); ++i) {
      if (!gone_[i]) items[kept++] = std::move(items[i]);
    }
    items.resize(kept);
  }

 private:
  const std::vector<bool>& gone_;
  std::vector<std::uint32_t> before_;  // how many stay before this one
};

}  // namespace

void take_out(const std::vector<bool>& mats, const std::vector<bool>& links, scene::Scene& scene) {
  CORDIS_ASSERT(mats.size() == scene.network.mats.size());
  CORDIS_ASSERT(links.size() == scene.network.links.size());
  const Renumbering of_mats(mats);
  const Renumbering of_links(links);
  engine::NetworkDescription& network = scene.network;
  of_mats.keep(network.mats);
  of_mats.keep(network.radius);
  of_mats.apply(network.kept_awake);
  of_mats.keep(scene.radius_m);
  of_mats.keep(scene.layout);
  of_mats.apply_to_ranges(scene.matter);
  of_mats.apply_to_ranges(scene.colours);
  of_links.keep(network.links);
  std::vector<scene::LinkGroup> linear;
  std::vector<scene::LinkGroup> others;
  for (scene::LinkGroup& group : scene.link_groups) {
    (group.kind == scene::LinkKind::kLinear ? linear : others).push_back(std::move(group));
  }
  of_links.apply_to_ranges(linear);
  scene.link_groups = std::move(linear);
  scene.link_groups.insert(scene.link_groups.end(), others.begin(), others.end());

  const auto renumber_ends = [&of_mats](auto& list) {
    for (auto& link : list) {
      of_mats.apply(link.mat_a);
      of_mats.apply(link.mat_b);
    }
  };
  renumber_ends(network.links);
  renumber_ends(network.state_links);
  renumber_ends(network.maxwell_links);
  for (engine::Bend& bend : network.bends) {
    for (std::uint32_t* mat : {&bend.mat_a, &bend.mat_b, &bend.mat_c}) of_mats.apply(*mat);
  }
  for (engine::SetLiaison& set : network.sets) {
    of_mats.apply(set.set_p);
    of_mats.apply(set.set_q);
  }
  for (engine::Drive& drive : network.drives) of_mats.apply(drive.mat);
  for (engine::Surface& surface : network.surfaces) of_mats.apply(surface.mat);
  for (scene::Port& port : scene.ports) {
    of_mats.apply(port.mat);
    of_mats.apply(port.tool);
    for (scene::BodyMass& mass : port.body) of_mats.apply(mass.mat);
  }
  const auto renumber = [&](engine::Variable& variable) {
    if (is_of_one_mat(variable)) of_mats.apply(variable.index);
    if (is_of_one_link(variable) && variable.kind == engine::LinkKind::kLinear) {
      of_links.apply(variable.index);
    }
  };
  std::ranges::for_each(network.variables, renumber);
  for (engine::VariableGroup& group : network.groups) {
    if (!group.is_of_links) of_mats.apply(group.members);
    if (group.is_of_links && group.kind == engine::LinkKind::kLinear) of_links.apply(group.members);
  }
  std::vector<scene::Signal> signals = scene.signals.signals();
  for (scene::Signal& signal : signals) {
    of_mats.apply(signal.mats);
    renumber(signal);
  }
  scene.signals = scene::SignalReader(std::move(signals), network);
  number_links(scene);
}

}  // namespace cordis::plan
