// cli/live_output.h -- standard output: what came of it, and of a verb that prints while a session
// runs.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "node/dds/participant.h"

namespace cordis::cli {

/// Before anything is opened. Where standard output is closed, a file that nothing can be written
/// into has its place, so that no other file gets it.
void hold_place_of_output();

/// Hands on what is left of what was printed.
/// @param program  whose sentence it is when that cannot be written
/// @return `exit_code`, and kFailure in the place of kSuccess after that sentence
int end_output(const std::string& program, int exit_code);

/// Hands on what was printed. @return false when its reader has gone, as `head` does
/// @throws std::runtime_error when it cannot be written for another reason, as on a full disk
bool flush_output();

/// Says on stderr that nothing has come so far on the topics that were asked for: once, and again when the reason
/// becomes known.
class SilenceNote {
 public:
  /// @param pattern  of topics; empty: all
  /// @param participant  receives; stays until the note has gone
  SilenceNote(std::string verb, std::string session, std::string pattern,
              const dds::Participant& participant);

  /// @param received  how many messages have come since it was made
  void update(std::uint64_t received);
  /// True if it has said so, and given the reason that is known now.
  bool has_spoken() const;
  /// The sentence, and what of the session cannot be received.
  std::string text() const;

 private:
  const std::string verb_;
  const std::string session_;
  const std::string pattern_;
  const dds::Participant& participant_;
  const std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::string reason_;  // that it has given
  bool has_spoken_ = false;
  bool done_ = false;  // a message has come
};

}  // namespace cordis::cli
