// cli/run/output_watcher.cpp
#include "cli/run/output_watcher.h"

#include "node/assert.h"

namespace cordis::cli {

OutputWatcher::OutputWatcher(std::size_t count, std::chrono::seconds longest)
    : outputs_(count), deadline_(std::chrono::steady_clock::now() + longest) {}

void OutputWatcher::line(std::size_t process, Stream /*stream*/, std::string_view text) {
  (outputs_[process] += text) += '\n';
}

bool OutputWatcher::ended(std::size_t /*process*/, const Ending& /*ending*/, bool /*stopping*/) {
  return false;
}

void OutputWatcher::killed(std::size_t /*process*/) {}

void OutputWatcher::interrupted(bool /*again*/) {
  interrupted_ = true;
}

bool OutputWatcher::tick() {
  late_ = late_ || std::chrono::steady_clock::now() > deadline_;
  return late_;
}

const std::string& OutputWatcher::output(std::size_t process) const {
  CORDIS_ASSERT(process < outputs_.size());
  return outputs_[process];
}

}  // namespace cordis::cli
