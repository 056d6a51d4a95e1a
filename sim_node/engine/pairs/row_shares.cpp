// sim_node/engine/pairs/row_shares.cpp
#include "sim_node/engine/pairs/row_shares.h"

#include <algorithm>

#include "node/assert.h"

namespace cordis::engine {
namespace {

constexpr std::size_t kRowsOfBlock = 1024;
constexpr std::size_t kMinRoom = 1024;
/// What a row takes beside its neighbours, in times of one neighbour.
constexpr std::size_t kRowWork = 8;

}  // namespace

RowShares::Share::Share(std::size_t room_for_earlier) : block(kMaxRow, kRowsOfBlock) {
  earlier.reserve(room_for_earlier);
}

RowShares::RowShares(std::size_t member_count, std::size_t unit)
    : member_count_(member_count), unit_(unit) {}

void RowShares::make_room(std::size_t team_size) {
  const std::size_t room = std::max(kMinRoom, member_count_ / 4);
  shares_.reserve(team_size);
  while (shares_.size() < team_size) shares_.emplace_back(room);
  for (Share& share : shares_) {
    if (share.earlier_wanted <= share.earlier.capacity()) continue;
    share.earlier.reserve(std::min(member_count_, 2 * share.earlier_wanted));
    forget();
  }
}

bool RowShares::lacks_room(std::size_t team_size) const noexcept {
  return team_size > shares_.size() ||
         std::any_of(shares_.begin(), shares_.end(), [](const Share& share) {
           return share.earlier_wanted > share.earlier.capacity();
         });
}

bool RowShares::divide(const NeighbourRows& rows, std::size_t list_number,
                       ThreadTeam& team) noexcept {
  const std::size_t team_size = team.member_count();
  CORDIS_ASSERT(team_size <= shares_.size() && rows.last == member_count_);
  if (team_size == team_size_ && list_number == list_number_) return is_fit_;
  const auto divide_once = [&] {
    choose_members(rows, team_size);
    team.run([&](std::size_t member) noexcept { find_earlier(rows, shares_[member]); });
  };
  if (team_size != team_size_) {  // what the pairs of two shares take is not known yet
    for (Share& share : shares_) share.earlier_work = 0;
    divide_once();
  }
  divide_once();
  team_size_ = team_size;
  list_number_ = list_number;
  is_fit_ =
      std::all_of(shares_.begin(), shares_.begin() + static_cast<std::ptrdiff_t>(team_size),
                  [](const Share& share) {
                    return share.earlier_wanted <= share.earlier.capacity() && !share.has_long_rows;
                  });
  return is_fit_;
}

/// Gives all shares the same work, with the pairs of two shares as in the last division.
void RowShares::choose_members(const NeighbourRows& rows, std::size_t team_size) noexcept {
  const auto work_before = [&](std::size_t row) {
    return rows.start[row] - rows.start[0] + kRowWork * row;
  };
  std::size_t whole = work_before(member_count_);
  for (std::size_t j = 0; j < team_size; ++j) whole += shares_[j].earlier_work;
  std::size_t first = 0;
  std::size_t earlier = 0;  // work of the shares so far
  for (std::size_t j = 0; j < team_size; ++j) {
    earlier += shares_[j].earlier_work;
    const std::size_t all = (j + 1) * whole / team_size;
    const std::size_t own = all > earlier ? all - earlier : 0;
    std::size_t low = first / unit_;
    std::size_t high = (member_count_ + unit_ - 1) / unit_;
    while (low < high) {
      const std::size_t middle = low + (high - low) / 2;
      const bool is_before = work_before(std::min(member_count_, middle * unit_)) < own;
      (is_before ? low : high) = is_before ? middle + 1 : middle;
    }
    shares_[j].first = first;
    first = j + 1 == team_size ? member_count_ : std::min(member_count_, low * unit_);
    shares_[j].last = first;
  }
}

void RowShares::find_earlier(const NeighbourRows& rows, Share& share) const noexcept {
  share.earlier.clear();
  share.earlier_wanted = 0;
  share.earlier_work = 0;
  share.has_long_rows = false;
  const auto first = static_cast<std::uint32_t>(4 * share.first);
  const auto last = static_cast<std::uint32_t>(4 * share.last);
  for (std::size_t a = share.first; a < share.last; ++a)
    share.has_long_rows = share.has_long_rows || rows.start[a + 1] - rows.start[a] > kMaxRow;
  if (share.first == share.last) return;
  for (std::size_t a = 0; a < share.first; ++a) {
    const std::uint32_t* const begin = rows.neighbour + (rows.start[a] - rows.origin);
    const std::uint32_t* const end = rows.neighbour + (rows.start[a + 1] - rows.origin);
    if (begin == end || *(end - 1) < first || *begin >= last) continue;
    const std::uint32_t* const own = std::lower_bound(begin, end, first);
    const auto count = static_cast<std::size_t>(std::lower_bound(own, end, last) - own);
    if (count == 0) continue;
    ++share.earlier_wanted;
    share.earlier_work += count + kRowWork;
    if (share.earlier.size() == share.earlier.capacity()) continue;
    share.earlier.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(count),
                             static_cast<std::size_t>(own - rows.neighbour)});
  }
}

}  // namespace cordis::engine
