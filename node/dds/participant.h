// node/dds/participant.h -- one process' membership of a session.
#pragma once

#include <memory>
#include <string>

namespace cordis::dds {

/// Where a process takes part, and as what.
struct Membership {
  int domain = 0;          ///< DDS domain, 0..101
  std::string session;     ///< partition: processes of other sessions hear nothing of this one
  std::string node;        ///< name of the node, shown by DDS tools
  bool lockstep = false;   ///< quality of service of the gesture topics
  bool stand_ins = false;  ///< likewise; the same for all processes of a session
};

/// A DDS participant on UDP over 127.0.0.1, with simple discovery. One per process.
/// Its threads inherit the priority of the thread that makes it.
class Participant {
 public:
  /// @throws std::runtime_error when DDS refuses (domain out of range, no loopback interface, ...).
  explicit Participant(const Membership& membership);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  const Membership& membership() const noexcept;

  /// Says in a sentence which process of the session cannot be heard, or cannot hear, because it
  /// was started with another launch file; empty while there is none.
  std::string mismatch() const;

  struct Impl;
  Impl& impl() noexcept { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace cordis::dds
