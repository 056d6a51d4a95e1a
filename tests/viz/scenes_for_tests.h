// tests/viz/scenes_for_tests.h -- a small scene that is sound, to be made unsound by the tests.
#pragma once

#include <string>

#include "idl/scene.h"

namespace cordis::viz {

inline constexpr std::uint64_t kEpoch = 1234567890123456789u;

/// Three MATs in a row (fixed, mass, port), two links, two signals.
inline msg::SceneDescription row_of_three() {
  msg::SceneDescription description;
  description.epoch(kEpoch);
  description.version(1);
  description.name("row");
  description.space(2);
  description.step_rate_hz(2000.0);
  description.gesture_rate_hz(1000.0);
  description.frame_rate_hz(25.0);
  description.mat_kind({1, 0, 2});
  description.mat_mass_kg({0.0F, 0.5F, 0.0F});
  description.mat_radius_m({0.0F, 0.25F, 0.125F});
  description.link_ends({0, 1, 1, 2});
  for (const std::string name : {"height", "force"}) {
    msg::SignalDescription signal;
    signal.name(name);
    signal.unit(name == "force" ? "N" : "m");
    description.signals().push_back(signal);
  }
  return description;
}

inline msg::SetDescription bonding_set(std::uint32_t state_machine, std::uint32_t start_state) {
  msg::SetDescription set;
  set.name("glue");
  set.state_machine(state_machine);
  set.start_state(start_state);
  return set;
}

/// A row of three with a port at the last MAT, in which pairs of two sets may be stuck.
inline msg::SceneDescription bonding_row() {
  msg::SceneDescription description = row_of_three();
  description.state_machines().resize(1);
  description.state_machines()[0].name("glue");
  description.state_machines()[0].states({"apart", "stuck", "torn"});
  description.sets({bonding_set(0, 0), bonding_set(0, 0)});
  description.ports().resize(1);
  description.ports()[0].mat(2);
  return description;
}

inline msg::SceneFrame frame_of_three(std::uint64_t number) {
  msg::SceneFrame frame;
  frame.epoch(kEpoch);
  frame.version(1);
  frame.frame(number);
  frame.step(80 * number);
  frame.time_nsec(static_cast<std::int64_t>(1'000'000'000 + 40'000'000 * number));
  frame.simulated_s(0.04 * static_cast<double>(number));
  frame.position_m({0.0F, 0.0F, 0.0F, 1.0F, 0.5F, 0.0F, 2.0F, 0.0F, 0.0F});
  return frame;
}

/// Rows of (row, -row), every second step.
inline msg::SceneSignals signals_of_three(std::uint64_t first_step, std::size_t rows) {
  msg::SceneSignals signals;
  signals.epoch(kEpoch);
  signals.version(1);
  signals.first_step(first_step);
  signals.stride_steps(2);
  signals.signal_count(2);
  for (std::size_t row = 0; row < rows; ++row) {
    signals.value().push_back(static_cast<double>(row));
    signals.value().push_back(-static_cast<double>(row));
  }
  return signals;
}

/// A row of three whose force is a sound.
inline msg::SceneDescription sounding_row() {
  msg::SceneDescription description = row_of_three();
  description.signals()[1].rate(msg::RATE_STEP);
  description.signals()[1].sound(true);
  description.signals()[1].full_scale(4.0);
  return description;
}

/// Samples of 0, 1, 2 and so on.
inline msg::SceneSound sound_of_row(std::uint64_t first_step, std::size_t steps) {
  msg::SceneSound sound;
  sound.epoch(kEpoch);
  sound.version(1);
  sound.first_step(first_step);
  sound.step_rate_hz(2000.0);
  sound.sound_count(1);
  sound.dropped_steps(3);
  sound.time_nsec(-7);
  for (std::size_t step = 0; step < steps; ++step)
    sound.value().push_back(static_cast<float>(step));
  return sound;
}

}  // namespace cordis::viz
