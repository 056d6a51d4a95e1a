// device_node/hand_work.h -- the work of a hand that is carried.
#pragma once

#include <cstddef>
#include <utility>

#include "device_node/axis.h"

namespace cordis::device {

/// Sums f dx of all axes, with the mean of the forces before and after a way: exact for a hand that
/// is a spring.
class HandWork {
 public:
  /// @param where_m         where the hand is now, or would be if its travel had no end
  /// @param force_before_n  of the hand where it was
  /// @param force_n         where it is
  void carry(const AxisValues& where_m, const AxisValues& force_before_n,
             const AxisValues& force_n) noexcept {
    for (std::size_t a = 0; a < where_m.size(); ++a) {
      const double before_m = std::exchange(where_m_[a], where_m[a]);
      if (is_carried_) work_j_ += 0.5 * (force_before_n[a] + force_n[a]) * (where_m[a] - before_m);
    }
    is_carried_ = true;
  }

  double work_j() const noexcept { return work_j_; }

 private:
  AxisValues where_m_{};
  bool is_carried_ = false;  // it is anywhere yet
  double work_j_ = 0.0;
};

}  // namespace cordis::device
