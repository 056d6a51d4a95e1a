// sim_node/plan/reference/instruction_counter.h -- how many instructions the calling thread
// executes.
#pragma once

#include <cstdint>

namespace cordis::plan {

/// Counts instructions of this thread in user space, where kernel and processor allow it.
class InstructionCounter {
 public:
  InstructionCounter() noexcept;
  ~InstructionCounter();
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;

  bool counts() const noexcept { return file_ >= 0; }
  void resume() noexcept;
  void pause() noexcept;
  std::uint64_t value() const noexcept;  ///< 0 when it does not count

 private:
  int file_;
};

}  // namespace cordis::plan
