// tests/integration/live_session.cpp
#include "tests/integration/live_session.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/test_domain.h"

namespace cordis::test {

using namespace std::chrono_literals;

bool eventually(const std::function<bool()>& condition) {
  const auto limit = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > limit) return false;
    std::this_thread::sleep_for(2ms);
  }
  return true;
}

std::string program_path(const std::string& program) {
  return std::string(CORDIS_PROGRAM_DIR) + "/" + program;
}

LiveSession::LiveSession(const std::string& clock, const std::string& nodes,
                         const std::string& session) {
  std::string name = (std::filesystem::temp_directory_path() / "cordis-test-XXXXXX").string();
  folder_ = mkdtemp(name.data());
  add_file("launch.yaml", "cordis: 1\nsession: " + session +
                              "\ndomain: " + std::to_string(own_domain()) + "\nclock: " + clock +
                              "\nnodes:\n" + nodes);
  participant_ = std::make_unique<dds::Participant>(
      dds::Membership{own_domain(), session, "observer", clock == "lockstep",
                      nodes.find("plays:") != std::string::npos});
}

LiveSession::~LiveSession() {
  for (auto& [name, process] : processes_) process->signal(SIGTERM);
  for (auto& [name, process] : processes_) process->wait(5s);
  if (::testing::Test::HasFailure()) {
    for (auto& [name, process] : processes_) {
      std::fprintf(stderr, "---- output of %s\n%s\n", name.c_str(), process->output().c_str());
    }
    for (auto& process : ended_)
      std::fprintf(stderr, "---- of an ended one\n%s\n", process->output().c_str());
  }
  processes_.clear();
  std::filesystem::remove_all(folder_);
}

void LiveSession::add_file(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name) << text;
}

ChildProcess& LiveSession::start(const std::string& program, const std::string& name,
                                 const std::vector<std::string>& words) {
  std::vector<std::string> command = {program_path(program), launch_file(), "--name", name};
  command.insert(command.end(), words.begin(), words.end());
  if (auto& old = processes_[name]) ended_.push_back(std::move(old));
  processes_[name] = std::make_unique<ChildProcess>(command);
  return *processes_[name];
}

ChildProcess& LiveSession::start_launcher(const std::vector<std::string>& words) {
  std::vector<std::string> command = {program_path("cordis"), "run", launch_file(), "--no-color"};
  command.insert(command.end(), words.begin(), words.end());
  if (auto& old = processes_["cordis"]) ended_.push_back(std::move(old));
  processes_["cordis"] = std::make_unique<ChildProcess>(command);
  return *processes_["cordis"];
}

}  // namespace cordis::test
