// cli/run/node_life.cpp
#include "cli/run/node_life.h"

#include <cerrno>
#include <exception>
#include <utility>

#include <unistd.h>

#include "cli/exit_code.h"
#include "node/node_main.h"

namespace cordis::cli {
namespace {

static_assert(kBadInput == node::kBadInput);  // nodes end with the codes of `cordis`

bool is_death(const Ending& ending) {
  return ending.exit_code() != kSuccess && ending.exit_code() != kBadInput;
}

}  // namespace

NodeLife::NodeLife(std::vector<std::string> words, bool respawn, int orphan_signal, LineSink sink)
    : words_(std::move(words)),
      respawn_(respawn),
      orphan_signal_(orphan_signal),
      sink_(std::move(sink)),
      child_(std::make_unique<Child>(words_, orphan_signal_)) {}

void NodeLife::read_output() {
  for (const Stream stream : kStreams) read_block(stream);
}

/// @return whether there may be more.
bool NodeLife::read_block(Stream stream) {
  const int file = output(stream);
  if (file < 0) return false;
  std::array<char, 65536> block;
  const ssize_t count = read(file, block.data(), block.size());
  const auto sink = [&](std::string_view text) { sink_(stream, text); };
  LineSplitter& lines = lines_[static_cast<std::size_t>(stream)];
  if (count > 0) {
    lines.feed({block.data(), static_cast<std::size_t>(count)}, sink);
  } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
    lines.finish(sink);
    child_->close_output(stream);
  }
  return count > 0;
}

/// Reads what a process that has ended left in its pipe. A pipe holds a bounded amount, so this
/// ends even when a process that escaped from the group goes on writing.
void NodeLife::finish_output(Stream stream) {
  constexpr int kBlocksOfAPipe = 17;  // 1 MiB, the largest pipe an ordinary user may have, and one
                                      // more
  for (int block = 0; block < kBlocksOfAPipe && read_block(stream); ++block) {
  }
  lines_[static_cast<std::size_t>(stream)].finish(
      [&](std::string_view text) { sink_(stream, text); });
}

bool NodeLife::take_end(Time now, bool stopping) {
  if (!child_) return false;
  const std::optional<Ending> ending = child_->ending();
  if (!ending) return false;
  for (const Stream stream : kStreams) finish_output(stream);
  child_.reset();
  end_with(*ending, now, stopping);
  return true;
}

bool NodeLife::restart(Time now, const std::vector<std::string>& more_words) {
  restart_at_.reset();
  std::vector<std::string> words = words_;
  words.insert(words.end(), more_words.begin(), more_words.end());
  try {
    child_ = std::make_unique<Child>(words, orphan_signal_);
  } catch (const std::exception& error) {
    end_with({.code = kFailure, .reason = error.what()}, now, /*stopping=*/false);
  }
  return running();
}

void NodeLife::end_with(const Ending& ending, Time now, bool stopping) {
  ending_ = ending;
  if (respawn_ && !stopping && is_death(ending)) restart_at_ = policy_.died(now);
}

}  // namespace cordis::cli
