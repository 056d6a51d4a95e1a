// cli/export/event_table.h -- changes of state as a table, wherever they come from.
#pragma once

#include <cstdint>
#include <string>

#include "cli/table/output_file.h"
#include "sim_node/scene/language/quantity.h"

namespace cordis::cli {

/// One change of state, in the words of its scene.
struct EventRow {
  double time_s = 0.0;
  std::uint64_t step = 0;
  std::string liaison;
  std::string link;  ///< empty for a pair of a set, and where it has no name
  std::string mat_a;
  std::string mat_b;
  std::string from;
  std::string to;
  std::string quantity;   ///< what triggered it; empty when it was forced
  double value = 0.0;     ///< value of the quantity, in its own SI unit
  double energy_j = 0.0;  ///< energy that the change added
};

/// The word of the scene language for what triggered a change; empty when it was forced.
std::string quantity_word(engine::Quantity quantity);

/// Comma-separated, with the units in the header.
class EventTable {
 public:
  /// @throws UsageError when the file cannot be made.
  explicit EventTable(const std::string& path);

  /// @throws std::runtime_error when the file takes no more.
  void write(const EventRow& row);
  void finish() { file_.flush(); }
  std::uint64_t count() const noexcept { return count_; }

 private:
  OutputFile file_;
  std::string line_;
  std::uint64_t count_ = 0;
};

}  // namespace cordis::cli
