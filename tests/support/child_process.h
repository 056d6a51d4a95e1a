// tests/support/child_process.h -- a program started by a test, its output kept, ended for certain.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <sys/types.h>

namespace cordis::test {

/// A child process with stdout and stderr collected as one text. The destructor kills it when it
/// still runs, and prints the text when the test has failed.
class ChildProcess {
 public:
  /// Starts `words[0]` with the rest as arguments. @param environment  added to that of the test.
  explicit ChildProcess(const std::vector<std::string>& words,
                        const std::map<std::string, std::string>& environment = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t id() const noexcept { return id_; }
  void signal(int number) const noexcept;

  /// Waits for the end, at most so long. The exit code, 128 + signal when it was killed, or -1 when
  /// it still runs; then stderr says so.
  int wait(std::chrono::milliseconds at_most);

  /// Waits until its output contains `text`; false when it ended without, or the time is over; then
  /// stderr says so.
  bool wait_for_output(const std::string& text, std::chrono::milliseconds at_most);

  /// Waits until no process can write into its output any more: neither it nor a process that it
  /// started.
  bool wait_for_end_of_output(std::chrono::milliseconds at_most);

  std::string output() const;
  /// Prints its command and its output on stderr.
  void print() const;

 private:
  void read_output();

  std::string command_;
  pid_t id_ = -1;
  int exit_code_ = -1;
  bool ended_ = false;
  int pipe_ = -1;
  mutable std::mutex mutex_;
  std::condition_variable more_;
  std::string output_;
  bool closed_ = false;
  std::atomic<bool> abandoned_{false};
  std::thread reader_;
};

/// A process that another one has started.
struct ChildOf {
  pid_t id;
  std::string name;  ///< name of its program
};
std::vector<ChildOf> children_of(pid_t parent);

/// The node that this launcher has started with `--name NAME`; 0 when there is none.
pid_t process_of(const ChildProcess& launcher, const std::string& name);

}  // namespace cordis::test
