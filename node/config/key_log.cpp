// node/config/key_log.cpp
#include "node/config/key_log.h"

namespace cordis::config {

namespace {

thread_local KeyLog* current_log = nullptr;

}  // namespace

KeyLog::KeyLog() {
  current_log = this;
}

KeyLog::~KeyLog() {
  current_log = nullptr;
}

KeyLog* KeyLog::current() noexcept {
  return current_log;
}

}  // namespace cordis::config
