// cli/lab/lab_store.h -- the folder of a lab: what it has found so far, so that it can go on later.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <vector>

#include "sim_node/plan/reference/trial_run.h"

namespace cordis::cli {

/// Runs and reference of one question, distinguished from others by a key; what the folder holds of another
/// question is replaced. The runs stand in runs.csv, the reference in reference.bin.
class LabStore {
 public:
  /// Makes the folder and reads what is there. @throws std::runtime_error when it cannot
  LabStore(std::filesystem::path folder, std::uint64_t key, bool again);

  const std::optional<plan::Reference>& reference() const noexcept { return reference_; }
  void keep(const plan::Reference& reference);

  const std::vector<plan::TrialResult>& runs() const noexcept { return runs_; }
  /// nullptr when it has not been tried yet.
  const plan::TrialResult* find(const std::string& integrator, double rate_hz) const noexcept;
  /// From any thread.
  void keep(const plan::TrialResult& run);

 private:
  void read_runs();
  void read_reference();

  std::filesystem::path folder_;
  std::uint64_t key_;
  std::optional<plan::Reference> reference_;
  std::vector<plan::TrialResult> runs_;
  std::mutex mutex_;
};

}  // namespace cordis::cli
