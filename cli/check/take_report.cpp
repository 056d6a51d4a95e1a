// cli/check/take_report.cpp
#include "cli/check/take_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/take_file.h"
#include "node/config/count_text.h"
#include "record_node/mcap/file_error.h"
#include "record_node/mcap/take_check.h"

namespace cordis::cli {
namespace {

std::string fault_text(const std::string& file, const mcap::TakeCheck& check) {
  const mcap::Statistics& statistics = check.statistics;
  std::string text = fmt::format(
      "{}: {} in {}, {}\n", file, config::count_text(statistics.message_count, "message"),
      config::count_text(statistics.chunk_count, "chunk"), size_text(check.size));
  if (check.faults.empty()) return text + "whole: every CRC, index and count fits\n";
  for (const mcap::Fault& fault : check.faults)
    text += fmt::format("  byte {}: {}\n", fault.offset, fault.text);
  return text + fmt::format("damaged: `cordis recover {}` keeps what is whole\n", file);
}

std::string fault_json(const std::string& file, const mcap::TakeCheck& check) {
  nlohmann::json faults = nlohmann::json::array();
  for (const mcap::Fault& fault : check.faults)
    faults.push_back({{"offset", fault.offset}, {"message", fault.text}});
  const nlohmann::json json{{"take", file},
                            {"size_bytes", check.size},
                            {"messages", check.statistics.message_count},
                            {"chunks", check.statistics.chunk_count},
                            {"whole", check.faults.empty()},
                            {"faults", std::move(faults)}};
  constexpr int kIndent = 2;
  return json.dump(kIndent, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace

TakeReport check_take_file(const std::string& file) {
  try {
    const mcap::TakeCheck check = mcap::check_take(file);
    return {fault_text(file, check), fault_json(file, check), check.faults.empty()};
  } catch (const mcap::FileError& error) {
    throw UsageError(error.what());
  }
}

}  // namespace cordis::cli
