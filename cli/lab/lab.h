// cli/lab/lab.h -- all integrators at many rates, against the reference integrator.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cli/lab/lab_scene.h"
#include "sim_node/plan/plan.h"
#include "sim_node/plan/rate_sweep.h"
#include "sim_node/plan/reference/trial_run.h"

namespace cordis::cli {

/// What a person asked for.
struct LabOptions {
  std::string file;         ///< a scene or a launch file
  std::string folder;       ///< where the results go
  double duration_s = 0.0;  ///< 0: as long as the scene asks for, or 2 s
  int jobs = 1;
  bool quick = false;
  bool again = false;  ///< forget what is there of an earlier lab
};

struct LabRun {
  plan::TrialResult result;
  bool on_front = false;  ///< none is cheaper in time and no less exact
  bool certain = true;    ///< plan::uncertainty_of() has nothing against its rate
};

struct LabReport {
  LabScene lab;
  std::map<std::string, plan::Stability> stability;  ///< by integrator
  plan::Reference reference;
  std::vector<LabRun> runs;  ///< by integrator, then by rate
  bool counts_instructions = false;
  int kept_runs = 0;               ///< from an earlier lab
  std::vector<std::string> notes;  ///< what was not tried, and why
};

/// Does what is not there yet in the folder, and keeps every result there at once.
/// @param progress  receives in one line what is going on
/// @throws config::ConfigError, std::runtime_error
LabReport run_lab(const LabOptions& options, const std::function<void(std::string)>& progress);

/// The cheapest run, by evaluations of forces, that keeps a tolerance as all do of its integrator
/// at higher rates, among those at `lowest_hz` or above; nullptr when there is none.
const LabRun* cheapest_within(const LabReport& report, double tolerance, double lowest_hz);

}  // namespace cordis::cli
