// cli/resim/frame_check.h -- holds the frames of a take against a scene that is computed again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/resim/take_reader.h"
#include "sim_node/run/frame_store.h"
#include "sim_node/run/simulation.h"

namespace cordis::cli {

/// How far the MATs of a frame are from those of the scene that is computed.
struct FrameDifference {
  std::uint64_t version = 0;  ///< version of the description
  std::uint64_t step = 0;     ///< step of the frame
  double time_s = 0.0;        ///< simulated
  double largest_m = 0.0;     ///< largest distance between the two places of a MAT
  std::string mat;            ///< which one it is
};

/// How far the force on a port in a frame is from that in the scene that is computed.
struct ForceDifference {
  std::uint64_t step = 0;  ///< step of the frame
  double time_s = 0.0;     ///< simulated
  double largest_n = 0.0;  ///< length of the difference of the two forces
  double taken_n = 0.0;    ///< length of the force in the frame
  double now_n = 0.0;      ///< and in the scene that is computed
  std::string port;
};

/// What was found in all frames.
struct FrameFindings {
  std::uint64_t frames = 0;              ///< compared
  std::uint64_t equal = 0;               ///< by hash; by positions where hashes are not comparable
  std::uint64_t unmatched = 0;           ///< frames of steps that the computed scene does not pass
  std::optional<FrameDifference> first;  ///< first frame that is not equal
  std::optional<FrameDifference> largest;  ///< largest difference of all frames
  double sum_of_squares_m2 = 0.0;          ///< over all MATs of all frames
  std::uint64_t distances = 0;             ///< behind that sum
  std::optional<ForceDifference> force;    ///< largest of all frames; only of another model
  std::uint64_t beyond = 0;                ///< frames after the last computed step

  double rms_m() const noexcept;
};

/// Goes through the frames as the scene is computed.
class FrameCheck {
 public:
  /// How a frame finds its step, and when it is equal.
  enum class By : std::uint8_t {
    kHash,      ///< same step, same hash
    kPosition,  ///< same step, positions within the tolerance: for another hash version
    kTime       ///< same simulated time: for another model
  };
  /// @param take  must outlive this
  FrameCheck(TakeReader& take, By by, double tolerance_m);

  /// The scene as it is now. Cost: nothing but where a frame is due.
  void check(const sim::Simulation& simulation, std::uint64_t version);
  /// No more steps come.
  FrameFindings finish();

  /// Hashes of the computed scene at the frames, by their number; for a take that is renewed.
  struct Computed {
    std::uint64_t epoch = 0;
    std::uint64_t frame = 0;
    std::uint64_t position_hash = 0;
    std::vector<float> position_m;
  };
  void keep_computed() { keeps_ = true; }
  const std::vector<Computed>& computed() const noexcept { return computed_; }

 private:
  int order(const sim::Simulation& simulation, std::uint64_t version) const noexcept;
  void map_mats(const sim::Simulation& simulation, std::uint64_t version);
  void map_ports(const sim::Simulation& simulation, std::uint64_t version);
  FrameDifference difference(const sim::Simulation& simulation);
  void compare_forces(const sim::Simulation& simulation);
  void keep(const sim::Simulation& simulation);
  void close_frame(bool is_equal);
  void advance();

  TakeReader& take_;
  By by_;
  double tolerance_m_;
  FrameFindings findings_;
  msg::SceneFrame frame_;
  bool has_frame_ = false;
  std::optional<FrameDifference> pending_;  // of the present frame
  double pending_squares_ = 0.0;
  const scene::Scene* mapped_scene_ = nullptr;
  std::uint64_t mapped_version_ = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> mats_;  // of the frame, of the scene
  struct ComparedPort {
    std::string name;
    std::size_t in_frame = 0;
    std::vector<std::uint32_t> mats;  // of the scene
  };
  std::vector<ComparedPort> ports_;  // those of the same name
  sim::FrameLayout layout_;
  bool keeps_ = false;
  std::vector<Computed> computed_;
};

}  // namespace cordis::cli
