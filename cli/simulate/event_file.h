// cli/simulate/event_file.h -- the changes of state of a scene, as a table of its own.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "cli/export/event_table.h"
#include "sim_node/engine/links/link_event.h"
#include "sim_node/scene/scene.h"

namespace cordis::cli {

/// Comma-separated: time, step, liaison, link, its two MATs, the states, what triggered the change,
/// the value of that in its own SI unit, and the energy that the change added.
class EventFile {
 public:
  /// @throws UsageError when the file cannot be made.
  EventFile(const std::string& path, const scene::Scene& scene);

  /// @throws std::runtime_error when the file takes no more.
  void write(std::span<const engine::LinkEvent> events);
  void finish() { table_.finish(); }
  std::uint64_t count() const noexcept { return table_.count(); }

 private:
  EventTable table_;
  const scene::Scene& scene_;
};

}  // namespace cordis::cli
