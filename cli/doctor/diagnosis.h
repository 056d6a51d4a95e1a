// cli/doctor/diagnosis.h -- all that can be known about a machine before a force loop runs on it.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "cli/doctor/finding.h"
#include "node/machine/system_files.h"

namespace cordis::cli {

struct DiagnosisOptions {
  std::chrono::nanoseconds duration{std::chrono::seconds(3)};  ///< length of the measurement
  std::optional<int> domain{};  ///< whose ports to check; absent: that of the next session
  int page_port = 8080;
  std::string interface {};  ///< name or address; empty: none is to be checked
};

/// Measures and checks. Takes a little longer than the duration.
std::vector<Finding> diagnose(const machine::SystemFiles& files, const DiagnosisOptions& options);

}  // namespace cordis::cli
