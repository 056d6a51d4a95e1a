// tests/cli/fake_session.h -- `cordis run` with fake nodes, as a test wants them to behave.
#pragma once

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/child_process.h"
#include "tests/support/eventually.h"
#include "tests/support/test_domain.h"

namespace cordis::test {

/// A launch file with the nodes sim, key and view (not required), and how each behaves. None starts
/// again when it dies, unless a test wants it.
class FakeSession {
 public:
  FakeSession() {
    directory_ =
        std::filesystem::path(testing::TempDir()) / ("cordis run " + std::to_string(getpid()));
    std::filesystem::create_directories(directory_);
  }
  ~FakeSession() { std::filesystem::remove_all(directory_); }
  FakeSession(const FakeSession&) = delete;
  FakeSession& operator=(const FakeSession&) = delete;

  /// @param commands  see fake_node.cpp
  void node(const std::string& name, const std::string& commands) {
    environment_["FAKE_" + name] = commands;
  }
  void check(const std::string& name, const std::string& commands) {
    environment_["FAKE_CHECK_" + name] = commands;
  }
  /// Every node says `pid N` once it listens to signals.
  void announce() {
    for (const char* name : {"sim", "key", "view"}) node(name, "pid");
  }
  void clock(const std::string& clock) { clock_ = clock; }
  /// The launch file names no domain. The user has sessions in no folder but this test's.
  void own_registry() {
    domain_.clear();
    environment_["CORDIS_RUNTIME_DIR"] = directory_ / "runtime";
  }
  /// Keys `respawn` as the launch file has them by default.
  void respawn() { respawn_ = ""; }

  std::filesystem::path directory() const { return directory_; }
  std::string launch_file() const { return directory_ / "launch.yaml"; }
  static std::string cordis() { return CORDIS_FAKE_SESSION "/cordis"; }

  std::unique_ptr<ChildProcess> start(const std::vector<std::string>& more_words = {}) {
    std::vector<std::string> words{cordis(), "run", launch_file()};
    words.insert(words.end(), more_words.begin(), more_words.end());
    return start_words(words);
  }

  std::unique_ptr<ChildProcess> start_words(const std::vector<std::string>& words) {
    for (const char* name : {"sim", "key", "view"})
      std::filesystem::remove(directory_ / (std::string(name) + ".starts"));
    std::ofstream(launch_file()) << "cordis: 1\nsession: fake\n"
                                 << domain_ << "clock: " << clock_ << "\nnodes:\n"
                                 << "  view: {node: viz_node" << respawn_ << "}\n"
                                 << "  key: {node: device_node" << respawn_ << "}\n"
                                 << "  sim: {node: sim_node" << respawn_ << "}\n";
    return std::make_unique<ChildProcess>(words, environment_);
  }

 private:
  std::filesystem::path directory_;
  std::string domain_ = "domain: " + std::to_string(own_domain()) + "\n";
  std::string clock_ = "realtime";
  std::string respawn_ = ", respawn: false";
  std::map<std::string, std::string> environment_;
};

/// How often `part` occurs in a text.
inline std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t position = 0; (position = text.find(part, position)) != std::string::npos;
       ++position)
    ++count;
  return count;
}

/// Numbers N of all lines `... pid N` in the output.
inline std::vector<pid_t> pids_in(const std::string& output) {
  std::vector<pid_t> pids;
  for (std::size_t position = 0; (position = output.find("pid ", position)) != std::string::npos;
       ++position) {
    pids.push_back(std::stoi(output.substr(position + 4)));
  }
  return pids;
}

/// Waits for the end of the run and of its output. @return its exit code
inline int end_of(ChildProcess& run) {
  const int code = run.wait(kPatience);
  run.wait_for_end_of_output(kPatience);
  return code;
}

/// Waits until all nodes of a session that announces them listen to signals.
inline bool wait_for_all(ChildProcess& run) {
  for (const char* line : {"sim    | pid", "key    | pid", "view   | pid"}) {
    if (!run.wait_for_output(line, kPatience)) return false;
  }
  return true;
}

/// Lets a node go on that awaits it.
inline void release(const ChildProcess& run, const std::string& node) {
  const std::string output = run.output();
  kill(pids_in(output.substr(output.find(node + " ")))[0], SIGUSR1);
}

/// True if the process runs; false if it has ended and its parent has not noticed yet.
inline bool is_running(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  return !text.empty() && text.find(") Z ") == std::string::npos &&
         text.find(") X ") == std::string::npos;
}

/// Waits until the process does not run any more.
inline bool is_gone(pid_t pid) {
  return eventually([pid] { return !is_running(pid); });
}

}  // namespace cordis::test
