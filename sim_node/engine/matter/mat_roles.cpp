// sim_node/engine/matter/mat_roles.cpp
#include "sim_node/engine/matter/mat_roles.h"

namespace cordis::engine {

ActiveLinks::ActiveLinks(std::size_t count, std::size_t batch) : count_(count), batch_(batch) {
  runs_.reserve(count / batch / 2 + 1);
  choose_all();
}

void ActiveLinks::choose_all() noexcept {
  runs_.clear();
  if (count_ > 0) runs_.push_back({0, count_});
}

void ActiveLinks::choose(const std::uint32_t* column_a, const std::uint32_t* column_b,
                         MatRoles& roles) noexcept {
  runs_.clear();
  for (std::size_t first = 0; first < count_; first += batch_) {
    unsigned of_batch = 0;
    for (std::size_t l = first; l < first + batch_; ++l) {
      of_batch |= roles.roles(column_a[l] / 4);
      of_batch |= roles.roles(column_b[l] / 4);
    }
    if ((of_batch & kWholeForce) == 0) continue;
    for (std::size_t l = first; l < first + batch_; ++l) {
      roles.add(column_a[l] / 4, kSomeForce);
      roles.add(column_b[l] / 4, kSomeForce);
    }
    if (!runs_.empty() && runs_.back().first + runs_.back().count == first) {
      runs_.back().count += batch_;
    } else {
      runs_.push_back({first, batch_});
    }
  }
}

}  // namespace cordis::engine
