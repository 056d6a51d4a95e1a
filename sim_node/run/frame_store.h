// sim_node/run/frame_store.h -- what is published of one scene, on its way out of the loop.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim_node/engine/world.h"
#include "sim_node/run/event_room.h"
#include "sim_node/run/step_rows.h"

namespace cordis::sim {

/// How the coordinates of the engine become those of a frame: the first of them lie along these
/// axes, and the others are those of the origin. In a 1-D scene the displacement is shown along y,
/// at the layout's x and z.
struct FrameLayout {
  int dimension = 3;
  std::vector<float> x_z;  ///< 2 per MAT of a scene written in 1-D, else empty [m]
  std::array<int, 3> axes{0, 1, 2};
  std::array<float, 3> origin{};  ///< [m]

  /// Puts a MAT at its place in a frame. @param position  of the engine, 3 values
  void show(std::size_t mat, const double* position, float* shown) const noexcept;
  /// A force on a MAT in the directions of a frame. @param force  of the engine, 3 values [N]
  void show_force(std::size_t mat, const double* force, float* shown) const noexcept;
};

/// What is fixed about the frames of a scene.
struct FrameShape {
  std::uint64_t version = 1;  ///< version of the description
  std::size_t mat_count = 0;
  std::size_t signal_count = 0;
  std::size_t rows_per_frame = 1;     ///< rows of signals
  std::uint32_t stride_steps = 1;     ///< between two rows, the whole part
  bool has_even_rows = true;          ///< false: a step more lies between some of them
  std::size_t step_signal_count = 0;  ///< signals that are taken after each step
  std::size_t step_rows_per_frame = 0;
  FrameLayout layout;
  std::size_t link_count = 0;        ///< number of links of all kinds; 0 when no link has states
  std::size_t first_state_link = 0;  ///< number of the first one with states
  std::size_t state_link_count = 0;
  std::vector<std::size_t> state_sets;  ///< sets of the network whose pairs have states
  std::size_t bond_capacity = 0;        ///< most bonds in a frame
  std::vector<std::vector<std::uint32_t>> port_mats;  ///< per port: the MATs that it moves
};

/// The most bonds that a frame shows.
inline constexpr std::size_t kMaxBonds = 16384;

/// The pairs of sets that are in another state than that of the start. Room is made once.
struct FrameBonds {
  std::vector<std::uint32_t> ends;   ///< 2 per bond
  std::vector<std::uint8_t> state;   ///< per bond, + kLinkIsIdle
  std::vector<std::uint32_t> count;  ///< per set whose pairs have states
  std::size_t shown = 0;             ///< bonds of all sets; `ends` and `state` have room for more
  std::uint32_t left_out = 0;
};

/// Added to the state of a link or a bond that neither pulls nor pushes in it, whatever its ends do: apart,
/// broken. A state machine has 64 states at most.
inline constexpr std::uint8_t kLinkIsIdle = 128;

/// A frame with the signals and events of the ticks before it.
struct FrameBuffer {
  std::vector<double> positions;         ///< as World::positions()
  std::vector<std::uint8_t> link_state;  ///< link_state of SceneFrame: per link, or empty
  FrameBonds bonds;
  std::vector<double> port_forces;  ///< 3 per port, as World::link_force() [N]
  EventRoom events;
  std::vector<double> rows;
  std::size_t row_count = 0;
  std::uint64_t first_step = 0;          ///< step of the first row
  std::uint32_t dropped_rows = 0;        ///< before the first row
  std::vector<std::uint32_t> row_steps;  ///< per row: its step less first_step
  std::vector<double> step_rows;         ///< signals that are taken after each step
  std::size_t step_row_count = 0;
  std::uint64_t first_step_row = 0;     ///< step of the first of them
  std::uint32_t dropped_step_rows = 0;  ///< before the first of them
  std::uint64_t step = 0;
  std::int64_t time_nsec = 0;
  std::int64_t action_time_nsec = 0;  ///< time of the newest device sample; 0: none
  double simulated_s = 0.0;
};

/// Two frame buffers: the loop fills one while a thread publishes the other. Real time: everything
/// but the constructor takes no lock and allocates nothing.
class FrameStore {
 public:
  explicit FrameStore(FrameShape shape);

  const FrameShape& shape() const noexcept { return shape_; }

  /// Room for the signals of one tick that ends with this step; a place to write to even when the
  /// buffer is full and the row is dropped.
  double* next_row(std::uint64_t step) noexcept;

  /// Keeps the rows of a turn; those beyond the buffer are dropped.
  void add(const StepRows& rows) noexcept;
  /// True if rows of steps are better published before the next frame is due.
  bool has_many_step_rows() const noexcept {
    return 2 * buffers_[filling_].step_row_count > step_row_capacity_;
  }

  /// Where the changes of state of the present tick go.
  EventRoom& events() noexcept { return buffers_[filling_].events; }
  /// True if there is something that no frame has published yet.
  bool has_news() const noexcept;

  /// Puts the present positions and states into the buffer being filled, which then is published(),
  /// and begins to fill the other one. O(MATs + links + pairs). Precondition: no thread uses published().
  void turn(const engine::World& world, double simulated_s, std::int64_t now_nsec,
            std::int64_t action_nsec = 0) noexcept;

  const FrameBuffer& published() const noexcept { return buffers_[1 - filling_]; }

 private:
  void copy_bonds(const engine::World& world, FrameBonds& bonds) const noexcept;
  void copy_port_forces(const engine::World& world, std::vector<double>& forces) const noexcept;

  static constexpr std::size_t kFramesOfRows = 8;  // rows kept while frames are left out

  FrameShape shape_;
  static constexpr std::size_t kMaxStepValues = std::size_t{1} << 20;

  std::size_t row_capacity_;
  std::size_t step_row_capacity_;
  std::vector<double> discarded_row_;
  std::array<FrameBuffer, 2> buffers_;
  std::size_t filling_ = 0;
  std::uint32_t overflowed_rows_ = 0;  // rows that found the filling buffer full
  std::uint32_t overflowed_step_rows_ = 0;
};

}  // namespace cordis::sim
