// cli/simulate/session_table.h -- the columns of a simulated session, and their values of a moment.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/offline/offline_session.h"
#include "cli/table/column.h"

namespace cordis::cli {

/// Time, the signals, per port the position and the force along each axis of its device, and the
/// positions of selected MATs.
///
/// A position of a port is that of its MAT, from its rest; a force is in role mass what the links do
/// to it, and in role liaison what the device does.
class SessionTable {
 public:
  /// @param mats  words that pick MATs: `string`, `string[3]`, `string[2..5]`
  /// @throws UsageError for a word that fits no MAT.
  SessionTable(const OfflineSession& session, const std::vector<std::string>& mats);

  const std::vector<Column>& columns() const noexcept { return columns_; }

  /// The values of now. @param ends_tick  a gesture period is over: of a device they are what it gave
  /// and what it was answered, as a take has them; else what its MAT has within the period
  const std::vector<double>& row(bool ends_tick);

 private:
  struct PortAxis {
    const scene::Port* port;
    std::size_t axis;  // of the port
  };
  void add_ports();
  void add_mats(const std::string& word);

  const OfflineSession& session_;
  std::vector<Column> columns_;
  std::vector<PortAxis> port_axes_;
  std::vector<std::uint32_t> mats_;
  std::vector<double> row_;
};

}  // namespace cordis::cli
