// cli/play/play_keys.cpp
#include "cli/play/play_keys.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <poll.h>
#include <unistd.h>

namespace cordis::cli {
namespace {

using Key = std::pair<std::string_view, PlayKey>;

constexpr std::array kKeys{Key{" ", PlayKey::kSpace}, Key{"\033[C", PlayKey::kRight},
                           Key{"\033[A", PlayKey::kUp}, Key{"\033[B", PlayKey::kDown}};

}  // namespace

PlayKeys::PlayKeys()
    : is_terminal_(isatty(STDIN_FILENO) == 1 && tcgetpgrp(STDIN_FILENO) == getpgrp() &&
                   tcgetattr(STDIN_FILENO, &before_) == 0) {
  if (!is_terminal_) return;
  termios keys = before_;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  tcsetattr(STDIN_FILENO, TCSANOW, &keys);
}

PlayKeys::~PlayKeys() {
  if (is_terminal_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

PlayKey PlayKeys::next() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (is_terminal_ && poll(&input, 1, 0) > 0) {
    char text[64];
    const ssize_t count = read(STDIN_FILENO, text, sizeof text);
    if (count > 0) pressed_.append(text, static_cast<std::size_t>(count));
  }
  // Keys that repeat come several at once.
  while (!pressed_.empty()) {
    for (const auto& [sequence, key] : kKeys) {
      if (!pressed_.starts_with(sequence)) continue;
      pressed_.erase(0, sequence.size());
      return key;
    }
    const auto continues = [this](const Key& key) { return key.first.starts_with(pressed_); };
    if (std::ranges::any_of(kKeys, continues)) return PlayKey::kNone;  // the rest is under way
    pressed_.erase(0, 1);
  }
  return PlayKey::kNone;
}

}  // namespace cordis::cli
