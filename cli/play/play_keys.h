// cli/play/play_keys.h -- keys of the terminal, one by one.
#pragma once

#include <string>

#include <termios.h>

namespace cordis::cli {

enum class PlayKey { kNone, kSpace, kRight, kUp, kDown };

/// Takes keys without Enter while it lives. Does nothing where standard input is no terminal.
class PlayKeys {
 public:
  PlayKeys();
  ~PlayKeys();
  PlayKeys(const PlayKeys&) = delete;
  PlayKeys& operator=(const PlayKeys&) = delete;

  /// The next key that was pressed; never waits.
  PlayKey next();

 private:
  termios before_{};  // first: the next one fills it
  bool is_terminal_ = false;
  std::string pressed_;  // read, and not handed out yet
};

}  // namespace cordis::cli
