// cli/live_output.h -- standard output of a verb that prints while a session runs.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace cordis::cli {

/// Hands on what was printed. @return false when its reader has gone, as `head` does
/// @throws std::runtime_error when it cannot be written for another reason, as on a full disk
bool flush_output();

/// Says once, on stderr, that nothing has come so far on the topics that were asked for.
class SilenceNote {
 public:
  /// @param pattern  of topics; empty: all
  SilenceNote(std::string verb, std::string session, std::string pattern);

  /// @param received  how many messages have come since it was made
  void update(std::uint64_t received);
  /// The sentence.
  std::string text() const;

 private:
  const std::string verb_;
  const std::string session_;
  const std::string pattern_;
  const std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  bool done_ = false;
};

}  // namespace cordis::cli
