// tests/integration/live_session.cpp
#include "tests/integration/live_session.h"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <utility>

#include "node/security/identity.h"
#include "node/security/keyring.h"
#include "tests/support/test_domain.h"

namespace cordis::test {
using namespace std::chrono_literals;

std::string program_path(const std::string& program) {
  return std::string(CORDIS_PROGRAM_DIR) + "/" + program;
}

LiveSession::LiveSession(const std::string& clock, const std::string& nodes,
                         const std::string& session, Build build)
    : build_(std::move(build)) {
  if (build_.folder.empty()) build_.folder = CORDIS_PROGRAM_DIR;
  std::string name = (std::filesystem::temp_directory_path() / "cordis-test-XXXXXX").string();
  folder_ = mkdtemp(name.data());
  add_file("launch.yaml", "cordis: 1\nsession: " + session +
                              "\ndomain: " + std::to_string(own_domain()) + "\nclock: " + clock +
                              (build_.is_secured ? "\nsecurity: keys" : "") + "\nnodes:\n" + nodes);
  dds::ParticipantConfig config{own_domain(), session, "observer", clock == "lockstep",
                                nodes.find("standby_for:") != std::string::npos};
  if (build_.wire_version != 0) config.wire_version = build_.wire_version;
  if (build_.is_secured) {
    node::make_keyring(folder_ / "keys", {});
    config.security = node::identity_in(folder_ / "keys", {node::Role::kController}, "").security;
  }
  participant_ = std::make_unique<dds::Participant>(config);
}

LiveSession::~LiveSession() {
  for (auto& [name, process] : processes_) process->signal(SIGTERM);
  for (auto& [name, process] : processes_) process->wait(kPatience);
  processes_.clear();
  std::filesystem::remove_all(folder_);
}

void LiveSession::add_file(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name) << text;
}

ChildProcess& LiveSession::start(const std::string& program, const std::string& name,
                                 const std::vector<std::string>& words) {
  std::vector<std::string> command = {build_.folder + "/" + program, launch_file(), "--name", name};
  command.insert(command.end(), words.begin(), words.end());
  if (auto& old = processes_[name]) ended_.push_back(std::move(old));
  processes_[name] = std::make_unique<ChildProcess>(command);
  return *processes_[name];
}

ChildProcess& LiveSession::start_launcher(const std::vector<std::string>& words) {
  std::vector<std::string> command = {build_.folder + "/cordis", "run", launch_file(),
                                      "--no-color"};
  command.insert(command.end(), words.begin(), words.end());
  if (auto& old = processes_["cordis"]) ended_.push_back(std::move(old));
  processes_["cordis"] = std::make_unique<ChildProcess>(command);
  return *processes_["cordis"];
}

}  // namespace cordis::test
