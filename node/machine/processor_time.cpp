// node/machine/processor_time.cpp
#include "node/machine/processor_time.h"

#include <sstream>
#include <string>

namespace cordis::machine {

std::optional<ProcessorTime> read_processor_time(const SystemFiles& files) {
  const std::optional<std::string> text = files.text("proc/stat");
  if (!text) return std::nullopt;
  std::istringstream line(text->substr(0, text->find('\n')));
  std::string name;
  line >> name;
  if (name != "cpu") return std::nullopt;
  // user nice system idle iowait irq softirq steal; guest time, which follows, is part of user.
  constexpr int kSteal = 7;
  ProcessorTime time;
  std::uint64_t value = 0;
  for (int field = 0; field <= kSteal && line >> value; ++field) {
    time.total += value;
    if (field == kSteal) time.stolen = value;
  }
  return time;
}

std::optional<double> stolen_share(const std::optional<ProcessorTime>& before,
                                   const std::optional<ProcessorTime>& after) {
  if (!before || !after || after->total <= before->total) return std::nullopt;
  const std::uint64_t stolen = after->stolen > before->stolen ? after->stolen - before->stolen : 0;
  return static_cast<double>(stolen) / static_cast<double>(after->total - before->total);
}

}  // namespace cordis::machine
