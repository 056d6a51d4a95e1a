// tests/integration/live_session.cpp
#include "tests/integration/live_session.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tests/support/test_domain.h"

namespace cordis::test {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

using namespace std::chrono_literals;

std::string program_path(const std::string& program) {
  return std::string(CORDIS_PROGRAM_DIR) + "/" + program;
}

pid_t process_of(const ChildProcess& launcher, const std::string& node) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string number = entry.path().filename();
    if (number.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string stat = text_of(entry.path() / "stat");
    const std::size_t name_end = stat.rfind(')');
    int parent = 0;
    if (name_end == std::string::npos ||
        std::sscanf(stat.c_str() + name_end, ") %*c %d", &parent) != 1 || parent != launcher.id())
      continue;
    const std::string words = text_of(entry.path() / "cmdline");
    if (words.find(std::string("--name\0", 7) + node + '\0') != std::string::npos)
      return std::stoi(number);
  }
  return 0;
}

LiveSession::LiveSession(const std::string& clock, const std::string& nodes,
                         const std::string& session) {
  std::string name = (std::filesystem::temp_directory_path() / "cordis-test-XXXXXX").string();
  folder_ = mkdtemp(name.data());
  add_file("launch.yaml", "cordis: 1\nsession: " + session +
                              "\ndomain: " + std::to_string(own_domain()) + "\nclock: " + clock +
                              "\nnodes:\n" + nodes);
  participant_ = std::make_unique<dds::Participant>(
      dds::ParticipantConfig{own_domain(), session, "observer", clock == "lockstep",
                             nodes.find("standby_for:") != std::string::npos});
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
