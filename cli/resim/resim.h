// cli/resim/resim.h -- computes the session of a take again and compares.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/resim/frame_check.h"
#include "idl/inputs.h"

namespace cordis::cli {

struct ResimOptions {
  std::string take;
  std::string scene_file;          ///< another model; empty: that of the take
  std::string integrator;          ///< likewise
  std::vector<std::string> words;  ///< parameters, NAME.PARAMETER=VALUE
  double tolerance_m = 1e-6;       ///< where hashes of another version are not comparable
  bool keeps_computed = false;     ///< for a take that is renewed
};

/// What became of it.
struct ResimResult {
  bool has_begun = false;  ///< the inputs reach back to the first step: without it there is `loss`
                           ///< alone
  FrameCheck::By by = FrameCheck::By::kHash;
  FrameFindings findings;
  std::vector<FrameCheck::Computed> computed;
  std::string scene;       ///< name of the last one
  std::size_t scenes = 0;  ///< as `export` counts: the first one, each load and each reset
  msg::InputClock clock = msg::PACE_REALTIME;
  std::string engine_version;  ///< engine that wrote the take
  std::uint32_t hash_version = 0;
  std::string integrator;     ///< integrator of the take
  std::uint64_t steps = 0;    ///< steps of the last scene
  std::uint64_t samples = 0;  ///< samples from devices
  std::uint64_t commands = 0;
  std::uint64_t state_hash = 0;   ///< after the last step
  double played_s = 0.0;          ///< simulated, of all scenes
  double took_s = 0.0;            ///< wall time of the steps
  std::uint64_t other_lives = 0;  ///< lives of sim_node in the take that are left out
  std::uint64_t left_out = 0;     ///< frames of them
  std::string loss;               ///< what the take lacks; empty: nothing
  std::string failure;            ///< the scene diverged; empty: it did not

  bool compares_models() const noexcept { return by == FrameCheck::By::kTime; }
  /// True when every frame of the take was compared, and is equal.
  bool is_equal() const noexcept;
};

/// @throws mcap::FileError, config::ConfigError or std::invalid_argument with what is wrong
ResimResult resimulate(const ResimOptions& options);

/// For a person; several lines, each with its end.
std::string text_of(const ResimResult& result, const ResimOptions& options);

}  // namespace cordis::cli
