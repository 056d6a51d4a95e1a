// node/machine/deadline_record.cpp
#include "node/machine/deadline_record.h"

namespace cordis::machine {

std::int64_t DeadlineRecord::record(std::int64_t late_nsec, std::int64_t period_nsec) noexcept {
  std::int64_t passed = -1;
  do {
    lateness_.record(late_nsec);
    if (late_nsec > kLateNsec) ++late_;
    if (late_nsec >= period_nsec) ++lost_;
    late_nsec -= period_nsec;
    ++passed;
  } while (late_nsec >= 0);
  return passed;
}

}  // namespace cordis::machine
