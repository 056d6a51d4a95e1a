// sim_node/engine/links/link_groups.cpp
#include "sim_node/engine/links/link_groups.h"

#include "sim_node/engine/matter/mat_array.h"

namespace cordis::engine {

GroupedOrder by_group(const std::vector<std::size_t>& group_of_link, std::size_t group_count) {
  GroupedOrder order;
  order.first.assign(group_count + 1, 0);
  for (const std::size_t group : group_of_link) ++order.first[group + 1];
  for (std::size_t group = 1; group <= group_count; ++group)
    order.first[group] += order.first[group - 1];
  std::vector<std::size_t> place(order.first.begin(), order.first.end() - 1);
  order.links.resize(group_of_link.size());
  for (std::uint32_t link = 0; link < group_of_link.size(); ++link)
    order.links[place[group_of_link[link]]++] = link;
  return order;
}

std::vector<std::uint32_t> GroupedRows::fill(const std::vector<std::size_t>& group_of_link,
                                             const MatBlocks& blocks, std::size_t batch) {
  std::vector<std::uint32_t> padding_mats;
  const GroupedOrder order = by_group(group_of_link, blocks.group_count());
  row_of_link.resize(group_of_link.size());
  link_of_row.reserve(padded(group_of_link.size(), batch));
  for (std::size_t group = 0; group < blocks.group_count(); ++group) {
    first.push_back(link_of_row.size());
    links_before.push_back(order.first[group]);
    for (std::size_t place = order.first[group]; place < order.first[group + 1]; ++place) {
      row_of_link[order.links[place]] = static_cast<std::uint32_t>(link_of_row.size());
      link_of_row.push_back(order.links[place]);
    }
    const MatBlocks::Mats mats = blocks.mats_of_group(group);
    while (link_of_row.size() % batch != 0) {
      padding_mats.push_back(mats.first +
                             mat_of_padding(link_of_row.size(), mats.last - mats.first));
      link_of_row.push_back(kPadding);
    }
  }
  first.push_back(link_of_row.size());
  return padding_mats;
}

}  // namespace cordis::engine
